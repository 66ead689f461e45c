//! No dissipation.

use super::Damping;
use crate::lane::Lane;

/// The null dashpot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoDamping;

impl Damping for NoDamping {
    const SLOTS: usize = 0;
    const JUMPS: bool = false;
    const NAME: &'static str = "";

    #[inline(always)]
    unsafe fn viscous<L: Lane>(&self, _: L, _: L, _: L, _: L::Mask, _: *mut L::Scalar) -> L {
        L::splat(0.0)
    }
    #[inline(always)]
    fn repulsion<L: Lane>(&self, elastic: L, _: L) -> L {
        elastic
    }
    fn vacant() -> f64 {
        0.0
    }
    fn coefficient(&self) -> f64 {
        0.0
    }
}
