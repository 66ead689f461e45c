//! One axis of a sweep: a key and the values it takes.

use serde_json::{Value, json};

use crate::round12;

/// A key and the values it takes; ranges are computed value by value and never stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name of the key.
    pub key: String,
    /// Whether the key is a whole number.
    pub(super) whole: bool,
    pub(super) values: Values,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    /// `[a, b, …]` or `{"values": [a, b, …]}`.
    Listed(Vec<Value>),
    /// `{"lin": [first, last, count]}`.
    Linear { first: f64, last: f64, count: u64 },
    /// `{"log": [first, last, count]}`.
    Logarithmic { first: f64, last: f64, count: u64 },
}

impl Axis {
    /// Number of values.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "an axis is never empty")]
    pub fn len(&self) -> u64 {
        match &self.values {
            Values::Listed(values) => values.len() as u64,
            Values::Linear { count, .. } | Values::Logarithmic { count, .. } => *count,
        }
    }

    /// The value at `index`, counted from 0.
    ///
    /// Ranges start and end exactly at their ends; values between are rounded to 12 significant digits, so that one
    /// value reached through different ranges is one scene.
    #[must_use]
    pub fn value(&self, index: u64) -> Value {
        match &self.values {
            Values::Listed(values) => {
                let place = usize::try_from(index).expect("a list fits in memory");
                values[place].clone()
            }
            Values::Linear { first, last, count } => {
                self.number(between(*first, *last, index, *count, |share| {
                    first * (1.0 - share) + last * share
                }))
            }
            Values::Logarithmic { first, last, count } => {
                self.number(between(*first, *last, index, *count, |share| {
                    // By libm: the same bits, and so the same scene keys, on every machine.
                    libm::exp(libm::log(*first) * (1.0 - share) + libm::log(*last) * share)
                }))
            }
        }
    }

    /// A number of a range; whole where the key is. A number that is not stays as it is and is a problem of the
    /// definition.
    fn number(&self, value: f64) -> Value {
        if self.whole && value.fract() == 0.0 && (0.0..9e15).contains(&value) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "just checked")]
            return Value::from(value as u64);
        }
        Value::from(value)
    }

    /// The values as a definition writes them.
    pub(super) fn to_json(&self) -> Value {
        match &self.values {
            Values::Listed(values) => Value::from(values.as_slice()),
            Values::Linear { first, last, count } => json!({ "lin": [first, last, count] }),
            Values::Logarithmic { first, last, count } => json!({ "log": [first, last, count] }),
        }
    }
}

fn between(first: f64, last: f64, index: u64, count: u64, inside: impl Fn(f64) -> f64) -> f64 {
    if index == 0 {
        first
    } else if index + 1 == count {
        last
    } else {
        #[expect(clippy::cast_precision_loss, reason = "counts stay below the largest number of points")]
        let share = index as f64 / (count - 1) as f64;
        round12(inside(share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(first: f64, last: f64, count: u64) -> Axis {
        Axis { key: "p".to_owned(), whole: false, values: Values::Logarithmic { first, last, count } }
    }

    fn numbers(axis: &Axis) -> Vec<f64> {
        (0..axis.len()).map(|index| axis.value(index).as_f64().unwrap()).collect()
    }

    #[test]
    fn log_ranges_have_exact_ends_and_round_middles() {
        assert_eq!(numbers(&log(1e3, 1e7, 5)), [1e3, 1e4, 1e5, 1e6, 1e7]);
        // The middle of the paper's range of elastic stress is the value of its Fig. 4.
        assert_eq!(numbers(&log(5e8, 2e11, 5))[2], 1e10);
        let third = 1.0 / 3.0;
        assert_eq!(numbers(&log(third, 2.0 * third, 2)), [third, 2.0 * third]);
    }

    #[test]
    fn one_value_reached_through_different_ranges_is_one_value() {
        let coarse = numbers(&log(1e-3, 1e3, 7));
        let fine = numbers(&log(1e-3, 1e3, 601));
        for (index, value) in coarse.iter().enumerate() {
            assert_eq!(value.to_bits(), fine[index * 100].to_bits());
        }
        let downwards = numbers(&log(1e3, 1e-3, 601));
        assert!(downwards.iter().rev().zip(&fine).all(|(left, right)| left.to_bits() == right.to_bits()));
    }

    #[test]
    fn linear_ranges_hit_round_numbers() {
        let axis = Axis {
            key: "x".to_owned(),
            whole: false,
            values: Values::Linear { first: 0.0, last: 1.0, count: 11 },
        };
        assert_eq!(numbers(&axis), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
    }
}
