//! The physics: `compile(scene)` gives a [`Simulation`]. No job, HTTP, SQL, async or wall clock in here.

mod compile;
pub mod dem;
pub mod elasticity;
mod equilibrium;
mod error;
mod explain;
pub mod loading;
pub mod mpm;
pub mod observables;
pub mod packing;
mod random;
mod simulation;
mod spheres;

pub use compile::{compile, restore};
pub use error::SimError;
pub use explain::{Explanation, Skip, explain};
pub use simulation::{KernelChoice, Options, Progress, Simulation};
