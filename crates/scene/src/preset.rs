//! Ready sweeps: the published studies, and small ones to begin with.

use serde_json::{Map, Value};

use crate::table::unknown_name;
use crate::{Problem, Problems, Sweep};

/// A ready sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name, for `tamp preset NAME`.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// The definition, as JSON text; the file under `examples/`.
    pub text: &'static str,
}

/// Every preset, in the order of the documentation.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "cohesive-mini",
        summary: "72 runs of 500 spheres (36 points, two seeds each): the collapse in a minute or two",
        text: include_str!("../../../examples/cohesive-mini.json"),
    },
    Preset {
        name: "cohesive-study",
        summary: "the 291 runs of the study of cohesive dynamic compaction (2024), 17657 spheres each",
        text: include_str!("../../../examples/cohesive-study.json"),
    },
    Preset {
        name: "consolidation-2008",
        summary: "the 36 samples of the study of cohesive powders under isotropic loads (2008), 1400 to 10976 discs",
        text: include_str!("../../../examples/consolidation-2008.json"),
    },
    Preset {
        name: "plastic-compaction-2021",
        summary: "the 4 materials of the study of plastic disc packings (2021): one disc, its lattice cell, 3 packings of 300",
        text: include_str!("../../../examples/plastic-compaction-2021.json"),
    },
];

/// Fields of a definition that an override may replace beside the keys of the model.
const FIELDS: [&str; 3] = ["name", "replicates", "priority"];

/// A preset with some keys of its base, its name, replicates or priority replaced.
///
/// # Errors
/// [`Problems`] of an unknown preset, of an override that is not a key or that the preset sweeps, and of the
/// resulting definition.
pub fn preset(name: &str, overrides: &Map<String, Value>) -> Result<Sweep, Problems> {
    let Some(found) = PRESETS.iter().find(|preset| preset.name == name) else {
        let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
        let problem = unknown_name("preset".to_owned(), &Value::from(name), "preset", name, &names);
        return Err(problem.into());
    };
    let mut definition: Value = serde_json::from_str(found.text).expect("a preset is JSON");
    let swept = swept_keys(&definition);
    let mut problems = Vec::new();
    for (key, value) in overrides {
        if FIELDS.contains(&key.as_str()) {
            definition[key] = value.clone();
        } else if swept.contains(key) {
            let remedy = "print the preset and edit its blocks";
            problems.push(Problem::new(key.clone(), value, "the preset sweeps this key", remedy));
        } else {
            definition["base"][key] = value.clone();
        }
    }
    Problems::none_or(problems)?;
    Sweep::from_json(&definition)
}

/// The keys that some block of a definition sets.
fn swept_keys(definition: &Value) -> Vec<String> {
    let blocks = definition["blocks"].as_array().map_or(&[][..], Vec::as_slice);
    let parts = blocks.iter().flat_map(|block| ["grid", "zip", "list"].map(|part| &block[part]));
    let objects = parts.flat_map(|part| match part {
        Value::Array(entries) => entries.iter().collect(),
        other => vec![other],
    });
    objects.filter_map(Value::as_object).flat_map(|keys| keys.keys().cloned()).collect()
}
