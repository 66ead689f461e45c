//! Initial states.

pub mod hard_discs;
