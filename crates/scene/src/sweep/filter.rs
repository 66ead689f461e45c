//! `where`: which points stay.

use serde::Serialize;

use crate::Scene;

/// An interval a quantity has to lie in for a point to stay.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Filter {
    /// A numeric key or a derived quantity of the model.
    pub quantity: String,
    /// Least value that stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Largest value that stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

impl Filter {
    /// Whether the point stays. A value within one part in 10¹¹ of an end counts as that end: a quantity is the
    /// result of floating-point operations on keys.
    #[must_use]
    pub fn keeps(&self, scene: &Scene) -> bool {
        const ROUNDING: f64 = 1e-11;
        let Some(value) = scene.quantity(&self.quantity) else { return false };
        let slack = ROUNDING * value.abs();
        self.min.is_none_or(|min| value + slack >= min) && self.max.is_none_or(|max| value - slack <= max)
    }

    /// Why a point is left out.
    #[must_use]
    pub fn reason(&self) -> String {
        match (self.min, self.max) {
            (Some(min), Some(max)) => format!("{} outside of [{min}, {max}]", self.quantity),
            (Some(min), None) => format!("{} below {min}", self.quantity),
            (None, Some(max)) => format!("{} above {max}", self.quantity),
            (None, None) => format!("{} unbounded", self.quantity),
        }
    }
}
