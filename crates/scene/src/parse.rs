//! Strict JSON text: a name that occurs twice in one object and a number beyond the range of doubles are problems
//! with a field path, not silently the last one or a bare parser message.

use std::cell::RefCell;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

use crate::{Problem, Problems};

/// Parses JSON text.
///
/// # Errors
/// [`Problems`] with the path of the field at which the text stops being JSON, or of the name that occurs twice.
pub fn parse_json(text: &[u8]) -> Result<Value, Problems> {
    let path = RefCell::new(Vec::new());
    let mut reader = serde_json::Deserializer::from_slice(text);
    let parsed = Strict { path: &path }.deserialize(&mut reader).and_then(|value| {
        reader.end()?;
        Ok(value)
    });
    parsed.map_err(|error| {
        let problem = error.to_string();
        let remedy = if problem.starts_with("number out of range") {
            "give a finite number: at most 1.7976931348623157e308 in size"
        } else if problem.starts_with("the name") {
            "give each name once"
        } else {
            "give JSON text (RFC 8259); NaN, comments and trailing commas do not belong to it"
        };
        Problems::from(Problem {
            field: render(&path.borrow()),
            value: String::new(),
            problem,
            remedy: remedy.to_owned(),
        })
    })
}

enum Step {
    Name(String),
    Index(usize),
}

fn render(path: &[Step]) -> String {
    let mut text = String::new();
    for step in path {
        match step {
            Step::Name(name) if text.is_empty() => text.push_str(name),
            Step::Name(name) => {
                text.push('.');
                text.push_str(name);
            }
            Step::Index(index) => text.push_str(&format!("[{index}]")),
        }
    }
    text
}

/// Builds a [`Value`]; on an error `path` is left at the place where it happened.
#[derive(Clone, Copy)]
struct Strict<'a> {
    path: &'a RefCell<Vec<Step>>,
}

impl<'de> DeserializeSeed<'de> for Strict<'_> {
    type Value = Value;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Strict<'_> {
    type Value = Value;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("a JSON value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Value, A::Error> {
        let mut elements = Vec::new();
        loop {
            self.path.borrow_mut().push(Step::Index(elements.len()));
            let Some(element) = access.next_element_seed(self)? else { break };
            self.path.borrow_mut().pop();
            elements.push(element);
        }
        self.path.borrow_mut().pop();
        Ok(Value::Array(elements))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(name) = access.next_key::<String>()? {
            self.path.borrow_mut().push(Step::Name(name.clone()));
            if object.contains_key(&name) {
                return Err(A::Error::custom(format!("the name {name:?} occurs twice")));
            }
            let value = access.next_value_seed(self)?;
            self.path.borrow_mut().pop();
            object.insert(name, value);
        }
        Ok(Value::Object(object))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem_of(text: &str) -> Problem {
        parse_json(text.as_bytes()).unwrap_err().0.remove(0)
    }

    #[test]
    fn agrees_with_the_plain_parser() {
        let text =
            r#"{"a": [1, 2.5, -3, {"b": null}], "c": "x\n", "d": true, "e": 18446744073709551615, "f": 0.1}"#;
        assert_eq!(parse_json(text.as_bytes()).unwrap(), serde_json::from_str::<Value>(text).unwrap());
    }

    #[test]
    fn names_the_field_of_a_repeated_name() {
        let problem = problem_of(r#"{"blocks": [{"grid": {"p": [1], "p": [2]}}]}"#);
        assert_eq!(problem.field, "blocks[0].grid.p");
        assert!(problem.problem.contains("occurs twice"), "{problem:?}");
    }

    #[test]
    fn names_the_field_of_a_number_out_of_range() {
        let problem = problem_of(r#"{"base": {"p": 1e999}}"#);
        assert_eq!(problem.field, "base.p");
        assert!(problem.remedy.contains("finite"), "{problem:?}");
    }

    #[test]
    fn nan_trailing_text_and_depth_are_problems() {
        assert!(problem_of(r#"{"p": NaN}"#).field == "p");
        assert!(!problem_of("{} {}").problem.is_empty());
        assert!(!problem_of(&"[".repeat(100_000)).problem.is_empty());
    }
}
