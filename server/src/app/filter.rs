//! Filters on rows: `p=1e5`, `sigma_c.min=1e6`, `status=equilibrium`.

use std::collections::BTreeSet;

use protocol::FieldProblem;
use record::{Cell, Row};

use crate::error::AppError;

/// Numbers written differently but meant to be equal differ by less than this, relatively.
const SAME: f64 = 1e-9;

/// One condition on a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter {
    /// The column.
    pub column: String,
    /// What it has to be.
    pub condition: Condition,
}

/// What a column has to be.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// This number.
    Equals(f64),
    /// This word or flag.
    Is(String),
    /// At least this number.
    AtLeast(f64),
    /// At most this number.
    AtMost(f64),
}

/// All conditions of a request; a row has to meet each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filters(pub Vec<Filter>);

impl Filters {
    /// Reads filters from the query parameters that are not reserved.
    ///
    /// # Errors
    /// [`AppError::Invalid`] with every bound that is no number.
    pub fn read<'a>(parameters: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Self, AppError> {
        let mut filters = Vec::new();
        let mut wrong = Vec::new();
        for (name, text) in parameters {
            let number = text.parse::<f64>().ok().filter(|value| value.is_finite());
            let bound = name
                .strip_suffix(".min")
                .map(|column| (column, Condition::AtLeast as fn(f64) -> Condition))
                .or_else(|| name.strip_suffix(".max").map(|column| (column, Condition::AtMost as _)));
            let (column, condition) = match (bound, number) {
                (Some((column, condition)), Some(value)) => (column, condition(value)),
                (Some(_), None) => {
                    wrong.push(FieldProblem {
                        field: name.to_owned(),
                        value: format!("{text:.80?}"),
                        problem: "is not a finite number".to_owned(),
                        remedy: "give a number, for example 1e5".to_owned(),
                    });
                    continue;
                }
                (None, Some(value)) => (name, Condition::Equals(value)),
                (None, None) => (name, Condition::Is(text.to_owned())),
            };
            filters.push(Filter { column: column.to_owned(), condition });
        }
        if wrong.is_empty() {
            Ok(Self(filters))
        } else {
            Err(AppError::Invalid { what: "query", fields: wrong })
        }
    }

    /// Whether the row meets every condition; a column it does not have meets none.
    #[must_use]
    pub fn keep(&self, row: &Row) -> bool {
        self.0.iter().all(|filter| row.get(&filter.column).is_some_and(|cell| filter.condition.met_by(cell)))
    }

    /// Columns asked for that are not among `known`.
    #[must_use]
    pub fn unknown(&self, known: &BTreeSet<String>) -> Vec<FieldProblem> {
        self.0
            .iter()
            .filter(|filter| !known.contains(&filter.column))
            .map(|filter| FieldProblem {
                field: filter.column.clone(),
                value: filter.condition.to_string(),
                problem: "is no column of these results".to_owned(),
                remedy:
                    "filter by a scene key, a derived quantity or a column of the record; a bound is written \
                         NAME.min or NAME.max"
                        .to_owned(),
            })
            .collect()
    }
}

/// As it stood in the query.
impl std::fmt::Display for Condition {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Is(word) => f.write_str(word),
            Self::Equals(number) | Self::AtLeast(number) | Self::AtMost(number) => write!(f, "{number}"),
        }
    }
}

impl Condition {
    fn met_by(&self, cell: &Cell) -> bool {
        match (self, cell) {
            (Self::Is(word), Cell::Text(text)) => word == text,
            (Self::Is(word), Cell::Flag(flag)) => word.parse() == Ok(*flag),
            (Self::Equals(wanted), Cell::Text(text)) => text.parse() == Ok(*wanted),
            (Self::Equals(wanted), cell) => {
                cell.number().is_some_and(|value| (value - wanted).abs() <= SAME * wanted.abs())
            }
            (Self::AtLeast(least), cell) => {
                cell.number().is_some_and(|value| value >= least - SAME * least.abs())
            }
            (Self::AtMost(most), cell) => {
                cell.number().is_some_and(|value| value <= most + SAME * most.abs())
            }
            (Self::Is(_), _) => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_words_flags_and_rounding() {
        let mut row = Row::new();
        row.number("p", 1e5 * (1.0 + 1e-12)).unwrap().put("status", "equilibrium").put("out_of_model", false);
        let keep = |query: &[(&str, &str)]| Filters::read(query.iter().copied()).unwrap().keep(&row);
        assert!(keep(&[("p", "1e5"), ("status", "equilibrium"), ("out_of_model", "false")]));
        assert!(keep(&[("p.min", "100000"), ("p.max", "100000")]));
        assert!(!keep(&[("p.max", "99999")]));
        assert!(!keep(&[("q", "1")]));
        assert!(Filters::read([("p.min", "much")]).is_err());
        assert!(Filters::read([("p.min", "NaN")]).is_err());
    }
}
