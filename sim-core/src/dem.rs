//! The discrete element method: particles, contact laws, walls, one step as a list of phases.
//!
//! Everything outside this engine talks to [`Dynamics`] and reads a [`View`]; the memory layout of particles and
//! contacts is known to [`crate::state`] alone.

mod cell;
mod discs;
mod dynamics;
mod engine;
mod kernel;
mod listing;
mod lists;
mod motion;
mod persist;
mod probe;
mod prolong;
mod refresh;
mod sanity;
mod spheres;
mod step;
mod threads;
mod time_step;
mod view;

pub use crate::boundary::{CellControl, PeriodicCell};
pub use cell::{CellDynamics, CellPicture, CellResiduals};
pub use discs::{DiscParameters, InitialDiscs, discs, restore_discs};
pub use dynamics::{Counters, Drag, Dynamics, Fault, InitialState, Motion, SphereParameters};
pub use spheres::{Laws, restore_spheres, spheres};
pub use time_step::largest_step;
pub use view::{Energies, PairContact, View, WallContact, WallView};
