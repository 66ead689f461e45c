//! Observables that read a state and change nothing.

pub mod bond_changes;
pub mod disc_contacts;
pub mod fractal;
pub mod pores;
pub mod structure_factor;
