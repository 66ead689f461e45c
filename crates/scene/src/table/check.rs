//! Checks a JSON value against a key table, reports every problem, fills defaults, settles representations.

use serde_json::{Map, Value};

use super::{Absent, Domain, Key, LARGEST_INTEGER};
use crate::problem::{Problem, nearest};

/// What a name stands for, in messages: `key`, `quantity`, `model`.
pub(crate) type NameOf = &'static str;

/// The path of `name` inside the object at `path`.
pub(crate) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

/// The problem of a name that nobody knows.
pub(crate) fn unknown_name(
    field: String,
    value: &Value,
    what: NameOf,
    name: &str,
    known: &[&str],
) -> Problem {
    let remedy = match nearest(name, known) {
        Some(near) => format!("did you mean {near:?}? known: {}", known.join(", ")),
        None => format!("known: {}", known.join(", ")),
    };
    Problem::new(field, value, format!("unknown {what} {name:?}"), remedy)
}

/// Checks `object` against `keys`. Names in `besides` are left to the caller. Every problem is appended; the result
/// holds each key that is right, with defaults filled in and representations settled (`1e3` → `1000` for a whole
/// number, `"auto"` → `null`, a bare word → its record).
pub(crate) fn check_object(
    path: &str,
    keys: &[Key],
    besides: &[&str],
    object: &Map<String, Value>,
    problems: &mut Vec<Problem>,
) -> Map<String, Value> {
    let known: Vec<&str> = besides.iter().copied().chain(keys.iter().map(|key| key.name)).collect();
    for (name, value) in object {
        if !known.contains(&name.as_str()) {
            problems.push(unknown_name(join(path, name), value, "key", name, &known));
        }
    }
    let mut settled = Map::new();
    for key in keys {
        let field = join(path, key.name);
        let value = match object.get(key.name) {
            Some(given) => check_value(&field, key, given, problems),
            None => absent_as(&field, key, &settled, problems),
        };
        if let Some(value) = value {
            settled.insert(key.name.to_owned(), value);
        }
    }
    settled
}

/// The value of an absent key; a problem when it is required.
pub(crate) fn absent_as(
    field: &str,
    key: &Key,
    before: &Map<String, Value>,
    problems: &mut Vec<Problem>,
) -> Option<Value> {
    match key.absent {
        Absent::Required => {
            problems.push(Problem {
                field: field.to_owned(),
                value: "absent".to_owned(),
                problem: "is required".to_owned(),
                remedy: format!("give the {}: {}{}", key.meaning, key.domain.describe(), unit(key)),
            });
            None
        }
        Absent::Default(text) => {
            let value: Value = serde_json::from_str(text).expect("a default is JSON");
            check_value(field, key, &value, problems)
        }
        // Missing when that key itself has a problem, which is already reported.
        Absent::SameAs(other) => before.get(other).cloned(),
    }
}

/// Checks one value against its key; `None` when there is a problem, which is appended.
pub(crate) fn check_value(
    field: &str,
    key: &Key,
    value: &Value,
    problems: &mut Vec<Problem>,
) -> Option<Value> {
    check_domain(field, key, &key.domain, value, problems)
}

fn unit(key: &Key) -> String {
    match key.unit {
        "-" => String::new(),
        unit => format!(" [{unit}]"),
    }
}

fn check_domain(
    field: &str,
    key: &Key,
    domain: &Domain,
    value: &Value,
    problems: &mut Vec<Problem>,
) -> Option<Value> {
    match domain {
        Domain::Auto(_) if value.is_null() || value == "auto" => return Some(Value::Null),
        Domain::Auto(inner) => return check_domain(field, key, inner, value, problems),
        Domain::Record(keys) => {
            if let Value::Object(object) = value {
                return whole(problems, |found| check_object(field, keys, &[], object, found));
            }
        }
        Domain::Tagged { tag, variants } => {
            if let Some(object) = tagged_object(tag, value) {
                return check_tagged(field, tag, variants, &object, problems);
            }
        }
        Domain::List { of, min, max } => {
            if let Value::Array(elements) = value {
                return check_list(field, key, of, (*min, *max), elements, problems);
            }
        }
        _ => {}
    }
    match check_scalar(domain, value) {
        Ok(settled) => Some(settled),
        Err(problem) => {
            let quoted = match (domain.is_numeric(), value) {
                (true, Value::String(text)) if text.parse::<f64>().is_ok_and(f64::is_finite) => {
                    ", without quotes"
                }
                _ => "",
            };
            let remedy = format!("give {}{}{quoted}", key.domain.describe(), unit(key));
            problems.push(Problem::new(field.to_owned(), value, problem, remedy));
            None
        }
    }
}

/// The object form of a tagged value: as it is, or made from the bare word.
fn tagged_object(tag: &str, value: &Value) -> Option<Map<String, Value>> {
    match value {
        Value::Object(object) => Some(object.clone()),
        Value::String(word) => Some(Map::from_iter([(tag.to_owned(), Value::from(word.as_str()))])),
        _ => None,
    }
}

