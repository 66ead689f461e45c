//! Reads and checks a sweep definition; every problem is reported with its field path.

mod axes;
mod filters;

use serde_json::{Map, Value};

use super::{Block, Sweep};
use crate::scene::read_model;
use crate::table::{Absent, check_value, join, unknown_name};
use crate::{Model, Problem, Problems, parse_json};

const FIELDS: [&str; 7] = ["name", "model", "base", "blocks", "replicates", "where", "priority"];
const PARTS: [&str; 3] = ["grid", "zip", "list"];

/// Longest name [characters].
const NAME: usize = 200;

/// Largest size of a priority.
const PRIORITY: i64 = 1_000_000;

impl Sweep {
    /// Reads and checks a definition.
    ///
    /// # Errors
    /// [`Problems`]: every one that can be seen without expanding the sweep; [`Sweep::survey`] finds those of single
    /// points.
    pub fn from_json(value: &Value) -> Result<Self, Problems> {
        let Value::Object(object) = value else {
            let remedy = "give an object: {\"name\": …, \"model\": …, \"base\": {…}, \"blocks\": […]}";
            return Err(Problem::new("", value, "a sweep is an object", remedy).into());
        };
        let mut problems = Vec::new();
        for (name, value) in object {
            if !FIELDS.contains(&name.as_str()) {
                problems.push(unknown_name(name.clone(), value, "key", name, &FIELDS));
            }
        }
        let name = read_name(object.get("name"), &mut problems);
        let priority = read_priority(object.get("priority"), &mut problems);
        let replicates = read_replicates(object.get("replicates"), &mut problems);
        let model = match read_model(object.get("model")) {
            Ok(model) => model,
            Err(Problems(found)) => {
                problems.extend(found);
                // Without a model no key can be checked.
                return Err(Problems(problems));
            }
        };
        if replicates > 1 && model.key("seed").is_none() {
            problems.push(Problem::new(
                "replicates",
                &Value::from(replicates),
                "the model has no seed",
                "give 1",
            ));
        }
        let base = read_keys("base", model, object.get("base"), &mut problems);
        let filters = filters::read(model, object.get("where"), &mut problems);
        let blocks = read_blocks(model, &base, object.get("blocks"), &mut problems);
        let sweep = Self { name, model, base, blocks, replicates, filters, priority };
        sweep.check_size(&mut problems);
        if problems.is_empty() {
            sweep.check_ranges(&mut problems);
        }
        Problems::none_or(problems)?;
        Ok(sweep)
    }

    /// Reads and checks a definition from JSON text; see [`parse_json`] for what that adds.
    ///
    /// # Errors
    /// As [`Sweep::from_json`].
    pub fn from_text(text: &str) -> Result<Self, Problems> {
        Self::from_json(&parse_json(text.as_bytes())?)
    }

    /// Refuses sweeps that are too large from the counts alone.
    fn check_size(&self, problems: &mut Vec<Problem>) {
        let total = self.blocks.iter().try_fold(0_u64, |sum, block| {
            sum.checked_add(block.checked_size()?.checked_mul(self.replicates)?)
        });
        if total.is_none_or(|points| points > Self::MAX_POINTS) {
            let count = total.map_or_else(|| "more than 1.8e19 points".to_owned(), |n| format!("{n} points"));
            problems.push(Problem {
                field: "blocks".to_owned(),
                value: count,
                problem: format!("a sweep has at most {} points", Self::MAX_POINTS),
                remedy: "use fewer values per axis, or several sweeps".to_owned(),
            });
        }
    }
}

fn read_name(value: Option<&Value>, problems: &mut Vec<Problem>) -> String {
    let remedy = format!("give a name of 1 to {NAME} characters");
    match value {
        Some(Value::String(name)) if !name.trim().is_empty() && name.chars().count() <= NAME => {
            return name.clone();
        }
        Some(other) => problems.push(Problem::new("name", other, "is not a name", remedy)),
        None => problems.push(absent("name", remedy)),
    }
    String::new()
}

fn read_priority(value: Option<&Value>, problems: &mut Vec<Problem>) -> i64 {
    let Some(value) = value else { return 0 };
    match value.as_i64() {
        Some(priority) if (-PRIORITY..=PRIORITY).contains(&priority) => priority,
        _ => {
            let remedy = format!("give a whole number from -{PRIORITY} to {PRIORITY}; larger runs first");
            problems.push(Problem::new("priority", value, "is not a priority", remedy));
            0
        }
    }
}

fn read_replicates(value: Option<&Value>, problems: &mut Vec<Problem>) -> u64 {
    let Some(value) = value else { return 1 };
    match value.as_u64() {
        Some(count) if (1..=Sweep::MAX_REPLICATES).contains(&count) => count,
        _ => {
            let remedy = format!("give a whole number from 1 to {}", Sweep::MAX_REPLICATES);
            problems.push(Problem::new("replicates", value, "is not a number of replicates", remedy));
            1
        }
    }
}

/// Keys of the model with one value each; none of them has to be there.
fn read_keys(
    path: &str,
    model: Model,
    value: Option<&Value>,
    problems: &mut Vec<Problem>,
) -> Map<String, Value> {
    let mut settled = Map::new();
    match value {
        None => {}
        Some(Value::Object(object)) => {
            for (name, value) in object {
                let field = join(path, name);
                if let Some(key) = known_key(&field, model, name, value, problems)
                    && let Some(value) = check_value(&field, key, value, problems)
                {
                    settled.insert(name.clone(), value);
                }
            }
        }
        Some(other) => {
            problems.push(Problem::new(path, other, "is not an object", "give an object of keys and values"));
        }
    }
    settled
}

