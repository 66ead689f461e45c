//! Free rolling.

use super::Rolling;
use crate::lane::Lane;
use crate::space::{Space, Vector};

/// The null rolling law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoRolling;

impl<S: Space> Rolling<S> for NoRolling {
    const SLOTS: usize = 0;
    const ROLLS: bool = false;
    const NAME: &'static str = "";

    #[inline(always)]
    unsafe fn moment<L: Lane>(&self, _: S::Spin<L>, _: L, _: L::Mask, _: L, _: *mut L::Scalar) -> S::Spin<L> {
        S::Spin::zero()
    }
    fn stiffness(&self) -> f64 {
        0.0
    }
}
