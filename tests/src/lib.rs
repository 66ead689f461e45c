//! What the tests across packages share.

pub mod workspace;
