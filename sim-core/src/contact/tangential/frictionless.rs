//! No friction: no tangential force, no spins, no memory.

use super::Tangential;
use crate::lane::Lane;
use crate::space::{Space, Vector};

/// The null tangential law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frictionless;

impl<S: Space> Tangential<S> for Frictionless {
    const SLOTS: usize = 0;
    const NEEDS_SPIN: bool = false;
    const REVERSES: bool = true;
    const NAME: &'static str = "";

    #[inline(always)]
    unsafe fn stretch<L: Lane>(
        &self,
        _: S::Vector<L>,
        _: &S::Slide<L>,
        _: L,
        _: L,
        active: L::Mask,
        _: L,
        _: *mut L::Scalar,
    ) -> (S::Shear<L>, L::Mask) {
        (S::Shear::zero(), active)
    }
    fn stiffness(&self) -> f64 {
        0.0
    }
    fn bound(&self, _: f64) -> f64 {
        0.0
    }
}
