//! Figures 1, 3, 4 and 5 of the study of plastic discs from tables of states, with the constants of the fits:
//! `plastic_figures FOLDER` reads `assembly-*.csv` and `diametrical-*.csv` (`elastic`, `h0`, `h1`, `h3` in MPa, as the
//! example `plastic_scene` of sim-core writes them) and writes SVG and `constants.json` beside them.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use std::error::Error;
use std::path::Path;

use analysis::plastic::{CompactionOptions, PlasticCurve, compaction, coordination};
use analysis::plot::{compaction_svg, coordination_svg, curvature_svg, stress_strain_svg};
use record::Row;
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: plastic_figures FOLDER")?;
    let folder = Path::new(&folder);
    let discs = curves(folder, "diametrical")?;
    if !discs.is_empty() {
        std::fs::write(folder.join("figure-1.svg"), stress_strain_svg(&discs))?;
    }
    let packings = curves(folder, "assembly")?;
    if packings.is_empty() {
        return Ok(());
    }
    let compacted = compaction(&packings, &CompactionOptions::default())?;
    std::fs::write(folder.join("figure-3.svg"), curvature_svg(&compacted))?;
    std::fs::write(folder.join("figure-4.svg"), compaction_svg(&compacted))?;
    let coordinated = coordination(&packings)?;
    std::fs::write(folder.join("figure-5.svg"), coordination_svg(&coordinated))?;
    let mut compaction = serde_json::to_value(&compacted)?;
    let mut coordination = serde_json::to_value(&coordinated)?;
    // the points are in the tables
    for (answer, series) in
        [(&mut compaction, ["states", "model"]), (&mut coordination, ["points", "points"])]
    {
        for curve in answer["curves"].as_array_mut().into_iter().flatten() {
            for name in series {
                curve.as_object_mut().and_then(|curve| curve.remove(name));
            }
            strip_residuals(curve);
        }
    }
    let constants = json!({ "compaction": compaction, "coordination": coordination });
    std::fs::write(folder.join("constants.json"), serde_json::to_string_pretty(&constants)? + "\n")?;
    println!("{constants:#}");
    Ok(())
}

fn strip_residuals(value: &mut Value) {
    match value {
        Value::Object(members) => {
            members.remove("residuals");
            members.values_mut().for_each(strip_residuals);
        }
        Value::Array(items) => items.iter_mut().for_each(strip_residuals),
        _ => {}
    }
}

fn curves(folder: &Path, setup: &str) -> Result<Vec<PlasticCurve>, Box<dyn Error>> {
    let mut curves = Vec::new();
    for (name, h) in [("elastic", None), ("h0", Some(0.0)), ("h1", Some(1e6)), ("h3", Some(3e6))] {
        let path = folder.join(format!("{setup}-{name}.csv"));
        if !path.exists() {
            continue;
        }
        let mut run = Row::new();
        run.put("setup", setup)
            .put("id", name)
            .put("material", if h.is_some() { "plastic" } else { "elastic" });
        for (key, value) in [("young", 10e6), ("nu", 0.45), ("sigma_y", 0.4e6), ("h", h.unwrap_or(0.0))] {
            run.number(key, value)?;
        }
        curves.push(PlasticCurve::from_run(&run, &states(&std::fs::read_to_string(path)?)?));
    }
    Ok(curves)
}

/// Rows of a table whose head is `name[unit],…`.
fn states(text: &str) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut lines = text.lines();
    let head = lines.next().ok_or("an empty table")?;
    let names: Vec<&str> = head.split(',').filter_map(|column| column.split('[').next()).collect();
    let row = |line: &str| -> Result<Row, Box<dyn Error>> {
        let mut row = Row::new();
        for (name, cell) in names.iter().zip(line.split(',')) {
            row.number(name, cell.parse()?)?;
        }
        Ok(row)
    };
    lines.map(row).collect()
}
