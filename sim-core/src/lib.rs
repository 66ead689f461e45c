//! The physics: `compile(scene)` gives a [`Simulation`]. No job, HTTP, SQL, async or wall clock in here.

#![allow(
    clippy::needless_range_loop,
    reason = "components of small vectors and lanes are addressed by axis and lane, several arrays at once"
)]

pub mod bench;
mod boundary;
mod compile;
pub mod consolidation;
pub mod contact;
mod control;
pub mod dem;
pub mod elasticity;
mod equilibrium;
mod error;
mod explain;
pub mod lane;
pub mod loading;
pub mod mpm;
mod neighbour;
pub mod observables;
pub mod packing;
mod random;
mod simulation;
pub mod space;
mod spheres;
mod state;

pub use compile::{compile, restore};
pub use error::SimError;
pub use explain::{Explanation, Saving, Skip, explain};
pub use simulation::{KernelChoice, Options, Progress, Simulation};
