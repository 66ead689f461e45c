//! `tamp submit`: a sweep to a coordinator.

use serde_json::Value;

use super::{Remote, block_on};
use crate::failure::Failure;
use crate::{input, output};

/// Arguments of `tamp submit`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Sweep as JSON; - reads it from standard input
    file: String,
    /// Keys to replace in the base of the sweep
    #[arg(value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Only count and estimate; store nothing
    #[arg(long)]
    dry_run: bool,
    #[command(flatten)]
    remote: Remote,
}

/// Submits the sweep and prints what the coordinator says. The same definition again is the same sweep.
pub fn submit(arguments: &Arguments) -> Result<(), Failure> {
    let mut definition = input::read(&arguments.file)?;
    input::apply_to_base(&mut definition, input::overrides_of(&arguments.overrides)?);
    let client = arguments.remote.client()?;
    let answer: Value = block_on(async {
        if arguments.dry_run {
            Ok(client.post("/v1/sweeps?dry_run=true", Some(&definition)).await?)
        } else {
            let text = definition.to_string();
            Ok(client.submit(text.as_bytes(), &idempotency_key(&definition)).await?)
        }
    })?;
    output::json(&answer)
}

/// The same definition has the same key, whatever its spelling.
pub fn idempotency_key(definition: &Value) -> String {
    // object keys are sorted by serde_json: equal definitions are equal text
    format!("tamp-{}", scene::SceneKey::of(definition.to_string().as_bytes()))
}
