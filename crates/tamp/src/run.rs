//! `tamp run`: one scene on this machine, no server.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use bytes::Bytes;
use protocol::FailureKind;
use scene::Scene;
use serde_json::{Map, Value};
use sim_core::{KernelChoice, Options};
use tokio_util::sync::CancellationToken;
use worker::{Command, Control, End, Failed, SimCore, Task, checkpoint};

use crate::failure::Failure;
use crate::progress::{Progress, span};
use crate::{input, output, snapshot};

/// Arguments of `tamp run`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Scene as JSON; - reads it from standard input
    file: String,
    /// Keys to replace, for example n=500 seed=2
    #[arg(value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Threads inside the scene; the result is the same with any number
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Save the state here from time to time and on Ctrl-C; go on from it if it is there
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Time between two savings [s]
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    checkpoint_seconds: f64,
    /// Write packing, contacts and time series here (CSV, VTK, JSON)
    #[arg(long, value_name = "DIR")]
    snapshot: Option<PathBuf>,
    /// Show no progress
    #[arg(long)]
    quiet: bool,
}

/// Runs the scene and prints its record.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = input::scene(&arguments.file, &arguments.overrides)?;
    let task = task(arguments, &scene)?;
    if let Some(directory) = &arguments.snapshot {
        // before hours of work, not after them
        std::fs::create_dir_all(directory).map_err(|error| Failure::file(directory, &error))?;
    }
    match compute(arguments, task)? {
        End::Finished { outcome, execution } => {
            let record = flat_record(&scene, &outcome.record, &execution);
            if let Some(directory) = &arguments.snapshot {
                snapshot::write(directory, &outcome, &record)?;
            }
            output::json(&record)
        }
        End::Yielded(_) | End::Dropped => Err(Failure::Work(match &arguments.checkpoint {
            Some(path) => format!("stopped; the same command goes on from {}", path.display()),
            None => "stopped; nothing was saved (use --checkpoint FILE)".to_owned(),
        })),
        End::Failed(failed) => Err(failure_of(failed)),
    }
}

fn task(arguments: &Arguments, scene: &Scene) -> Result<Task, Failure> {
    if !(1..=1024).contains(&arguments.threads) {
        let value = arguments.threads.to_string();
        return Err(Failure::input("threads", value, "is out of range", "give 1 to 1024"));
    }
    let every = Duration::try_from_secs_f64(arguments.checkpoint_seconds).map_err(|error| {
        let value = arguments.checkpoint_seconds.to_string();
        Failure::input("checkpoint-seconds", value, error.to_string(), "give a number of seconds")
    })?;
    let reduced = scene.reduce();
    let key = reduced.key();
    let mut starts = Vec::new();
    if let Some(path) = &arguments.checkpoint
        && path.exists()
    {
        let bytes = std::fs::read(path).map_err(|error| Failure::file(path, &error))?;
        // a person named this file: starting over in silence would be a surprise
        checkpoint::open(&bytes, &key).map_err(|damaged| {
            let remedy = "remove the file to start over, or name another";
            Failure::input("checkpoint", path.display().to_string(), format!("is {damaged}"), remedy)
        })?;
        starts.push(Bytes::from(bytes));
    }
    Ok(Task {
        scene: reduced,
        key,
        options: Options { threads: arguments.threads, kernel: KernelChoice::Auto },
        starts,
        checkpoint_every: arguments.checkpoint.as_ref().map(|_| every),
    })
}

