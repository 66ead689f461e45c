//! What is wrong with an input, and what to do about it.

use serde::{Deserialize, Serialize};

/// One problem of an input document.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// Path of the field, for example `blocks[0].grid.sigma_c.log`.
    pub field: String,
    /// The offending value, as JSON text (shortened when long).
    pub value: String,
    /// What is wrong.
    pub problem: String,
    /// What the user can do.
    pub remedy: String,
}

/// All problems of an input document; never empty.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{}", self.summary())]
#[serde(transparent)]
pub struct Problems(pub Vec<Problem>);

impl Problems {
    fn summary(&self) -> String {
        let lines: Vec<String> = self
            .0
            .iter()
            .map(|one| format!("{} = {}: {} ({})", one.field, one.value, one.problem, one.remedy))
            .collect();
        lines.join("; ")
    }
}
