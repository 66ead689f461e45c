//! Why an analysis has no answer.

use serde::{Deserialize, Serialize};

/// Why a quantity cannot be determined from the runs at hand. Never a number in disguise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, thiserror::Error)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum FitError {
    /// Fewer data than the question needs.
    #[error("{what} needs at least {needed} {of}, found {found}")]
    TooFew {
        /// What was asked.
        what: String,
        /// What there is too little of (points, pressures, contacts, …).
        of: String,
        /// Smallest number that would do.
        needed: usize,
        /// Number at hand.
        found: usize,
    },
    /// The data do not fix every parameter.
    #[error("{what} is not determined by the data: {reason}")]
    Underdetermined {
        /// What was asked.
        what: String,
        /// Which direction is free, and what would fix it.
        reason: String,
    },
    /// The least-squares iteration did not converge.
    #[error("{what} did not converge: {reason}")]
    NotConverged {
        /// What was asked.
        what: String,
        /// How the iteration ended.
        reason: String,
    },
    /// The question lies outside the range of the formula or of the data.
    #[error("{what} is outside its range: {reason}")]
    OutOfRange {
        /// What was asked.
        what: String,
        /// Value and range.
        reason: String,
    },
}

impl FitError {
    pub(crate) fn too_few(what: &str, of: &str, needed: usize, found: usize) -> Self {
        Self::TooFew { what: what.to_owned(), of: of.to_owned(), needed, found }
    }
    pub(crate) fn underdetermined(what: &str, reason: impl Into<String>) -> Self {
        Self::Underdetermined { what: what.to_owned(), reason: reason.into() }
    }
    pub(crate) fn not_converged(what: &str, reason: impl Into<String>) -> Self {
        Self::NotConverged { what: what.to_owned(), reason: reason.into() }
    }
    pub(crate) fn out_of_range(what: &str, reason: impl Into<String>) -> Self {
        Self::OutOfRange { what: what.to_owned(), reason: reason.into() }
    }
}

/// A part of an answer that may not be determined while the rest is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Determined<T> {
    /// The value.
    Value(T),
    /// There is none, and why.
    Undetermined {
        /// The cause, by kind.
        cause: FitError,
        /// The cause as a sentence.
        message: String,
    },
}

impl<T> Determined<T> {
    /// The value, if there is one.
    pub fn value(&self) -> Option<&T> {
        match self {
            Self::Value(value) => Some(value),
            Self::Undetermined { .. } => None,
        }
    }

    /// The reason, if there is no value.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Value(_) => None,
            Self::Undetermined { message, .. } => Some(message),
        }
    }
}

impl<T> From<Result<T, FitError>> for Determined<T> {
    fn from(result: Result<T, FitError>) -> Self {
        match result {
            Ok(value) => Self::Value(value),
            Err(cause) => Self::Undetermined { message: cause.to_string(), cause },
        }
    }
}
