//! Plastic discs: compaction and coordination of a sweep (the 2021 study).
//!
//! Compression is positive throughout, which the paper's formulas need.

pub mod compaction;
pub mod coordination;
mod curve;
pub mod model;

pub use compaction::{Compaction, CompactionOptions, compaction};
pub use coordination::{Coordination, coordination};
pub use curve::{PlasticCurve, PlasticState};
