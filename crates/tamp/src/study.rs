//! `tamp study`: a whole sweep on this machine, from definition to fit, with one command.
//!
//! A coordinator on 127.0.0.1 and a worker with one slot per core run inside this process and talk HTTP to each
//! other, as they would across a lab. Everything lies in the data directory: stopped at any moment, the same command
//! goes on where it was; finished, it only reads.

mod files;
mod report;
mod stack;
mod watch;

use std::path::PathBuf;

use protocol::api::{SweepState, SweepView};
use scene::Sweep;
use tokio_util::sync::CancellationToken;

use crate::failure::Failure;
use crate::{input, output, remote};

/// Arguments of `tamp study`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Sweep as JSON [default: the preset cohesive-mini]; - reads it from standard input
    file: Option<String>,
    /// Where database, checkpoints and results are kept
    #[arg(long, value_name = "DIR", default_value = "tamp-data")]
    data_dir: PathBuf,
    /// Jobs run at the same time [default: number of cores]
    #[arg(long)]
    slots: Option<u32>,
    /// Replace a key of the base, for example --set n=1000
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
}

/// Runs the sweep and shows what came out.
pub fn study(arguments: &Arguments) -> Result<(), Failure> {
    let sweep = definition(arguments)?;
    let slots = arguments.slots.unwrap_or_else(worker::host::cores);
    if slots == 0 {
        return Err(Failure::input("slots", "0", "is out of range", "give 1 or more"));
    }
    start_log();
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .map_err(|error| Failure::Work(error.to_string()))?;
    runtime.block_on(async {
        let stop = CancellationToken::new();
        worker::stop_on_signals(stop.clone()).map_err(|error| Failure::Work(error.to_string()))?;
        let stack = stack::Stack::start(&arguments.data_dir, slots).await?;
        let ended = accompany(&stack, &sweep, arguments, &stop).await;
        stack.end().await;
        ended
    })
}

/// Reads the sweep before anything is begun.
fn definition(arguments: &Arguments) -> Result<Sweep, Failure> {
    let overrides = input::overrides_of(&arguments.overrides)?;
    match &arguments.file {
        None => Ok(scene::preset("cohesive-mini", &overrides)?),
        Some(path) => {
            let mut value = input::read(path)?;
            input::apply_to_base(&mut value, overrides);
            Ok(Sweep::from_json(&value)?)
        }
    }
}

async fn accompany(
    stack: &stack::Stack,
    sweep: &Sweep,
    arguments: &Arguments,
    stop: &CancellationToken,
) -> Result<(), Failure> {
    let definition = sweep.to_json();
    let key = remote::submit::idempotency_key(&definition);
    let submitted: SweepView = stack.client.submit(definition.to_string().as_bytes(), &key).await?;
    eprintln!(
        "{}: {} points, {} done before; coordinator at {}, results in {}",
        submitted.name,
        submitted.points,
        submitted.counts.done,
        stack.client.server(),
        arguments.data_dir.display()
    );
    let Some(view) = watch::until_over(stack, submitted.id, stop).await? else {
        return Err(Failure::Work("stopped; the same command goes on where it was".to_owned()));
    };
    let found = report::gather(&stack.client, &view).await?;
    output::text(&report::text(&found))?;
    let folder = files::write(&stack.client, &arguments.data_dir, &view, &found).await?;
    eprintln!("written to {}", folder.display());
    match view.state {
        SweepState::Done => Ok(()),
        state => Err(Failure::Work(format!(
            "the sweep is {}: {} of {} points have no result (see the attempts of their jobs)",
            state.name(),
            view.points.saturating_sub(view.counts.done),
            view.points
        ))),
    }
}

/// Warnings only: progress and results are told otherwise.
fn start_log() {
    let filter = tracing_subscriber::EnvFilter::try_from_env("TAMP_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("error"));
    tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).init();
}
