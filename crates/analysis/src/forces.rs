//! Normal forces: P(fn/fc) ∝ exp(β− x) on [−0.5, 0] and exp(−β+ x) on [0, 1.5] (32).

pub mod curve;
pub mod distribution;
pub mod truncated;

pub use curve::{ForcePoint, Forces, forces};
pub use distribution::{ForceDistribution, distribution, from_contacts};
pub use truncated::{Truncated, truncated_exponential};
