//! Elastic repulsion as a function of overlap.

mod hooke;

pub use hooke::Hooke;

use crate::lane::Lane;

/// An elastic law.
pub trait Normal: Copy + Send + Sync + 'static {
    /// f_e(ov) ≥ 0, zero without overlap [k_n d].
    fn elastic<L: Lane>(&self, overlap: L) -> L;
    /// Largest slope of the law over all overlaps, for the time step [k_n].
    fn stiffness(&self) -> f64;
    /// Elastic energy ∫ f_e d(ov) [k_n d²].
    fn energy(&self, overlap: f64) -> f64;
    /// Part of the kernel name.
    const NAME: &'static str;
}
