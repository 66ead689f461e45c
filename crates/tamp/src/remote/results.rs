//! `tamp results`: the rows of a sweep.

use super::{Remote, block_on};
use crate::failure::Failure;
use crate::output;

/// Arguments of `tamp results`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Id of the sweep
    sweep: protocol::SweepId,
    /// How to print the rows
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    format: Format,
    #[command(flatten)]
    remote: Remote,
}

/// Formats of rows.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    Csv,
    Ndjson,
    Json,
}

/// Prints the rows.
pub fn results(arguments: &Arguments) -> Result<(), Failure> {
    let client = arguments.remote.client()?;
    let format = match arguments.format {
        Format::Csv => "csv",
        Format::Ndjson => "ndjson",
        Format::Json => "json",
    };
    let path = format!("/v1/sweeps/{}/results?format={format}", arguments.sweep);
    let bytes = block_on(async { Ok(client.get_bytes(&path).await?) })?;
    output::text(&String::from_utf8_lossy(&bytes))
}
