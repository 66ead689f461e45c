//! Attraction of finite range: −F0 in contact, falling linearly to zero at the gap D0 (discs 2008, Table I).

use super::Attraction;
use crate::lane::Lane;

/// f_a = F0 for ov > 0, F0 (1 − h/D0) for a gap 0 < h = −ov < D0, else 0: continuous and the same on approach and on
/// separation, so it has a potential.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteRange {
    /// F0 [k_n d].
    pub f0: f64,
    /// D0 [d].
    pub d0: f64,
}

impl Attraction for FiniteRange {
    const BEYOND_CONTACT: bool = true;
    const JUMPS: bool = false;
    const NAME: &'static str = "+finite_range";

    fn range(&self) -> f64 {
        self.d0
    }
    #[inline(always)]
    fn force<L: Lane>(&self, overlap: L, _: L) -> L {
        let slope = L::splat(self.f0 / self.d0);
        let f0 = L::splat(self.f0);
        slope.mul_add(overlap, f0).max(L::splat(0.0)).min(f0)
    }
    fn energy(&self, overlap: f64) -> f64 {
        if overlap > 0.0 {
            -self.f0 * (overlap + 0.5 * self.d0)
        } else {
            let inside = (self.d0 + overlap).max(0.0);
            -0.5 * self.f0 / self.d0 * inside * inside
        }
    }
    fn stiffness(&self) -> f64 {
        self.f0 / self.d0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_at_known_gaps() {
        for (f0, d0) in [(1e-5, 1e-3), (1.0, 0.5)] {
            let law = FiniteRange { f0, d0 };
            let force = |overlap: f64| law.force(overlap, 1.0);
            assert_eq!(force(1e-4), f0);
            assert_eq!(force(0.0), f0);
            assert!((force(-0.25 * d0) - 0.75 * f0).abs() < 1e-15 * f0);
            // The slope f0/d0 is rounded once.
            assert!(force(-d0) <= f64::EPSILON * f0);
            assert_eq!(force(-2.0 * d0), 0.0);
        }
    }

    #[test]
    fn force_is_the_slope_of_the_potential() {
        let law = FiniteRange { f0: 2.0, d0: 0.1 };
        let step = 1e-6;
        for overlap in [-0.15, -0.0999, -0.06, -0.001, 0.001, 0.3] {
            let slope = (law.energy(overlap + step) - law.energy(overlap - step)) / (2.0 * step);
            // Attraction pulls towards overlap: f_a = −dE/d(ov).
            assert!((slope + law.force(overlap, 1.0)).abs() < 1e-8, "{overlap}");
        }
        assert_eq!(law.energy(-0.2), 0.0);
    }
}
