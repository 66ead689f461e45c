//! Constant adhesion: −f_c while in contact, nothing at a distance (paper 2024, eq. 2).

use super::Attraction;
use crate::lane::Lane;

/// f_a = f_c for ov > 0, else 0. The pull-off force is f_c, the pair rests at ov = f_c/k_n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    /// f_c [k_n d].
    pub fc: f64,
}

impl Attraction for Constant {
    const BEYOND_CONTACT: bool = false;
    const JUMPS: bool = true;
    const NAME: &'static str = "+constant_adhesion";

    fn range(&self) -> f64 {
        0.0
    }
    #[inline(always)]
    fn force<L: Lane>(&self, _: L, share: L) -> L {
        L::splat(self.fc).mul(share)
    }
    fn energy(&self, overlap: f64) -> f64 {
        if overlap > 0.0 { -self.fc * overlap } else { 0.0 }
    }
    fn stiffness(&self) -> f64 {
        0.0
    }
}
