//! A whole worker process: settings, log, signals, runtime, exit status.

use std::process::ExitCode;

use tokio_util::sync::CancellationToken;
use tracing_subscriber::EnvFilter;

use crate::{Config, Flags, Parts, WorkerError, host, run, stop_on_signals};

/// Runs a worker with these flags until it ends. Exit status 0 after a clean end, 2 for bad settings, 1 otherwise.
#[must_use]
pub fn main(flags: &Flags) -> ExitCode {
    let filter = EnvFilter::try_from_env("TAMP_LOG").unwrap_or_else(|_| EnvFilter::new("info"));
    tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).init();
    match start(flags) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            tracing::error!("{error}");
            ExitCode::from(if error.is_bad_input() { 2 } else { 1 })
        }
    }
}

fn start(flags: &Flags) -> Result<(), WorkerError> {
    let config = Config::load(flags)?;
    // before any other thread exists: threads inherit it
    if config.nice > 0
        && let Err(error) = host::be_nice(config.nice)
    {
        tracing::warn!(%error, "the priority stays as it is");
    }
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .map_err(WorkerError::Runtime)?;
    runtime.block_on(async {
        let stop = CancellationToken::new();
        stop_on_signals(stop.clone()).map_err(WorkerError::Runtime)?;
        run(config, Parts::default(), stop).await
    })?;
    Ok(())
}
