//! Time series and final packing of a run.

use std::fmt::Write as _;
use std::io::Read;

use protocol::{JobId, JobState};
use record::{Outcome, Packing, Table};
use serde::de::DeserializeOwned;

use super::App;
use crate::error::{AppError, AppResult, blocking};

/// How a packing is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SnapshotFormat {
    /// Columnar JSON: named tables of named columns with units.
    Json,
    /// VTK legacy ASCII: spheres as points, contacts as lines, every column as data.
    Vtk,
}

/// Largest outcome that is unpacked [bytes].
const LARGEST: u64 = 4 << 30;

/// Reads JSON packed by zstd.
pub(super) fn unpack<T: DeserializeOwned>(packed: &[u8]) -> AppResult<T> {
    let broken =
        |error: &dyn std::fmt::Display| AppError::Bug(format!("a stored outcome does not read: {error}"));
    let mut bytes = Vec::new();
    zstd::Decoder::new(packed)
        .map_err(|error| broken(&error))?
        .take(LARGEST)
        .read_to_end(&mut bytes)
        .map_err(|error| broken(&error))?;
    serde_json::from_slice(&bytes).map_err(|error| broken(&error))
}

impl App {
    /// The whole outcome of a finished run.
    ///
    /// # Errors
    /// [`AppError::NotFound`]; [`AppError::NotYet`] while the run is not done.
    pub async fn outcome(&self, id: JobId) -> AppResult<Outcome> {
        let missing = || AppError::NotFound { what: "job", id: id.to_string() };
        let Some(hash) = self.store().outcome_of(id).await? else {
            let held = self.store().lease(id).await?.ok_or_else(missing)?;
            let hint = match held.state {
                JobState::Queued | JobState::Leased => "ask again when it is",
                JobState::Done | JobState::Failed | JobState::Cancelled => "it has no result",
            };
            return Err(AppError::NotYet(format!("job {id} is {:?}, not done; {hint}", held.state)));
        };
        let blobs = std::sync::Arc::clone(self.blobs());
        blocking(move || unpack(&blobs.get(&hash)?)).await
    }
}

/// A packing as VTK legacy ASCII (version 3.0, unstructured grid): particles are points with a vertex
/// each; contacts between two particles are lines. Contacts with a wall have no line and are left out.
///
/// # Errors
/// [`AppError::NotFound`] when the packing has no positions.
pub fn vtk(packing: &Packing, title: &str) -> AppResult<String> {
    let missing = || AppError::NotFound { what: "packing with positions for", id: title.to_owned() };
    let particles = packing.0.get("particles").ok_or_else(missing)?;
    let x = particles.column("x").ok_or_else(missing)?;
    let y = particles.column("y").ok_or_else(missing)?;
    let z = particles.column("z").unwrap_or_else(|| vec![0.0; x.len()]);
    let lines = packing.0.get("contacts").map(|contacts| pairs(contacts, x.len())).unwrap_or_default();
    let mut out = String::new();
    write_vtk(&mut out, title, (&x, &y, &z), particles, packing.0.get("contacts"), &lines)
        .map_err(|error| AppError::Bug(error.to_string()))?;
    Ok(out)
}

/// Rows of the contact table that join two particles: row, first, second.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be indices")]
fn pairs(contacts: &Table, particles: usize) -> Vec<(usize, usize, usize)> {
    let (Some(i), Some(j)) = (contacts.column("i"), contacts.column("j")) else { return Vec::new() };
    #[expect(clippy::cast_precision_loss, reason = "particle numbers stay far below 2^53")]
    let end = particles as f64;
    let index = |value: f64| (value >= 0.0 && value < end && value.fract() == 0.0).then_some(value as usize);
    i.iter().zip(&j).enumerate().filter_map(|(row, (&i, &j))| Some((row, index(i)?, index(j)?))).collect()
}

/// Cell types of VTK.
const VERTEX: u8 = 1;
const LINE: u8 = 3;

