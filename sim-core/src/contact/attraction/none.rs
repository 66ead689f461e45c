//! No attraction.

use super::Attraction;
use crate::lane::Lane;

/// The null attraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoAttraction;

impl Attraction for NoAttraction {
    const BEYOND_CONTACT: bool = false;
    const JUMPS: bool = false;
    const NAME: &'static str = "";

    fn range(&self) -> f64 {
        0.0
    }
    #[inline(always)]
    fn force<L: Lane>(&self, _: L, _: L) -> L {
        L::splat(0.0)
    }
    fn energy(&self, _: f64) -> f64 {
        0.0
    }
    fn stiffness(&self) -> f64 {
        0.0
    }
}
