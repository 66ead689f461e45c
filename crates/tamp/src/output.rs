//! Standard output, for results only; everything else goes to stderr.

use std::io::{ErrorKind, Write as _};

use serde::Serialize;

use crate::failure::Failure;

/// Prints text as it is.
pub fn text(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::OutputClosed,
        _ => Failure::Work(format!("standard output: {error}")),
    })
}

/// Prints a value as indented JSON.
pub fn json<T: Serialize>(value: &T) -> Result<(), Failure> {
    let mut written = serde_json::to_string_pretty(value)
        .map_err(|error| Failure::Work(format!("cannot be written as JSON: {error}")))?;
    written.push('\n');
    text(&written)
}
