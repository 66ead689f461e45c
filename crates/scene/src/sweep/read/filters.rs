//! `where`.

use serde_json::{Map, Value};

use crate::sweep::Filter;
use crate::table::{Domain, unknown_name};
use crate::{Model, Problem};

const FIELDS: [&str; 3] = ["quantity", "min", "max"];

/// The names `where` takes: numeric keys and derived quantities.
fn quantities(model: Model) -> Vec<&'static str> {
    let keys = model
        .keys()
        .iter()
        .filter(|key| key.domain.is_numeric() && !matches!(key.domain, Domain::Auto(_)))
        .map(|key| key.name);
    keys.chain(model.quantities().into_iter().map(|quantity| quantity.name)).collect()
}

pub(super) fn read(model: Model, value: Option<&Value>, problems: &mut Vec<Problem>) -> Vec<Filter> {
    match value {
        None => Vec::new(),
        Some(Value::Array(filters)) => filters
            .iter()
            .enumerate()
            .filter_map(|(index, filter)| read_filter(&format!("where[{index}]"), model, filter, problems))
            .collect(),
        Some(other) => {
            let remedy = "give a list of {\"quantity\": …, \"min\": …, \"max\": …}";
            problems.push(Problem::new("where", other, "is not a list", remedy));
            Vec::new()
        }
    }
}

fn read_filter(path: &str, model: Model, value: &Value, problems: &mut Vec<Problem>) -> Option<Filter> {
    let Value::Object(object) = value else {
        let remedy = "give {\"quantity\": …, \"min\": …, \"max\": …}";
        problems.push(Problem::new(path, value, "is not an object", remedy));
        return None;
    };
    let before = problems.len();
    for (name, value) in object {
        if !FIELDS.contains(&name.as_str()) {
            problems.push(unknown_name(format!("{path}.{name}"), value, "key", name, &FIELDS));
        }
    }
    let known = quantities(model);
    let quantity = match object.get("quantity") {
        Some(Value::String(name)) if known.contains(&name.as_str()) => name.clone(),
        Some(other) => {
            let name = other.as_str().map_or_else(|| other.to_string(), str::to_owned);
            problems.push(unknown_name(format!("{path}.quantity"), other, "quantity", &name, &known));
            String::new()
        }
        None => {
            problems.push(super::absent(
                &format!("{path}.quantity"),
                format!("give one of {}", known.join(", ")),
            ));
            String::new()
        }
    };
    let min = read_end(path, "min", object, problems);
    let max = read_end(path, "max", object, problems);
    if !object.contains_key("min") && !object.contains_key("max") {
        problems.push(Problem::new(path, value, "has no end", "give `min`, `max` or both"));
    }
    if let (Some(min), Some(max)) = (min, max)
        && min > max
    {
        problems.push(Problem::new(path, value, "`min` is above `max`", "swap them"));
    }
    (problems.len() == before).then_some(Filter { quantity, min, max })
}

fn read_end(path: &str, name: &str, object: &Map<String, Value>, problems: &mut Vec<Problem>) -> Option<f64> {
    let value = object.get(name)?;
    let number = value.as_f64().filter(|number| number.is_finite());
    if number.is_none() {
        let remedy = "give a finite number, or leave it out";
        problems.push(Problem::new(format!("{path}.{name}"), value, "is not a finite number", remedy));
    }
    number
}
