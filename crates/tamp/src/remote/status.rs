//! `tamp status`: the sweeps of a coordinator, or one of them.

use serde_json::Value;

use super::{Remote, block_on};
use crate::failure::Failure;
use crate::output;

/// Arguments of `tamp status`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Id of a sweep; without it, the newest sweeps are listed
    sweep: Option<protocol::SweepId>,
    #[command(flatten)]
    remote: Remote,
}

/// Prints the state as JSON.
pub fn status(arguments: &Arguments) -> Result<(), Failure> {
    let client = arguments.remote.client()?;
    let path = arguments.sweep.map_or_else(|| "/v1/sweeps".to_owned(), |id| format!("/v1/sweeps/{id}"));
    let answer: Value = block_on(async { Ok(client.get(&path).await?) })?;
    output::json(&answer)
}
