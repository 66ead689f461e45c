//! Axes of `grid` and `zip`.

use serde_json::{Map, Value};

use super::known_key;
use crate::sweep::axis::Values;
use crate::sweep::{Axis, Sweep};
use crate::table::{Key, check_value, join, unknown_name};
use crate::{Model, Problem};

const RANGES: [&str; 3] = ["log", "lin", "values"];
const REMEDY: &str = "give a list of values, {\"log\": [first, last, count]}, {\"lin\": [first, last, count]} or {\"values\": […]}";

/// The axes of a part, in the order of their names.
pub(super) fn read(
    path: &str,
    model: Model,
    value: Option<&Value>,
    problems: &mut Vec<Problem>,
) -> Vec<Axis> {
    let axes = match value {
        None => return Vec::new(),
        Some(Value::Object(axes)) if !axes.is_empty() => axes,
        Some(other) => {
            let problem = if other.is_object() { "is empty" } else { "is not an object" };
            problems.push(Problem::new(path, other, problem, "give an object of keys and their values"));
            return Vec::new();
        }
    };
    let mut names: Vec<&String> = axes.keys().collect();
    names.sort_unstable();
    names
        .into_iter()
        .filter_map(|name| read_axis(&join(path, name), model, name, &axes[name], problems))
        .collect()
}

fn read_axis(
    path: &str,
    model: Model,
    name: &str,
    value: &Value,
    problems: &mut Vec<Problem>,
) -> Option<Axis> {
    let key = known_key(path, model, name, value, problems)?;
    let values = match value {
        Value::Array(values) => listed(path, key, values, problems)?,
        Value::Object(range) => read_range(path, key, value, range, problems)?,
        other => {
            let remedy = format!("{REMEDY}; one fixed value belongs into `base`");
            problems.push(Problem::new(path, other, "is not a list of values or a range", remedy));
            return None;
        }
    };
    Some(Axis { key: key.name.to_owned(), whole: key.domain.is_whole(), values })
}

fn listed(path: &str, key: &Key, values: &[Value], problems: &mut Vec<Problem>) -> Option<Values> {
    if values.is_empty() {
        problems.push(Problem::new(path, &Value::from(values), "is empty", "give at least one value"));
        return None;
    }
    let settled: Vec<Option<Value>> = values
        .iter()
        .enumerate()
        .map(|(index, value)| check_value(&format!("{path}[{index}]"), key, value, problems))
        .collect();
    settled.into_iter().collect::<Option<Vec<_>>>().map(Values::Listed)
}

fn read_range(
    path: &str,
    key: &Key,
    whole: &Value,
    range: &Map<String, Value>,
    problems: &mut Vec<Problem>,
) -> Option<Values> {
    let before = problems.len();
    for (name, value) in range {
        if !RANGES.contains(&name.as_str()) {
            problems.push(unknown_name(join(path, name), value, "range", name, &RANGES));
        }
    }
    if problems.len() > before {
        return None;
    }
    let mut kinds = range.iter();
    let (Some((kind, value)), None) = (kinds.next(), kinds.next()) else {
        let problem = if range.is_empty() { "is empty" } else { "has more than one range" };
        problems.push(Problem::new(path, whole, problem, REMEDY));
        return None;
    };
    let at = join(path, kind);
    let Value::Array(elements) = value else {
        problems.push(Problem::new(at, value, "is not a list", REMEDY));
        return None;
    };
    if kind == "values" {
        return listed(&at, key, elements, problems);
    }
    if !key.domain.is_numeric() {
        problems.push(Problem::new(
            at,
            value,
            format!("{} is not a number", key.name),
            "give a list of values",
        ));
        return None;
    }
    let [first, last, count] = elements.as_slice() else {
        let problem = format!("has {} elements, not three", elements.len());
        problems.push(Problem::new(at, value, problem, format!("give {{\"{kind}\": [first, last, count]}}")));
        return None;
    };
    let logarithmic = kind == "log";
    let ends = [first, last].map(|end| end.as_f64().filter(|number| number.is_finite()));
    for (place, (end, given)) in ends.iter().zip([first, last]).enumerate() {
        let problem = match end {
            None => "is not a finite number",
            Some(number) if logarithmic && *number <= 0.0 => "is not above 0, as a logarithmic range needs",
            Some(_) => continue,
        };
        problems.push(Problem::new(
            format!("{at}[{place}]"),
            given,
            problem,
            "give a number, or use \"lin\"",
        ));
    }
    let counted = count.as_u64().filter(|number| (2..=Sweep::MAX_POINTS).contains(number));
    if counted.is_none() {
        let remedy = format!("give a whole number from 2 to {}", Sweep::MAX_POINTS);
        problems.push(Problem::new(format!("{at}[2]"), count, "is not a number of values", remedy));
    }
    if problems.len() > before {
        return None;
    }
    let (first, last, count) = (ends[0]?, ends[1]?, counted?);
    if first == last {
        let remedy = "give two different ends, or one value in `base`";
        problems.push(Problem::new(at, value, "starts and ends at one value", remedy));
        return None;
    }
    Some(if logarithmic {
        Values::Logarithmic { first, last, count }
    } else {
        Values::Linear { first, last, count }
    })
}

/// Axes that are walked together have equal lengths.
pub(super) fn check_equal_lengths(path: &str, axes: &[Axis], problems: &mut Vec<Problem>) {
    let Some(first) = axes.first() else { return };
    if axes.iter().any(|axis| axis.len() != first.len()) {
        let lengths: Vec<String> = axes.iter().map(|axis| format!("{}: {}", axis.key, axis.len())).collect();
        problems.push(Problem {
            field: path.to_owned(),
            value: lengths.join(", "),
            problem: "the axes have different lengths".to_owned(),
            remedy: "give each axis the same number of values".to_owned(),
        });
    }
}

impl Sweep {
    /// Every value of a range lies in the domain of its key. Runs after the size was checked.
    pub(super) fn check_ranges(&self, problems: &mut Vec<Problem>) {
        for (index, block) in self.blocks.iter().enumerate() {
            for (part, axes) in [("grid", &block.grid), ("zip", &block.zip)] {
                for axis in axes {
                    let kind = match axis.values {
                        Values::Listed(_) => continue,
                        Values::Linear { .. } => "lin",
                        Values::Logarithmic { .. } => "log",
                    };
                    let key = self.model.key(&axis.key).expect("axes have known keys");
                    let field = format!("blocks[{index}].{part}.{}.{kind}", axis.key);
                    // One problem per range is enough.
                    (0..axis.len())
                        .any(|place| check_value(&field, key, &axis.value(place), problems).is_none());
                }
            }
        }
    }
}
