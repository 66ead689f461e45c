//! Particles and contacts in memory: the one place that knows their layout.
//!
//! Measured reasons: a record of three 32-byte rows per particle beats separate arrays by a factor of two (no
//! gathers); contacts that may touch are kept apart from mere neighbours and packed in groups of four. Discs have smaller
//! records of their own.

mod chunk;
mod contacts;
mod discs;
mod particles;
mod planar;
mod records;

pub use chunk::{Chunk, chunk_bounds};
pub use contacts::{ContactList, WallList};
pub use discs::Discs;
pub use particles::{Body, Equal, Force, Grains};
pub use planar::{PlanarBody, PlanarForce};
pub use records::{Gain, Kinematics};