type Positions<'a> = (&'a [f64], &'a [f64], &'a [f64]);

fn write_vtk(
    out: &mut String,
    title: &str,
    (x, y, z): Positions<'_>,
    particles: &Table,
    contacts: Option<&Table>,
    lines: &[(usize, usize, usize)],
) -> std::fmt::Result {
    let n = x.len();
    writeln!(
        out,
        "# vtk DataFile Version 3.0\ntamp {title}\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {n} double"
    )?;
    for ((x, y), z) in x.iter().zip(y).zip(z) {
        writeln!(out, "{x} {y} {z}")?;
    }
    let cells = n + lines.len();
    writeln!(out, "CELLS {cells} {}", 2 * n + 3 * lines.len())?;
    for point in 0..n {
        writeln!(out, "1 {point}")?;
    }
    for (_, i, j) in lines {
        writeln!(out, "2 {i} {j}")?;
    }
    writeln!(out, "CELL_TYPES {cells}")?;
    for _ in 0..n {
        writeln!(out, "{VERTEX}")?;
    }
    for _ in lines {
        writeln!(out, "{LINE}")?;
    }
    let scalars: Vec<_> = particles
        .columns()
        .iter()
        .filter(|column| !["x", "y", "z"].contains(&column.name.as_str()))
        .collect();
    if !scalars.is_empty() {
        writeln!(out, "POINT_DATA {n}\nFIELD particles {}", scalars.len())?;
        for column in scalars {
            writeln!(out, "{} 1 {n} double", word(&column.name))?;
            for value in &column.values {
                writeln!(out, "{}", value.get())?;
            }
        }
    }
    if let Some(contacts) = contacts.filter(|_| !lines.is_empty()) {
        // Cell data covers the vertices first, then the lines; vertices get zeros.
        writeln!(out, "CELL_DATA {cells}\nFIELD contacts {}", contacts.columns().len())?;
        for column in contacts.columns() {
            writeln!(out, "{} 1 {cells} double", word(&column.name))?;
            for _ in 0..n {
                writeln!(out, "0")?;
            }
            for (row, _, _) in lines {
                writeln!(out, "{}", column.values[*row].get())?;
            }
        }
    }
    Ok(())
}

/// A data name as VTK takes it.
fn word(name: &str) -> String {
    name.chars().map(|one| if one.is_whitespace() { '_' } else { one }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_are_points_and_contacts_are_lines() {
        let mut particles = Table::new();
        particles.push("x", "d", &[0.0, 1.0]).unwrap();
        particles.push("y", "d", &[0.0, 0.0]).unwrap();
        particles.push("z", "d", &[0.5, 0.5]).unwrap();
        particles.push("radius", "d", &[0.5, 0.5]).unwrap();
        let mut contacts = Table::new();
        contacts.push("i", "1", &[0.0, 1.0]).unwrap();
        contacts.push("j", "1", &[1.0, -1.0]).unwrap();
        contacts.push("fn", "kn d", &[0.25, 3.0]).unwrap();
        let packing =
            Packing([("particles".to_owned(), particles), ("contacts".to_owned(), contacts)].into());
        let text = vtk(&packing, "test").unwrap();
        let expected = "# vtk DataFile Version 3.0\ntamp test\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 double\n0 0 0.5\n\
                        1 0 0.5\nCELLS 3 7\n1 0\n1 1\n2 0 1\nCELL_TYPES 3\n1\n1\n3\nPOINT_DATA 2\nFIELD particles 1\n\
                        radius 1 2 double\n0.5\n0.5\nCELL_DATA 3\nFIELD contacts 3\ni 1 3 double\n0\n0\n0\n\
                        j 1 3 double\n0\n0\n1\nfn 1 3 double\n0\n0\n0.25\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_packing_without_positions_is_an_error() {
        assert!(vtk(&Packing::default(), "test").is_err());
    }
}
