//! Cohesive discs: consolidation curves, moduli and structure of a sweep (the 2008 study).

pub mod consolidation;
pub mod moduli;
mod series;
mod state;
pub mod structure;

pub use consolidation::{Consolidation, ConsolidationOptions, consolidation};
pub use moduli::{Moduli, moduli};
pub use series::CurvePoint;
pub use state::DiscState;
pub use structure::{Structure, structure};
