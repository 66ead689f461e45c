//! RFC 9457 problem documents.

use serde::{Deserialize, Serialize};

/// An error as the API tells it (`application/problem+json`).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ProblemDocument {
    /// Stable identifier, for example `urn:tamp:invalid-sweep`.
    #[serde(rename = "type")]
    pub kind: String,
    /// Short, the same for every occurrence of the type.
    pub title: String,
    /// HTTP status code.
    pub status: u16,
    /// What happened this time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
    /// Every field that is wrong.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<FieldProblem>,
    /// Whether the same request may succeed later.
    #[serde(default)]
    pub retryable: bool,
}

/// One field that is wrong.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct FieldProblem {
    /// Path of the field.
    pub field: String,
    /// The offending value as JSON text.
    pub value: String,
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

impl From<scene::Problem> for FieldProblem {
    fn from(one: scene::Problem) -> Self {
        Self { field: one.field, value: one.value, problem: one.problem, remedy: one.remedy }
    }
}
