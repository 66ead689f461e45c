//! Everything that crosses the wire: ids, job states and their transitions, lease messages, API bodies, and the
//! typed client (feature `client`). Shared by coordinator, worker, command line and tests.

pub mod api;
#[cfg(feature = "client")]
pub mod client;
mod ids;
mod job;
mod lease;
mod problem;
mod version;

pub use ids::{JobId, SweepId, WorkerId};
pub use job::{JobEvent, JobState, TransitionRefused};
pub use lease::{
    Accepted, Checkpoint, CheckpointQuery, ClaimRequest, ClaimResponse, Completion, Directive, Failure,
    FailureKind, Grant, Heartbeat, HeartbeatReply, Registered, Registration, Release, Returned,
};
pub use problem::{FieldProblem, ProblemDocument};
pub use version::PROTOCOL_VERSION;
