//! Commands that talk to a coordinator elsewhere.

pub mod results;
pub mod status;
pub mod submit;

use std::future::Future;
use std::time::Duration;

use protocol::client::{Client, Patience};

use crate::failure::Failure;

/// Where the coordinator is.
#[derive(clap::Args)]
pub struct Remote {
    /// Address of the coordinator
    #[arg(long, value_name = "URL", env = "TAMP_SERVER", default_value = "http://127.0.0.1:8300")]
    server: String,
    /// Token of the coordinator
    #[arg(long, env = "TAMP_TOKEN", hide_env_values = true)]
    token: Option<String>,
}

impl Remote {
    /// A client for a person who waits.
    pub fn client(&self) -> Result<Client, Failure> {
        let patience = Patience::brief(Duration::from_secs(10));
        Ok(Client::new(&self.server, self.token.clone(), patience)?)
    }
}

/// Runs a few requests to their end.
pub fn block_on<T>(work: impl Future<Output = Result<T, Failure>>) -> Result<T, Failure> {
    tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(|error| Failure::Work(error.to_string()))?
        .block_on(work)
}
