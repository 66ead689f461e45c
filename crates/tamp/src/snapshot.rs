//! Writes packing and series of a finished run into a directory.

use std::path::Path;

use record::Outcome;
use serde_json::{Map, Value};

use crate::failure::Failure;

/// Writes `record.json`, `outcome.json` (everything, with units), `series.csv`, one CSV per table of the packing,
/// and `packing.vtk`.
pub fn write(directory: &Path, outcome: &Outcome, record: &Map<String, Value>) -> Result<(), Failure> {
    let put = |name: &str, content: &[u8]| {
        let path = directory.join(name);
        worker::write_durably(&path, content).map_err(|error| Failure::file(&path, &error))
    };
    let as_json = |value: serde_json::Result<Vec<u8>>| {
        value.map_err(|error| Failure::Work(format!("cannot be written as JSON: {error}")))
    };
    put("record.json", &as_json(serde_json::to_vec_pretty(record))?)?;
    put("outcome.json", &as_json(serde_json::to_vec(outcome))?)?;
    put("series.csv", record::csv(&outcome.series).as_bytes())?;
    for (name, table) in &outcome.packing.0 {
        put(&format!("{name}.csv"), record::csv(table).as_bytes())?;
    }
    match record::vtk(&outcome.packing, "packing") {
        Ok(text) => put("packing.vtk", text.as_bytes()),
        Err(why) => {
            eprintln!("note: no packing.vtk: {why}");
            Ok(())
        }
    }
}
