//! `tamp preset`: prints a ready sweep.

use crate::failure::Failure;
use crate::{input, output};

/// Arguments of `tamp preset`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Name of the preset; without it, all are listed
    name: Option<String>,
    /// Replace a key of the base, for example --set n=1000
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
}

/// Prints the preset as a sweep definition.
pub fn preset(arguments: &Arguments) -> Result<(), Failure> {
    let Some(name) = &arguments.name else {
        let lines: Vec<String> =
            scene::PRESETS.iter().map(|preset| format!("{:<16} {}\n", preset.name, preset.summary)).collect();
        return output::text(&lines.concat());
    };
    let sweep = scene::preset(name, &input::overrides_of(&arguments.overrides)?)?;
    output::json(&sweep.to_json())
}
