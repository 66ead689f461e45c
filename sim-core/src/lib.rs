//! The physics: `compile(scene)` gives a [`Simulation`]. No job, HTTP, SQL, async or wall clock in here.

mod compile;
pub mod dem;
pub mod elasticity;
mod error;
mod explain;
pub mod loading;
pub mod mpm;
pub mod observables;
pub mod packing;
mod simulation;

pub use compile::{compile, restore};
pub use error::SimError;
pub use explain::{Explanation, Skip, explain};
pub use simulation::{KernelChoice, Options, Progress, Simulation};
