//! The engine of cohesive spheres: initial state, dynamics, stop criteria, guard and record put together.

mod kicks;
mod memory;
mod outcome;
mod run;
mod start;
mod system;

pub(crate) use run::Run;
pub(crate) use start::explain;
