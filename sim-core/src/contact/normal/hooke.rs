//! Linear spring: f_e = k_n ov (paper 2024, eq. 2).

use super::Normal;
use crate::lane::Lane;

/// f_e = k_n ov for ov > 0, else 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hooke {
    /// k_n [k_n].
    pub kn: f64,
}

impl Normal for Hooke {
    const NAME: &'static str = "hooke";

    #[inline(always)]
    fn elastic<L: Lane>(&self, overlap: L) -> L {
        L::splat(self.kn).mul(overlap).max(L::splat(0.0))
    }
    fn stiffness(&self) -> f64 {
        self.kn
    }
    fn energy(&self, overlap: f64) -> f64 {
        if overlap > 0.0 { 0.5 * self.kn * overlap * overlap } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_and_energy_are_those_of_a_spring_that_cannot_pull() {
        for kn in [1.0, 1e5] {
            let law = Hooke { kn };
            assert_eq!(law.elastic(-1e-3), 0.0);
            assert_eq!(law.elastic(0.0), 0.0);
            assert_eq!(law.elastic(1e-3), kn * 1e-3);
            assert_eq!(law.energy(2e-3), 0.5 * kn * 2e-3 * 2e-3);
        }
    }
}
