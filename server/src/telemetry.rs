//! Logs.

use std::io::IsTerminal;

use tracing_subscriber::EnvFilter;
use tracing_subscriber::fmt;

/// Starts logging to stderr: text for people, or JSON lines. A second call changes nothing.
///
/// # Errors
/// When the filter does not parse.
pub fn init(filter: &str, json: bool) -> Result<(), String> {
    let filter = EnvFilter::try_new(filter).map_err(|error| format!("log = {filter:?}: {error}"))?;
    let logs =
        fmt().with_env_filter(filter).with_ansi(std::io::stderr().is_terminal()).with_writer(std::io::stderr);
    // An error means that a host process has set up logging already.
    let _ = if json { logs.json().try_init() } else { logs.try_init() };
    Ok(())
}
