//! Observables that read a state and change nothing.

pub(crate) mod blocks;
pub mod bond_changes;
pub(crate) mod coordination;
pub mod disc_contacts;
pub mod forces;
pub mod fractal;
pub mod pores;
pub(crate) mod profile;
pub(crate) mod sphere_box;
pub mod structure_factor;
pub(crate) mod void_ratio;
