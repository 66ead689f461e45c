//! How fast the coordinator is on this disk: durable claims per second and the time of a sweep's status.
//!
//! `cargo run --release -p server --example load -- [POINTS] [WORKERS] [CLAIMS]`
//!
//! Fills a database in a temporary folder of the current directory with a sweep of POINTS points, lets WORKERS claim
//! one job each, again and again (the use case, without HTTP), until CLAIMS jobs are leased (every claim is committed with
//! `synchronous=FULL` before its answer), and reads the status of the sweep meanwhile and afterwards.

use std::io::Write as _;
use std::time::{Duration, Instant};

use protocol::api::SweepView;
use protocol::{ClaimRequest, JobId, Registration, WorkerId};
use serde_json::json;
use server::app::{Submission, Submitted};
use server::{App, Config};

#[tokio::main]
async fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse::<u64>());
    let mut next = |default| numbers.next().unwrap_or(Ok(default));
    let (points, workers, claims) = (next(100_000)?, next(32)?, next(5_000)?);
    let folder = tempfile::tempdir_in(".")?;
    let config = Config { data_dir: folder.path().to_owned(), ..Config::default() };
    let clock = std::sync::Arc::new(server::clock::SystemClock);
    let app = App::new(server::parts(config, clock).await?);

    let definition = json!({
        "name": "load", "model": "cohesive_spheres", "base": { "n": 1000 },
        "blocks": [{ "grid": { "sigma_c": { "log": [2e3, 2e8, points.div_ceil(100)] }, "p": { "log": [1e4, 1e6, 10] },
                               "sigma_e": { "log": [1e9, 1e10, 10] } } }],
    });
    let start = Instant::now();
    let body = definition.to_string().into_bytes();
    let Submitted::New(sweep) = app.submit(Submission { body, idempotency_key: None }).await? else {
        return Err("the sweep is not new".into());
    };
    let accepted = start.elapsed();
    let expanding = {
        let app = app.clone();
        tokio::spawn(async move { app.expand_all().await })
    };
    let worker = register(&app, "during").await?;
    // A claim in the middle of the expansion waits for at most one chunk.
    let mut slowest = Duration::ZERO;
    let mut held = Vec::new();
    while !expanding.is_finished() {
        let asked = Instant::now();
        held.extend(claim(&app, worker, &held).await?);
        slowest = slowest.max(asked.elapsed());
    }
    expanding.await??;
    report("submission answered after", accepted);
    report("expansion finished after", start.elapsed());
    report("slowest of the claims made meanwhile", slowest);
    writeln!(std::io::stdout(), "  ({} claims meanwhile)", held.len())?;

    let each = claims / workers;
    let start = Instant::now();
    let mut tasks = Vec::new();
    for index in 0..workers {
        let app = app.clone();
        tasks.push(tokio::spawn(async move {
            let worker = register(&app, &format!("host-{index}")).await?;
            let mut held: Vec<JobId> = Vec::new();
            for _ in 0..each {
                held.extend(claim(&app, worker, &held).await?);
            }
            Ok::<usize, server::error::AppError>(held.len())
        }));
    }
    let mut claimed = 0;
    for task in tasks {
        claimed += task.await??;
    }
    let took = start.elapsed();
    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    let rate = claimed as f64 / took.as_secs_f64();
    writeln!(std::io::stdout(), "{claimed} durable claims by {workers} workers: {rate:.0} claims/s")?;

    let mut times = Vec::new();
    for _ in 0..200 {
        let asked = Instant::now();
        let view: SweepView = app.sweep(sweep.id).await?;
        times.push(asked.elapsed());
        assert_eq!(view.counts.total(), view.expanded);
    }
    times.sort();
    report("status of the sweep, median of 200", times[100]);
    report("status of the sweep, slowest of 200", times[199]);
    let faults = app.store().audit().await?;
    assert!(faults.is_empty(), "{faults:?}");
    app.store().close().await;
    Ok(())
}

async fn register(app: &App, host: &str) -> Result<WorkerId, server::error::AppError> {
    let registration = Registration {
        protocol: protocol::PROTOCOL_VERSION,
        host: host.to_owned(),
        boot: uuid::Uuid::new_v4(),
        slots: 1,
        hardware: "load".to_owned(),
        code_version: String::new(),
        models: vec![("cohesive_spheres".to_owned(), scene::Model::CohesiveSpheres.physics_version())],
    };
    Ok(app.register(&registration).await?.worker)
}

async fn claim(app: &App, worker: WorkerId, held: &[JobId]) -> Result<Vec<JobId>, server::error::AppError> {
    let request = ClaimRequest { worker, slots: 1, holding: held.to_vec(), wait_seconds: 0.0 };
    Ok(app.claim(request).await?.grants.into_iter().map(|grant| grant.job).collect())
}

fn report(what: &str, took: Duration) {
    // Nothing to be done about a closed stdout.
    let _ = writeln!(std::io::stdout(), "{what}: {:.1} ms", took.as_secs_f64() * 1e3);
}
