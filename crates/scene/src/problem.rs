//! What is wrong with an input, and what to do about it.

use serde::{Deserialize, Serialize};
use serde_json::Value;

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

impl Problem {
    /// A problem of the value at `field`.
    #[must_use]
    pub fn new(
        field: impl Into<String>,
        value: &Value,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            field: field.into(),
            value: shorten(&value.to_string()),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }
}

/// All problems of an input document; never empty.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{}", self.summary())]
#[serde(transparent)]
pub struct Problems(pub Vec<Problem>);

impl Problems {
    /// More problems than this are counted, not listed.
    pub const LISTED: usize = 100;

    /// Nothing when there is no problem.
    ///
    /// # Errors
    /// [`Problems`] with the first [`Self::LISTED`] problems and, when there are more, one that says how many.
    pub fn none_or(mut problems: Vec<Problem>) -> Result<(), Self> {
        if problems.is_empty() {
            return Ok(());
        }
        let more = problems.len().saturating_sub(Self::LISTED);
        if more > 0 {
            problems.truncate(Self::LISTED);
            problems.push(Problem {
                field: String::new(),
                value: String::new(),
                problem: format!("{more} more problems of the same input are not listed"),
                remedy: "fix these first".to_owned(),
            });
        }
        Err(Self(problems))
    }

    fn summary(&self) -> String {
        let lines: Vec<String> = self
            .0
            .iter()
            .map(|one| format!("{} = {}: {} ({})", one.field, one.value, one.problem, one.remedy))
            .collect();
        lines.join("; ")
    }
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Self(vec![problem])
    }
}

/// The known name that looks most like `name`, if any looks alike.
pub(crate) fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    /// Below this Jaro–Winkler similarity a suggestion only confuses.
    const ALIKE: f64 = 0.75;
    let folded = name.to_lowercase().replace('-', "_");
    known
        .iter()
        .map(|&candidate| (strsim::jaro_winkler(&folded, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= ALIKE)
        .max_by(|left, right| left.0.total_cmp(&right.0))
        .map(|(_, candidate)| candidate)
}

fn shorten(text: &str) -> String {
    /// Longest value shown [characters].
    const SHOWN: usize = 80;
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_what_was_meant() {
        let known = ["sigma_c", "sigma_e", "mu", "mu_wall", "alpha_n"];
        assert_eq!(nearest("sigmac", &known), Some("sigma_c"));
        assert_eq!(nearest("Sigma-E", &known), Some("sigma_e"));
        assert_eq!(nearest("alphan", &known), Some("alpha_n"));
        assert_eq!(nearest("temperature", &known), None);
    }

    #[test]
    fn long_values_are_shortened_between_characters() {
        let long = "é".repeat(200);
        let problem = Problem::new("x", &Value::from(long), "p", "r");
        assert_eq!(problem.value.chars().count(), 81);
    }

    #[test]
    fn a_flood_of_problems_is_counted() {
        let one = Problem::new("x", &Value::Null, "p", "r");
        let Err(Problems(listed)) = Problems::none_or(vec![one; 250]) else { panic!("there are problems") };
        assert_eq!(listed.len(), 101);
        assert!(listed[100].problem.starts_with("150 more"));
    }
}
