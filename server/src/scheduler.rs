//! Decisions as pure functions over state, and the reconcilers that carry them out.

pub mod backoff;

pub mod estimate;

pub mod lifecycle;
