//! Four numbers at once: the points of one bilinear cell.
//!
//! Plain arrays: inside a function compiled for AVX2 they become one register each, elsewhere two or four. Every
//! operation is one IEEE operation per lane, so that a lane has the bits of the plain number on any machine.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Real;

/// Four points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Quad(pub [f64; 4]);

impl Quad {
    /// ((a + b) + c) + d, as a loop over the points adds.
    #[inline(always)]
    #[must_use]
    pub fn sum(self) -> f64 {
        ((self.0[0] + self.0[1]) + self.0[2]) + self.0[3]
    }

    /// The sums of four quads, each as [`Quad::sum`].
    #[inline(always)]
    #[must_use]
    pub fn sums(of: [Self; 4]) -> Self {
        let [a, b, c, d] = Self::transposed(of);
        ((a + b) + c) + d
    }

    /// Columns of the 4 × 4 table of the rows `of`.
    #[inline(always)]
    #[must_use]
    pub fn transposed(of: [Self; 4]) -> [Self; 4] {
        let [a, b, c, d] = of.map(|row| row.0);
        [
            Self([a[0], b[0], c[0], d[0]]),
            Self([a[1], b[1], c[1], d[1]]),
            Self([a[2], b[2], c[2], d[2]]),
            Self([a[3], b[3], c[3], d[3]]),
        ]
    }

    #[inline(always)]
    fn with(self, other: Self, op: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (self.0, other.0);
        Self([op(a[0], b[0]), op(a[1], b[1]), op(a[2], b[2]), op(a[3], b[3])])
    }
}

impl Add for Quad {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}
impl Sub for Quad {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}
impl Mul for Quad {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}
impl Div for Quad {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(other, |a, b| a / b)
    }
}
impl Neg for Quad {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|one| -one))
    }
}
impl Mul<f64> for Quad {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * Self([factor; 4])
    }
}
impl Add<f64> for Quad {
    type Output = Self;
    #[inline(always)]
    fn add(self, shift: f64) -> Self {
        self + Self([shift; 4])
    }
}
impl Sub<f64> for Quad {
    type Output = Self;
    #[inline(always)]
    fn sub(self, shift: f64) -> Self {
        self - Self([shift; 4])
    }
}

impl Real for Quad {
    type Mask = [bool; 4];
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; 4])
    }
    #[inline(always)]
    fn above(self, limit: Self) -> [bool; 4] {
        let (a, b) = (self.0, limit.0);
        [a[0] > b[0], a[1] > b[1], a[2] > b[2], a[3] > b[3]]
    }
    #[inline(always)]
    fn any(mask: [bool; 4]) -> bool {
        mask[0] | mask[1] | mask[2] | mask[3]
    }
    #[inline(always)]
    fn choose(mask: [bool; 4], yes: Self, no: Self) -> Self {
        let pick = |k: usize| if mask[k] { yes.0[k] } else { no.0[k] };
        Self([pick(0), pick(1), pick(2), pick(3)])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
}
