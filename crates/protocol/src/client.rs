//! The typed HTTP client of the coordinator, used by worker, command line and tests.
//!
//! Every call is safe to repeat, so a coordinator that does not answer is asked again with jittered exponential
//! back-off that respects `Retry-After`; how long is the caller's [`Patience`]. What is left is an error typed by
//! what the caller can do ([`ClientError`]).

mod api;
mod error;
mod lease;
mod patience;
mod transport;

pub use error::ClientError;
pub use patience::Patience;
pub use transport::{BuildError, Client};
