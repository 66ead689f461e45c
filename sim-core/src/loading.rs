//! A loading path: pressures to equilibrate at, one after another, and the rules of equilibrium.

mod equilibrium;
mod path;

pub use equilibrium::{Criteria, Equilibrium, Residuals, Stage, Tolerances, Verdict};
pub use path::{Branch, Leg, LoadingPath, PathState};
