//! Decisions as pure functions over state, and the reconcilers that carry them out.

pub mod backoff;
pub mod claims;
pub mod estimate;
pub mod heartbeats;
pub mod lifecycle;
pub mod reconcile;