fn check_tagged(
    field: &str,
    tag: &str,
    variants: &[super::Variant],
    object: &Map<String, Value>,
    problems: &mut Vec<Problem>,
) -> Option<Value> {
    let names: Vec<&str> = variants.iter().map(|variant| variant.name).collect();
    let at = join(field, tag);
    let Some(chosen) = object.get(tag) else {
        problems.push(Problem {
            field: at,
            value: "absent".to_owned(),
            problem: "is required".to_owned(),
            remedy: format!("give one of {}", names.join(", ")),
        });
        return None;
    };
    let Some(variant) = variants.iter().find(|variant| chosen == variant.name) else {
        let name = chosen.as_str().map_or_else(|| chosen.to_string(), str::to_owned);
        problems.push(unknown_name(at, chosen, "choice", &name, &names));
        return None;
    };
    let settled = whole(problems, |found| check_object(field, variant.keys, &[tag], object, found))?;
    let Value::Object(mut settled) = settled else { unreachable!("whole gives an object") };
    settled.insert(tag.to_owned(), Value::from(variant.name));
    Some(Value::Object(settled))
}

fn check_list(
    field: &str,
    key: &Key,
    of: &Domain,
    (min, max): (usize, usize),
    elements: &[Value],
    problems: &mut Vec<Problem>,
) -> Option<Value> {
    if elements.len() < min || elements.len() > max {
        let problem = format!("has {} elements", elements.len());
        let remedy = format!("give {min} to {max} elements");
        problems.push(Problem::new(field.to_owned(), &Value::from(elements), problem, remedy));
        return None;
    }
    let settled: Vec<Option<Value>> = elements
        .iter()
        .enumerate()
        .map(|(index, element)| check_domain(&format!("{field}[{index}]"), key, of, element, problems))
        .collect();
    settled.into_iter().collect::<Option<Vec<_>>>().map(Value::Array)
}

/// Runs a check of an object; the object counts only when nothing was wrong in it.
fn whole(
    problems: &mut Vec<Problem>,
    check: impl FnOnce(&mut Vec<Problem>) -> Map<String, Value>,
) -> Option<Value> {
    let before = problems.len();
    let settled = check(problems);
    (problems.len() == before).then_some(Value::Object(settled))
}

/// The settled scalar, or what is wrong with it.
fn check_scalar(domain: &Domain, value: &Value) -> Result<Value, String> {
    match domain {
        Domain::Real(low, high) => {
            let number = real(value)?;
            if low.admits_from_below(number) && high.admits_from_above(number) {
                // −0 and 0 are one value.
                Ok(Value::from(number + 0.0))
            } else {
                Err("is out of its domain".to_owned())
            }
        }
        Domain::Integer(low, high) => {
            let number = integer(value)?;
            let high = (*high).min(LARGEST_INTEGER);
            if (*low..=high).contains(&number) {
                Ok(Value::from(number))
            } else {
                Err("is out of its domain".to_owned())
            }
        }
        Domain::OneOf(numbers) => {
            let number = integer(value)?;
            if numbers.contains(&number) {
                Ok(Value::from(number))
            } else {
                Err("is out of its domain".to_owned())
            }
        }
        Domain::Bool => match value {
            Value::Bool(flag) => Ok(Value::from(*flag)),
            other => Err(format!("is {}, not true or false", kind(other))),
        },
        Domain::Word(words) => match value {
            Value::String(word) => match words.iter().find(|known| known.name == word) {
                Some(known) => Ok(Value::from(known.name)),
                None => {
                    let names: Vec<&str> = words.iter().map(|known| known.name).collect();
                    Err(match nearest(word, &names) {
                        Some(near) => format!("is an unknown word, did you mean {near:?}?"),
                        None => "is an unknown word".to_owned(),
                    })
                }
            },
            other => Err(format!("is {}, not a word", kind(other))),
        },
        Domain::Auto(inner) => check_scalar(inner, value),
        Domain::Record(_) => Err(format!("is {}, not an object", kind(value))),
        Domain::Tagged { .. } => Err(format!("is {}, not an object or a word", kind(value))),
        Domain::List { .. } => Err(format!("is {}, not a list", kind(value))),
    }
}

fn real(value: &Value) -> Result<f64, String> {
    match value {
        Value::Number(number) => match number.as_f64() {
            Some(finite) if finite.is_finite() => Ok(finite),
            _ => Err("is not a finite number".to_owned()),
        },
        Value::String(text) if text.parse::<f64>().is_ok_and(|number| !number.is_finite()) => {
            Err("is not a finite number".to_owned())
        }
        other => Err(format!("is {}, not a number", kind(other))),
    }
}

fn integer(value: &Value) -> Result<u64, String> {
    if let Some(number) = value.as_u64() {
        return Ok(number);
    }
    let number = real(value)?;
    #[expect(clippy::cast_precision_loss, reason = "2^53 - 1 is exact")]
    let largest = LARGEST_INTEGER as f64;
    if number.fract() != 0.0 {
        Err("is not a whole number".to_owned())
    } else if (0.0..=largest).contains(&number) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "just checked")]
        Ok(number as u64)
    } else {
        Err("is out of its domain".to_owned())
    }
}

/// The kind of a JSON value, in words.
fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}
