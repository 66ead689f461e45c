//! Initial states.

pub mod hard_discs;
pub(crate) mod spheres;
