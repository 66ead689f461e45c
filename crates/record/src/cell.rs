//! One value of a record.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use crate::{Finite, NotFinite};

/// A value of a [`Row`](crate::Row): a finite number, an integer, a flag or a word. Plain JSON on the wire.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A finite real number.
    Number(Finite),
    /// A whole number (counts, steps, seeds).
    Integer(i64),
    /// Yes or no.
    Flag(bool),
    /// A word: a status, a kernel name.
    Text(String),
}

impl Cell {
    /// The value as a real number; flags and words have none.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(value.get()),
            #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
            Self::Integer(value) => Some(*value as f64),
            Self::Flag(_) | Self::Text(_) => None,
        }
    }

    /// The value as a word, if it is one.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(word) => Some(word),
            _ => None,
        }
    }

    /// The value as JSON.
    #[must_use]
    pub fn to_json(&self) -> Value {
        match self {
            Self::Number(value) => Value::from(value.get()),
            Self::Integer(value) => Value::from(*value),
            Self::Flag(value) => Value::from(*value),
            Self::Text(word) => Value::from(word.as_str()),
        }
    }

    /// Reads a JSON scalar; arrays, objects and null have no cell.
    #[must_use]
    pub fn from_json(value: &Value) -> Option<Self> {
        match value {
            Value::Bool(flag) => Some(Self::Flag(*flag)),
            Value::String(word) => Some(Self::Text(word.clone())),
            Value::Number(number) => match number.as_i64() {
                Some(whole) => Some(Self::Integer(whole)),
                None => number.as_f64().and_then(|real| Finite::new(real).ok()).map(Self::Number),
            },
            Value::Null | Value::Array(_) | Value::Object(_) => None,
        }
    }
}

impl TryFrom<f64> for Cell {
    type Error = NotFinite;
    fn try_from(value: f64) -> Result<Self, NotFinite> {
        Finite::new(value).map(Self::Number)
    }
}

impl From<i64> for Cell {
    fn from(value: i64) -> Self {
        Self::Integer(value)
    }
}

impl From<bool> for Cell {
    fn from(value: bool) -> Self {
        Self::Flag(value)
    }
}

impl From<&str> for Cell {
    fn from(word: &str) -> Self {
        Self::Text(word.to_owned())
    }
}

impl From<String> for Cell {
    fn from(word: String) -> Self {
        Self::Text(word)
    }
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_json().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Cell {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        Self::from_json(&value).ok_or_else(|| {
            serde::de::Error::custom(format!("expected a number, a flag or a word, found {value}"))
        })
    }
}
