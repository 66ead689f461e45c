//! A point that was left before its end: its checkpoint and the rows it has had, in one file.

use std::fs;
use std::path::{Path, PathBuf};

use scene::Scene;
use sim_core::{Options, SimError, Simulation, compile, restore};

/// What a point goes on from.
#[derive(Default)]
pub struct Left {
    /// CPU time of its steps so far [s].
    pub cpu: f64,
    /// Step at which the next row is due.
    pub next: u64,
    /// Rows so far, as they go into the sheet.
    pub rows: Vec<String>,
}

/// Where the state of a point lies.
pub fn path(out: &str, label: &str) -> PathBuf {
    PathBuf::from(format!("{out}.{label}.state"))
}

/// Whether the point was left when e counted as settled.
pub fn settled(path: &Path) -> bool {
    fs::read(path).is_ok_and(|bytes| bytes.windows(9).any(|part| part == b",settled,"))
}

/// Writes text, an empty line and the checkpoint; renamed into place, so that an interrupted write leaves the one before.
pub fn write(path: &Path, left: &Left, checkpoint: &[u8]) {
    let mut bytes = format!("{}\n{}\n", left.cpu, left.next).into_bytes();
    for row in &left.rows {
        bytes.extend(row.bytes().chain([b'\n']));
    }
    bytes.push(b'\n');
    bytes.extend(checkpoint);
    let fresh = path.with_extension("fresh");
    fs::write(&fresh, bytes).expect("a writable file");
    fs::rename(fresh, path).expect("a writable file");
}

/// A scene from where it was left, or from its start.
pub fn open(path: &Path, scene: &Scene, options: &Options) -> Result<(Box<dyn Simulation>, Left), SimError> {
    let reduced = scene.reduce();
    let Ok(bytes) = fs::read(path) else {
        return Ok((compile(&reduced, options)?, Left::default()));
    };
    let end = bytes.windows(2).position(|pair| pair == b"\n\n").expect("a file that this program wrote");
    let text = std::str::from_utf8(&bytes[..end]).expect("a file that this program wrote");
    let mut lines = text.lines();
    let left = Left {
        cpu: lines.next().and_then(|line| line.parse().ok()).expect("CPU seconds"),
        next: lines.next().and_then(|line| line.parse().ok()).expect("a step"),
        rows: lines.map(str::to_owned).collect(),
    };
    Ok((restore(&reduced, options, &bytes[end + 2..])?, left))
}
