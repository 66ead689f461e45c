//! Discs of different sizes.

use super::Grains;
use crate::lane::{Gather, Lane, Number};

/// Discs with m = d² (unit mass at d = 1) and moment of inertia m d²/8, by slot.
#[derive(Clone, Debug, PartialEq)]
pub struct Discs {
    radius: Vec<f64>,
    /// 1/mass and 1/inertia.
    inverses: Vec<[f64; 2]>,
    /// The largest radius, which every step asks for [d].
    largest: f64,
}

impl Discs {
    /// Discs of these radii, in the order of the slots [d].
    #[must_use]
    pub fn new(radius: Vec<f64>) -> Self {
        let inverses = radius.iter().map(|r| [1.0 / (4.0 * r * r), 1.0 / (2.0 * r * r * r * r)]).collect();
        let largest = radius.iter().copied().fold(0.0, f64::max);
        Self { radius, inverses, largest }
    }
}

impl Grains for Discs {
    const EQUAL: bool = false;
    const CONSTANTS: usize = 3;

    fn constants(&self, a: usize, b: usize) -> [f64; 3] {
        let (r, s) = (self.radius[a], self.radius[b]);
        let product = r * s;
        [r, s, (product + product) / r.mul_add(r, s * s).sqrt()]
    }
    #[inline(always)]
    unsafe fn pair<L: Lane>(&self, constants: *const L::Scalar) -> [L; 3] {
        let row = L::Scalar::GROUP;
        // SAFETY: the caller vouches for the rows.
        unsafe { [L::load(constants), L::load(constants.add(row)), L::load(constants.add(2 * row))] }
    }
    #[inline(always)]
    unsafe fn radii<L: Gather>(&self, at: *const u32) -> L {
        // SAFETY: the caller vouches for the indices.
        unsafe { L::gather(self.radius.as_ptr(), at) }
    }
    /// √(m_a m_b/(m_a + m_b)) = 2 R_a R_b/√(R_a² + R_b²).
    #[inline(always)]
    unsafe fn root_pair_mass<L: Gather>(&self, a: *const u32, b: *const u32) -> L {
        // SAFETY: as above.
        let (r, s) = unsafe { (self.radii::<L>(a), self.radii::<L>(b)) };
        let product = r.mul(s);
        product.add(product).div(r.mul_add(r, s.mul(s)).sqrt())
    }
    #[inline(always)]
    unsafe fn root_wall_mass<L: Gather>(&self, a: *const u32) -> L {
        // SAFETY: as above.
        let r = unsafe { self.radii::<L>(a) };
        r.add(r)
    }
    #[inline(always)]
    fn radius(&self, at: usize) -> f64 {
        self.radius[at]
    }
    #[inline(always)]
    fn mass(&self, at: usize) -> f64 {
        4.0 * self.radius[at] * self.radius[at]
    }
    #[inline(always)]
    fn inertia(&self, at: usize) -> f64 {
        let r = self.radius[at];
        2.0 * r * r * r * r
    }
    #[inline(always)]
    fn inverse_mass(&self, at: usize) -> f64 {
        self.inverses[at][0]
    }
    #[inline(always)]
    fn inverse_inertia(&self, at: usize) -> f64 {
        self.inverses[at][1]
    }
    fn largest_radius(&self) -> f64 {
        self.largest
    }
    fn permute(&mut self, order: &[u32]) {
        self.radius = order.iter().map(|&old| self.radius[old as usize]).collect();
        self.inverses = order.iter().map(|&old| self.inverses[old as usize]).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masses_follow_the_area() {
        let mut discs = Discs::new(vec![0.5, 0.25, 0.4]);
        assert_eq!((discs.mass(0), discs.mass(1)), (1.0, 0.25));
        assert_eq!(discs.inertia(0), 1.0 / 8.0);
        let pair = [0_u32, 1];
        // SAFETY: both indices are valid.
        let root = unsafe { discs.root_pair_mass::<f64>(&raw const pair[0], &raw const pair[1]) };
        assert!((root * root - 0.25 / 1.25).abs() < 1e-16);
        discs.permute(&[2, 0, 1]);
        assert_eq!([discs.radius(0), discs.radius(1), discs.radius(2)], [0.4, 0.5, 0.25]);
        assert!((discs.inverse_mass(2) - 4.0).abs() < 1e-15);
    }
}