/// Computes on a thread of its own; this one shows progress and listens to signals.
fn compute(arguments: &Arguments, task: Task) -> Result<End, Failure> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(|error| Failure::Work(error.to_string()))?;
    runtime.block_on(async {
        let stop = CancellationToken::new();
        worker::stop_on_signals(stop.clone()).map_err(|error| Failure::Work(error.to_string()))?;
        let control = Arc::new(Control::new());
        let mut ending = spawn(task, Arc::clone(&control), arguments.checkpoint.clone())?;
        let mut progress = Progress::new("run", arguments.quiet);
        let mut ticks = tokio::time::interval(Duration::from_millis(200));
        let mut told = false;
        let end = loop {
            tokio::select! {
                end = &mut ending => break end,
                _ = ticks.tick() => show(&mut progress, &control),
                () = stop.cancelled(), if !told => {
                    told = true;
                    let saves = arguments.checkpoint.is_some();
                    control.command(if saves { Command::Yield } else { Command::Drop });
                }
            }
        };
        let end = end.map_err(|_| Failure::Work("the computing thread ended silently".to_owned()))?;
        progress.end(match &end {
            End::Finished { .. } => "finished",
            End::Failed(_) => "failed",
            End::Yielded(_) | End::Dropped => "stopped",
        });
        Ok(end)
    })
}

fn spawn(
    task: Task,
    control: Arc<Control>,
    file: Option<PathBuf>,
) -> Result<tokio::sync::oneshot::Receiver<End>, Failure> {
    /// As deep as the worker's threads.
    const STACK: usize = 16 << 20;
    let (ended, ending) = tokio::sync::oneshot::channel();
    let compute = move || {
        let keep = |sealed: &checkpoint::Sealed| {
            if let Some(path) = &file
                && let Err(error) = worker::write_durably(path, &sealed.bytes)
            {
                eprintln!("warning: {}: {error}; the run goes on without this checkpoint", path.display());
            }
        };
        let end = worker::run_task(&SimCore, &task, &control, &mut |sealed| keep(&sealed));
        if let End::Yielded(Some(sealed)) = &end {
            keep(sealed);
        }
        // the receiver outlives this thread
        let _ = ended.send(end);
    };
    std::thread::Builder::new()
        .name("run".to_owned())
        .stack_size(STACK)
        .spawn(compute)
        .map_err(|error| Failure::Work(format!("cannot start a thread: {error}")))?;
    Ok(ending)
}

fn show(progress: &mut Progress, control: &Control) {
    let Some(now) = control.latest().progress else { return progress.show(0.0, "preparing") };
    let live: Vec<String> = now
        .live
        .iter()
        .filter_map(|(name, cell)| cell.number().map(|value| format!("{name} {value:.4}")))
        .collect();
    let eta = progress
        .remaining(now.fraction)
        .map_or(String::new(), |time| format!(", {} left", span(time.as_secs_f64())));
    progress.show(now.fraction, &format!("step {}{eta}  {}", now.steps, live.join("  ")));
}

fn failure_of(failed: Failed) -> Failure {
    match (failed.kind, failed.class) {
        (FailureKind::Permanent, "scene") => {
            Failure::input("scene", "given", failed.message, "change the scene")
        }
        (_, class) => Failure::Work(format!("{class}: {}", failed.message)),
    }
}

/// The record as one flat object, with the same columns as a row of the service: the reduced scene (`reduced.…`), the
/// scene in SI units, its derived quantities, what belongs to this execution, and the physics' record.
pub fn flat_record(scene: &Scene, record: &record::Row, execution: &record::Row) -> Map<String, Value> {
    let mut flat = Map::new();
    flatten(&mut flat, "reduced", &scene.reduce().to_json());
    flatten(&mut flat, "", &scene.to_json());
    for (name, value) in scene.derived() {
        flat.insert(name.to_owned(), Value::from(value));
    }
    flat.insert("out_of_model".to_owned(), Value::from(scene.out_of_model().is_some()));
    for (name, cell) in execution.iter().chain(record.iter()) {
        flat.insert(name.to_owned(), cell.to_json());
    }
    flat.insert("scene_key".to_owned(), Value::from(scene.key().as_str()));
    flat
}

/// `{"stop": {"rule": …}}` becomes `stop.rule`; what has no value has no column.
fn flatten(flat: &mut Map<String, Value>, prefix: &str, value: &Value) {
    match value {
        Value::Object(inner) => {
            for (key, value) in inner {
                let path = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
                flatten(flat, &path, value);
            }
        }
        Value::Null | Value::Array(_) => {}
        scalar => {
            flat.insert(prefix.to_owned(), scalar.clone());
        }
    }
}
