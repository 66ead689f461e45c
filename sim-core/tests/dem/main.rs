//! The particle engine against exact solutions, conservation laws and its own plain versions.

#![allow(clippy::needless_range_loop, reason = "components of small vectors are addressed by axis")]

mod collisions;
mod conservation;
mod equivalence;
mod mixed;
mod stability;
mod statics;
mod support;
