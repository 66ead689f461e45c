//! `tamp serve`: a coordinator. The same as `tamp-server`, and its address on stdout once it listens.

use server::{Args, Config};
use tokio_util::sync::CancellationToken;

use crate::failure::Failure;
use crate::output;

/// Serves until told to stop.
pub fn serve(arguments: &Args) -> Result<(), Failure> {
    if arguments.print_api {
        return output::text(&server::description());
    }
    let config = Config::load(arguments).map_err(|error| {
        Failure::input("configuration", "given", error.to_string(), "see tamp serve --help")
    })?;
    if arguments.check_config {
        let shown = Config { token: config.token.as_ref().map(|_| "(hidden)".to_owned()), ..config };
        return output::text(&format!("{shown:#?}\n"));
    }
    server::telemetry::init(&config.log, config.log_json)
        .map_err(|why| Failure::input("log", &config.log, why, "give a filter, for example info"))?;
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()
        .map_err(|error| Failure::Work(error.to_string()))?;
    runtime.block_on(async {
        let stop = CancellationToken::new();
        worker::stop_on_signals(stop.clone()).map_err(|error| Failure::Work(error.to_string()))?;
        let running =
            server::run(config, stop.clone()).await.map_err(|error| Failure::Work(error.to_string()))?;
        output::text(&format!("{}\n", running.url()))?;
        stop.cancelled().await;
        running.finished().await;
        Ok(())
    })
}
