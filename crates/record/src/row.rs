//! A flat record: named cells.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::{Cell, Finite, NotFinite};

/// One flat record: column name to value, in the order of the names. A column that does not apply is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Row(BTreeMap<String, Cell>);

impl Row {
    /// An empty record.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts a real number.
    ///
    /// # Errors
    /// [`NotFinite`] when `value` is NaN or infinite; the row is unchanged.
    pub fn number(&mut self, name: &str, value: f64) -> Result<&mut Self, NotFinite> {
        let finite = Finite::new(value)?;
        self.0.insert(name.to_owned(), Cell::Number(finite));
        Ok(self)
    }

    /// Puts a count, a flag or a word.
    pub fn put(&mut self, name: &str, cell: impl Into<Cell>) -> &mut Self {
        self.0.insert(name.to_owned(), cell.into());
        self
    }

    /// The cell of a column.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Cell> {
        self.0.get(name)
    }

    /// The cell of a column as a real number.
    #[must_use]
    pub fn real(&self, name: &str) -> Option<f64> {
        self.get(name).and_then(Cell::number)
    }

    /// The cell of a column as a word.
    #[must_use]
    pub fn text(&self, name: &str) -> Option<&str> {
        self.get(name).and_then(Cell::text)
    }

    /// All cells in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Cell)> {
        self.0.iter().map(|(name, cell)| (name.as_str(), cell))
    }

    /// Adds every cell of `other`; a name present in both takes the value of `other`.
    pub fn extend(&mut self, other: Row) {
        self.0.extend(other.0);
    }

    /// Whether there is no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn survives_json() {
        let mut row = Row::new();
        row.number("e", 0.957)
            .unwrap()
            .put("steps", 14_300)
            .put("status", "equilibrium")
            .put("rescued", false);
        let text = serde_json::to_string(&row).unwrap();
        assert_eq!(serde_json::from_str::<Row>(&text).unwrap(), row);
        assert_eq!(row.real("steps"), Some(14_300.0));
    }

    #[test]
    fn a_nan_leaves_the_row_unchanged() {
        let mut row = Row::new();
        assert!(row.number("e", f64::NAN).is_err());
        assert!(row.is_empty());
    }
}
