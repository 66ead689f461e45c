//! Attraction between bodies.

mod constant;
mod finite_range;
mod none;

pub use constant::Constant;
pub use finite_range::FiniteRange;
pub use none::NoAttraction;

use crate::lane::Lane;

/// An attractive force along the normal.
pub trait Attraction: Copy + Send + Sync + 'static {
    /// Whether it acts at a distance: then [`Attraction::range`] widens the neighbour search.
    const BEYOND_CONTACT: bool;
    /// Whether the force jumps when a contact opens or closes.
    const JUMPS: bool;
    /// Part of the kernel name.
    const NAME: &'static str;

    /// Largest gap with a force [d].
    fn range(&self) -> f64;
    /// Attraction ≥ 0; `share` is the part of the step in which the contact is closed [k_n d].
    fn force<L: Lane>(&self, overlap: L, share: L) -> L;
    /// Potential energy, zero at infinity [k_n d²].
    fn energy(&self, overlap: f64) -> f64;
    /// Largest |slope| of the force over the gap, for the time step [k_n].
    fn stiffness(&self) -> f64;
}
