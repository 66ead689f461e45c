//! Named columns of equal length: time series, particles, contacts.

use serde::{Deserialize, Serialize};

use crate::{Finite, NotFinite};

/// One column of a [`Table`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Column {
    /// Name, as in the notation table.
    pub name: String,
    /// Unit, for example `"Pa"`, `"tau"`, `"d"`; `"1"` for pure numbers.
    pub unit: String,
    /// The values.
    pub values: Vec<Finite>,
}

/// Columns of equal length.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    columns: Vec<Column>,
}

/// Why a column cannot join a table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The column holds a NaN or an infinity.
    #[error("column {name}, row {row}: {source}")]
    NotFinite {
        /// Column.
        name: String,
        /// Row of the bad value, from 0.
        row: usize,
        /// The bad value.
        source: NotFinite,
    },
    /// The column is longer or shorter than those before it.
    #[error("column {name} has {found} rows, the table has {expected}")]
    Length {
        /// Column.
        name: String,
        /// Rows of the table.
        expected: usize,
        /// Rows of the column.
        found: usize,
    },
}

impl Table {
    /// A table without columns.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends a column.
    ///
    /// # Errors
    /// [`TableError`] when a value is not finite or the length differs from the columns before it.
    pub fn push(&mut self, name: &str, unit: &str, values: &[f64]) -> Result<&mut Self, TableError> {
        if let Some(first) = self.columns.first()
            && first.values.len() != values.len()
        {
            return Err(TableError::Length {
                name: name.to_owned(),
                expected: first.values.len(),
                found: values.len(),
            });
        }
        let finite = values
            .iter()
            .enumerate()
            .map(|(row, &value)| {
                Finite::new(value).map_err(|source| TableError::NotFinite {
                    name: name.to_owned(),
                    row,
                    source,
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        self.columns.push(Column { name: name.to_owned(), unit: unit.to_owned(), values: finite });
        Ok(self)
    }

    /// The columns in the order they were added.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The values of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        Some(column.values.iter().map(|value| value.get()).collect())
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_unequal_lengths_and_nan() {
        let mut table = Table::new();
        table.push("t", "tau", &[0.0, 1.0]).unwrap();
        assert!(matches!(table.push("e", "1", &[1.0]), Err(TableError::Length { .. })));
        assert!(matches!(table.push("e", "1", &[1.0, f64::NAN]), Err(TableError::NotFinite { row: 1, .. })));
        assert_eq!(table.columns().len(), 1);
    }
}