fn known_key(
    field: &str,
    model: Model,
    name: &str,
    value: &Value,
    problems: &mut Vec<Problem>,
) -> Option<&'static crate::table::Key> {
    let found = model.key(name);
    if found.is_none() {
        let known: Vec<&str> = model.keys().iter().map(|key| key.name).collect();
        problems.push(unknown_name(field.to_owned(), value, "key", name, &known));
    }
    found
}

fn read_blocks(
    model: Model,
    base: &Map<String, Value>,
    value: Option<&Value>,
    problems: &mut Vec<Problem>,
) -> Vec<Block> {
    let only_base = Block { grid: Vec::new(), zip: Vec::new(), list: Vec::new() };
    let Some(value) = value else {
        check_complete("base", model, &[base], &only_base, problems);
        return vec![only_base];
    };
    let Value::Array(blocks) = value else {
        problems.push(Problem::new("blocks", value, "is not a list", "give a list of blocks"));
        return Vec::new();
    };
    if blocks.is_empty() {
        let remedy = "give at least one block, or leave `blocks` out to run the base alone";
        problems.push(Problem::new("blocks", value, "is empty", remedy));
    }
    blocks
        .iter()
        .enumerate()
        .filter_map(|(index, block)| read_block(&format!("blocks[{index}]"), model, base, block, problems))
        .collect()
}

fn read_block(
    path: &str,
    model: Model,
    base: &Map<String, Value>,
    value: &Value,
    problems: &mut Vec<Problem>,
) -> Option<Block> {
    let Value::Object(parts) = value else {
        let remedy = "give an object with `grid`, `zip` or `list`";
        problems.push(Problem::new(path, value, "is not an object", remedy));
        return None;
    };
    let before = problems.len();
    for (name, value) in parts {
        if !PARTS.contains(&name.as_str()) {
            problems.push(unknown_name(join(path, name), value, "part", name, &PARTS));
        }
    }
    if parts.is_empty() {
        problems.push(Problem::new(path, value, "is empty", "give `grid`, `zip` or `list`"));
    }
    let grid = axes::read(&join(path, "grid"), model, parts.get("grid"), problems);
    let zip = axes::read(&join(path, "zip"), model, parts.get("zip"), problems);
    axes::check_equal_lengths(&join(path, "zip"), &zip, problems);
    let list = read_list(&join(path, "list"), model, parts.get("list"), problems);
    let block = Block { grid, zip, list };
    check_overlaps(path, &block, problems);
    if problems.len() > before {
        return None;
    }
    if block.list.is_empty() {
        check_complete(path, model, &[base], &block, problems);
    }
    for (index, entry) in block.list.iter().enumerate() {
        check_complete(&format!("{path}.list[{index}]"), model, &[base, entry], &block, problems);
    }
    (problems.len() == before).then_some(block)
}

fn read_list(
    path: &str,
    model: Model,
    value: Option<&Value>,
    problems: &mut Vec<Problem>,
) -> Vec<Map<String, Value>> {
    match value {
        None => Vec::new(),
        Some(Value::Array(entries)) if !entries.is_empty() => entries
            .iter()
            .enumerate()
            .map(|(index, entry)| read_keys(&format!("{path}[{index}]"), model, Some(entry), problems))
            .collect(),
        Some(other) => {
            let problem = if other.is_array() { "is empty" } else { "is not a list" };
            problems.push(Problem::new(path, other, problem, "give a list of objects, one per point"));
            Vec::new()
        }
    }
}

/// A key belongs to one part of a block.
fn check_overlaps(path: &str, block: &Block, problems: &mut Vec<Problem>) {
    let mut overlap = |key: &str, one: &str, other: String| {
        problems.push(Problem {
            field: format!("{path}.{other}.{key}"),
            value: format!("{key:?}"),
            problem: format!("the key is in `{one}` of the same block too"),
            remedy: "keep it in one of them, or make two blocks".to_owned(),
        });
    };
    for axis in &block.zip {
        if block.grid.iter().any(|other| other.key == axis.key) {
            overlap(&axis.key, "grid", "zip".to_owned());
        }
    }
    for (index, entry) in block.list.iter().enumerate() {
        for key in entry.keys() {
            for (part, axes) in [("grid", &block.grid), ("zip", &block.zip)] {
                if axes.iter().any(|axis| axis.key == *key) {
                    overlap(key, part, format!("list[{index}]"));
                }
            }
        }
    }
}

/// Every required key has to come from somewhere.
fn check_complete(
    path: &str,
    model: Model,
    given: &[&Map<String, Value>],
    block: &Block,
    problems: &mut Vec<Problem>,
) {
    for key in model.keys().iter().filter(|key| key.absent == Absent::Required) {
        let in_maps = given.iter().any(|keys| keys.contains_key(key.name));
        let in_axes = block.grid.iter().chain(&block.zip).any(|axis| axis.key == key.name);
        // A key of the base with a problem of its own is reported there.
        let reported = problems.iter().any(|problem| problem.field == join("base", key.name));
        if !in_maps && !in_axes && !reported {
            let remedy = format!("give the {} in `base` or in the block", key.meaning);
            problems.push(Problem {
                field: join(path, key.name),
                value: "absent".to_owned(),
                problem: "is required".to_owned(),
                remedy,
            });
        }
    }
}

fn absent(field: &str, remedy: String) -> Problem {
    Problem { field: field.to_owned(), value: "absent".to_owned(), problem: "is required".to_owned(), remedy }
}
