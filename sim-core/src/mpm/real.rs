//! Numbers a constitutive law can be written in: plain, carrying derivatives, or four points at once.

mod quad;

use std::ops::{Add, Div, Mul, Neg, Sub};

pub use quad::Quad;

/// A real number or a truncated Taylor polynomial: laws written over `Real` give stress and exact tangent from the
/// same lines.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
{
    /// Result of a comparison: one truth value per point.
    type Mask: Copy;
    /// The constant `value`.
    fn constant(value: f64) -> Self;
    /// Where the value is above `limit`.
    fn above(self, limit: Self) -> Self::Mask;
    /// Whether a mask holds for any point.
    fn any(mask: Self::Mask) -> bool;
    /// `yes` where the mask holds, else `no`.
    #[must_use]
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
}

impl Real for f64 {
    type Mask = bool;
    #[inline]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline]
    fn above(self, limit: Self) -> bool {
        self > limit
    }
    #[inline]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline]
    fn choose(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
}

/// A value with its derivatives by the four components of an in-plane gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// Value.
    pub re: f64,
    /// Derivatives by (xx, xy, yx, yy).
    pub d: [f64; 4],
}

impl Dual {
    /// The variable number `index` at `value`.
    #[must_use]
    pub fn variable(value: f64, index: usize) -> Self {
        let mut d = [0.0; 4];
        d[index] = 1.0;
        Self { re: value, d }
    }

    #[inline]
    fn map(self, re: f64, slope: f64) -> Self {
        Self { re, d: self.d.map(|one| one * slope) }
    }
}

#[inline]
fn combine(a: [f64; 4], ka: f64, b: [f64; 4], kb: f64) -> [f64; 4] {
    [a[0] * ka + b[0] * kb, a[1] * ka + b[1] * kb, a[2] * ka + b[2] * kb, a[3] * ka + b[3] * kb]
}

impl Add for Dual {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, d: combine(self.d, 1.0, other.d, 1.0) }
    }
}
impl Sub for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, d: combine(self.d, 1.0, other.d, -1.0) }
    }
}
impl Mul for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re, d: combine(self.d, other.re, other.d, self.re) }
    }
}
impl Div for Dual {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let re = self.re / other.re;
        let inverse = 1.0 / other.re;
        Self { re, d: combine(self.d, inverse, other.d, -re * inverse) }
    }
}
impl Neg for Dual {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(-self.re, -1.0)
    }
}
impl Mul<f64> for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        self.map(self.re * factor, factor)
    }
}
impl Add<f64> for Dual {
    type Output = Self;
    #[inline]
    fn add(self, shift: f64) -> Self {
        Self { re: self.re + shift, d: self.d }
    }
}
impl Sub<f64> for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, shift: f64) -> Self {
        Self { re: self.re - shift, d: self.d }
    }
}

impl Real for Dual {
    type Mask = bool;
    #[inline]
    fn constant(value: f64) -> Self {
        Self { re: value, d: [0.0; 4] }
    }
    #[inline]
    fn above(self, limit: Self) -> bool {
        self.re > limit.re
    }
    #[inline]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline]
    fn choose(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.re.sqrt();
        self.map(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }
}
