//! The life of a job, as a pure transition table shared by coordinator and tests.

use serde::{Deserialize, Serialize};

/// State of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub enum JobState {
    /// Waits for a worker.
    Queued,
    /// A worker holds the lease.
    Leased,
    /// The result is stored.
    Done,
    /// Set aside: the failure or loss budget is used up; evidence is kept.
    Failed,
    /// Nobody wants it any more.
    Cancelled,
}

/// What happens to a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobEvent {
    /// A worker takes the lease; the attempt number grows.
    Claim,
    /// The result arrived under the current attempt.
    Complete,
    /// The program failed and may be tried again.
    FailRetryable,
    /// The program failed for good, or the failure budget is used up.
    FailPermanent,
    /// The lease expired or was given back; not the program's fault.
    Lose,
    /// The loss budget is used up: the job kills worker after worker.
    LoseTooOften,
    /// The last sweep that wanted it was cancelled.
    Cancel,
    /// A user asks for another try.
    Retry,
}

/// The event does not apply to the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a job that is {state:?} cannot take {event:?}")]
pub struct TransitionRefused {
    /// State of the job.
    pub state: JobState,
    /// Event that was refused.
    pub event: JobEvent,
}

impl JobState {
    /// The state after `event`.
    ///
    /// # Errors
    /// [`TransitionRefused`] when the event does not apply; terminal states leave only by [`JobEvent::Retry`].
    pub fn after(self, event: JobEvent) -> Result<Self, TransitionRefused> {
        match (self, event) {
            (Self::Queued, JobEvent::Claim) => Ok(Self::Leased),
            (Self::Leased, JobEvent::Complete) => Ok(Self::Done),
            (Self::Leased, JobEvent::FailRetryable | JobEvent::Lose) => Ok(Self::Queued),
            (Self::Leased, JobEvent::FailPermanent | JobEvent::LoseTooOften) => Ok(Self::Failed),
            (Self::Queued | Self::Leased, JobEvent::Cancel) => Ok(Self::Cancelled),
            (Self::Failed | Self::Cancelled, JobEvent::Retry) => Ok(Self::Queued),
            (state, event) => Err(TransitionRefused { state, event }),
        }
    }

    /// Whether the job is over.
    #[must_use]
    pub fn is_terminal(self) -> bool {
        matches!(self, Self::Done | Self::Failed | Self::Cancelled)
    }
}
