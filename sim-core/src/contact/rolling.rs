//! Resistance to rolling.

mod none;
mod spring_slider;

pub use none::NoRolling;
pub use spring_slider::SpringSlider;

use crate::lane::Lane;
use crate::space::Space;

/// A rolling law.
pub trait Rolling<S: Space>: Copy + Send + Sync + 'static {
    /// Slots of contact memory.
    const SLOTS: usize;
    /// Whether there is a moment at all.
    const ROLLS: bool;
    /// Part of the kernel name.
    const NAME: &'static str;

    /// Moment on a (the opposite acts on b), from the relative spin ω_b − ω_a at t_n − dt/2.
    ///
    /// # Safety
    /// `memory` points to [`Rolling::SLOTS`] slots of a group at the first lane.
    unsafe fn moment<L: Lane>(
        &self,
        spin_difference: S::Spin<L>,
        elastic: L,
        active: L::Mask,
        dt: L,
        memory: *mut L::Scalar,
    ) -> S::Spin<L>;
    /// Rolling stiffness, for the time step [k_n d²].
    fn stiffness(&self) -> f64;
}
