//! Scenes and sweeps from files, standard input and the command line.

use std::io::Read as _;

use scene::{Problems, Scene, Sweep, parse_json};
use serde_json::{Map, Value};

use crate::failure::Failure;

/// Largest input that is read [bytes].
const LARGEST: u64 = 64 << 20;

/// Reads JSON from a file, or from standard input when `path` is `-`.
pub fn read(path: &str) -> Result<Value, Failure> {
    let mut bytes = Vec::new();
    let read = if path == "-" {
        std::io::stdin().lock().take(LARGEST + 1).read_to_end(&mut bytes)
    } else {
        std::fs::File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes))
    };
    if let Err(error) = read {
        return Err(Failure::input("file", path, error.to_string(), "name a file that can be read, or -"));
    }
    if bytes.len() as u64 > LARGEST {
        return Err(Failure::input("file", path, "is larger than 64 MiB", "split the sweep"));
    }
    Ok(parse_json(&bytes)?)
}

/// Reads a scene, with `KEY=VALUE` overrides.
pub fn scene(path: &str, overrides: &[String]) -> Result<Scene, Failure> {
    let mut value = read(path)?;
    let overrides = overrides_of(overrides)?;
    if let Value::Object(keys) = &mut value {
        keys.extend(overrides);
    }
    Ok(Scene::from_json(&value)?)
}

/// A scene or a sweep, by what it holds: a sweep has blocks.
pub enum Definition {
    /// One run.
    Scene(Box<Scene>),
    /// Many runs.
    Sweep(Box<Sweep>),
}

/// Reads a scene or a sweep; overrides go to the scene, or to the base of the sweep.
pub fn definition(path: &str, overrides: &[String]) -> Result<Definition, Failure> {
    let mut value = read(path)?;
    let overrides = overrides_of(overrides)?;
    let is_sweep = ["blocks", "base"].iter().any(|key| value.get(key).is_some());
    if is_sweep {
        apply_to_base(&mut value, overrides);
        Ok(Definition::Sweep(Box::new(Sweep::from_json(&value)?)))
    } else {
        if let Value::Object(keys) = &mut value {
            keys.extend(overrides);
        }
        Ok(Definition::Scene(Box::new(Scene::from_json(&value)?)))
    }
}

/// Puts keys into the base of a sweep.
pub fn apply_to_base(sweep: &mut Value, overrides: Map<String, Value>) {
    if overrides.is_empty() {
        return;
    }
    if let Value::Object(keys) = sweep
        && let Value::Object(base) = keys.entry("base").or_insert_with(|| Value::Object(Map::new()))
    {
        base.extend(overrides);
    }
}

/// `KEY=VALUE` pairs; a value that is not JSON is a word.
pub fn overrides_of(pairs: &[String]) -> Result<Map<String, Value>, Problems> {
    let mut found = Map::new();
    let mut problems = Vec::new();
    for pair in pairs {
        match pair.split_once('=') {
            Some((key, value)) if !key.is_empty() => {
                let value = serde_json::from_str(value).unwrap_or_else(|_| Value::from(value));
                found.insert(key.to_owned(), value);
            }
            _ => problems.push(scene::Problem::new(
                "override",
                &Value::from(pair.as_str()),
                "is not a pair",
                "write KEY=VALUE, for example n=500",
            )),
        }
    }
    Problems::none_or(problems)?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_json_or_words() {
        let pairs = ["n=500", "sigma_c=3e6", "stop=settled", "name=\"a=b\""].map(str::to_owned);
        let found = overrides_of(&pairs).unwrap();
        assert_eq!(found["n"], 500);
        assert_eq!(found["sigma_c"], 3e6);
        assert_eq!(found["stop"], "settled");
        assert_eq!(found["name"], "a=b");
        assert_eq!(overrides_of(&["n".to_owned(), "=1".to_owned()]).unwrap_err().0.len(), 2);
    }
}
