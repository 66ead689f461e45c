//! Precision of the arithmetic.

use serde::{Deserialize, Serialize};

use crate::table::{Absent, Domain, Key, Word};

/// What a discrete element run computes with. Positions are double always, and so is how far two particles are apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// All in double precision.
    #[default]
    Double,
    /// Velocities, forces and contact memories in single precision.
    Mixed,
}

impl Precision {
    /// Whether it is the default, which scene keys do not name: results from before there was a choice stay findable.
    #[must_use]
    pub fn is_double(&self) -> bool {
        *self == Self::Double
    }
}

/// The key of scenes.
pub(crate) const KEY: Key = Key {
    name: "precision",
    unit: "-",
    domain: Domain::Word(&[
        Word { name: "double", meaning: "all in double precision" },
        Word {
            name: "mixed",
            meaning: "velocities, forces and contact memories in single precision; positions and overlaps stay double",
        },
    ]),
    absent: Absent::Default("\"double\""),
    meaning: "precision of the arithmetic",
    source: "choice, see docs/accuracy.md",
};
