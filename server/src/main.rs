//! `tamp-server`: the coordinator.

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser;
use server::{Args, Config};
use tokio_util::sync::CancellationToken;

fn main() -> ExitCode {
    match start(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // The log may not be set up yet.
            let _ = writeln!(std::io::stderr(), "tamp-server: {error}");
            ExitCode::FAILURE
        }
    }
}

fn start(args: &Args) -> Result<(), Box<dyn std::error::Error>> {
    if args.print_api {
        std::io::stdout().write_all(server::description().as_bytes())?;
        return Ok(());
    }
    let config = Config::load(args)?;
    if args.check_config {
        let shown = Config { token: config.token.as_ref().map(|_| "(hidden)".to_owned()), ..config };
        writeln!(std::io::stdout(), "{shown:#?}")?;
        return Ok(());
    }
    server::telemetry::init(&config.log, config.log_json)?;
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    runtime.block_on(async {
        let shutdown = CancellationToken::new();
        let running = server::run(config, shutdown.clone()).await?;
        server::stop_signal().await;
        tracing::info!("stopping");
        shutdown.cancel();
        running.finished().await;
        Ok(())
    })
}
