//! What can go wrong, by what the caller can do about it; becomes HTTP only in `api::problem`.

use protocol::FieldProblem;

use crate::blob::BlobError;
use crate::store::StoreError;

/// An error of a use case.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// Fields of the request are wrong: fix them.
    #[error("{what}: {}", summary(.fields))]
    Invalid {
        /// Which kind of document: `sweep`, `request`, `query`, `result`.
        what: &'static str,
        /// Every field that is wrong.
        fields: Vec<FieldProblem>,
    },
    /// The body does not parse as JSON.
    #[error("malformed JSON: {}", summary(.0))]
    Malformed(Vec<FieldProblem>),
    /// The body is larger than admitted.
    #[error("the body is larger than {limit} bytes")]
    TooLarge {
        /// Largest body admitted [bytes].
        limit: u64,
    },
    /// The body is of another media type.
    #[error("the body is {found}; send {expected}")]
    MediaType {
        /// What came.
        found: String,
        /// What is taken.
        expected: &'static str,
    },
    /// No such format.
    #[error("there is no answer as {asked}; ask for {offered}")]
    NotAcceptable {
        /// What was asked.
        asked: String,
        /// What there is.
        offered: &'static str,
    },
    /// There is no such thing.
    #[error("there is no {what} {id}")]
    NotFound {
        /// What.
        what: &'static str,
        /// Which one.
        id: String,
    },
    /// The state of things does not admit the request.
    #[error("{0}")]
    Conflict(String),
    /// The writer does not hold the lease: drop the job.
    #[error("{0}")]
    StaleLease(String),
    /// The run has not got there yet: ask later.
    #[error("{0}")]
    NotYet(String),
    /// The idempotency key was used for another request.
    #[error("the idempotency key was used for another request; draw a new one")]
    KeyReused,
    /// The worker speaks another protocol.
    #[error("protocol {found} is not spoken here; use a worker of protocol {accepted}")]
    Protocol {
        /// What the worker speaks.
        found: u32,
        /// What the coordinator speaks.
        accepted: u32,
    },
    /// The analysis cannot be made from these data.
    #[error("{0}")]
    Analysis(String),
    /// The service is stopping or overloaded: ask again.
    #[error("{0}")]
    Unavailable(String),
    /// The database failed.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A file failed.
    #[error(transparent)]
    Blob(#[from] BlobError),
    /// A bug.
    #[error("internal error: {0}")]
    Bug(String),
}

/// Result of a use case.
pub type AppResult<T> = Result<T, AppError>;

impl AppError {
    /// One wrong field.
    #[must_use]
    pub fn field(
        what: &'static str,
        field: &str,
        value: impl std::fmt::Display,
        problem: &str,
        remedy: &str,
    ) -> Self {
        Self::Invalid {
            what,
            fields: vec![FieldProblem {
                field: field.to_owned(),
                value: value.to_string(),
                problem: problem.to_owned(),
                remedy: remedy.to_owned(),
            }],
        }
    }
}

fn summary(fields: &[FieldProblem]) -> String {
    let lines: Vec<String> =
        fields.iter().map(|one| format!("{} = {}: {}", one.field, one.value, one.problem)).collect();
    lines.join("; ")
}

/// Runs blocking work off the async threads.
pub(crate) async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> AppResult<T> + Send + 'static,
) -> AppResult<T> {
    match tokio::task::spawn_blocking(work).await {
        Ok(result) => result,
        Err(error) => Err(AppError::Bug(format!("a background computation panicked: {error}"))),
    }
}
