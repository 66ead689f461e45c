//! Quasi-static consolidation of cohesive discs: assembling, then a path through equilibrium states.
//!
//! Units inside are a = m = K_N = 1; rows carry forces in F0 (without cohesion in P a), pressures as P* = a P/F0 (P/K_N)
//! and times in T0 = √(a m/F0) (√(m/P)). Source: Gilabert, Roux and Castellanos (2008).

mod assemble;
mod checkpoint;
mod driver;
mod explain;
mod measure;
mod outcome;
mod scales;

pub use driver::Consolidation;
pub(crate) use explain::explain;
