//! Friction.

mod coulomb_spring;
mod frictionless;
mod planar_spring;

pub use coulomb_spring::CoulombSpring;
pub use frictionless::Frictionless;
pub use planar_spring::PlanarSpring;

use crate::lane::Lane;
use crate::space::{Space, Vector};

/// A tangential law.
pub trait Tangential<S: Space>: Copy + Send + Sync + 'static {
    /// Slots of contact memory.
    const SLOTS: usize;
    /// Whether spins and torques exist.
    const NEEDS_SPIN: bool;
    /// Whether [`Tangential::stretch`] leaves the bound to [`Tangential::limit`].
    const BOUNDED: bool = false;
    /// Whether the memory changes sign when the two bodies swap roles.
    const REVERSES: bool;
    /// Part of the kernel name.
    const NAME: &'static str;

    /// Tangential force on a of a contact with this `normal`, with the rate `approach` of its bodies, `elastic` the elastic
    /// normal force and `active` whether the contact is closed. A [`Tangential::BOUNDED`] law leaves its bound out; the mask says where the force
    /// exceeds it: there [`Tangential::limit`] must follow. The mask of other laws means nothing.
    ///
    /// # Safety
    /// `memory` points to [`Tangential::SLOTS`] slots of a group at the first lane.
    #[expect(clippy::too_many_arguments, reason = "what a tangential law may look at, each of its own kind")]
    unsafe fn stretch<L: Lane>(
        &self,
        normal: S::Vector<L>,
        slide: &S::Slide<L>,
        approach: L,
        elastic: L,
        active: L::Mask,
        dt: L,
        memory: *mut L::Scalar,
    ) -> (S::Shear<L>, L::Mask);
    /// Cuts what a [`Tangential::BOUNDED`] law remembers back to its bound where the force exceeds it; all else stays to
    /// the last bit.
    ///
    /// # Safety
    /// As for [`Tangential::stretch`].
    #[inline(always)]
    unsafe fn limit<L: Lane>(&self, _elastic: L, _memory: *mut L::Scalar) {
        const { assert!(!Self::BOUNDED, "a bounded law has a bound") }
    }
    /// The tangential force of what a [`Tangential::BOUNDED`] law remembers: that of [`Tangential::stretch`] until
    /// [`Tangential::limit`].
    ///
    /// # Safety
    /// As for [`Tangential::stretch`].
    #[inline(always)]
    unsafe fn held<L: Lane>(&self, _memory: *const L::Scalar) -> S::Shear<L> {
        const { assert!(!Self::BOUNDED, "a bounded law remembers its force") }
        S::Shear::zero()
    }
    /// k_t, for the time step [k_n].
    fn stiffness(&self) -> f64;
    /// Coulomb bound for an elastic normal force [k_n d]; infinite without a bound, zero without friction.
    fn bound(&self, elastic: f64) -> f64;
}
