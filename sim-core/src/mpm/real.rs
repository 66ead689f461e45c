//! Numbers a constitutive law can be written in: plain, or carrying derivatives.

use std::ops::{Add, Div, Mul, Neg, Sub};

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
    /// The constant `value`.
    fn constant(value: f64) -> Self;
    /// The value without derivatives.
    fn value(self) -> f64;
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
}

impl Real for f64 {
    #[inline]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline]
    fn value(self) -> f64 {
        self
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
    #[inline]
    fn constant(value: f64) -> Self {
        Self { re: value, d: [0.0; 4] }
    }
    #[inline]
    fn value(self) -> f64 {
        self.re
    }
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.re.sqrt();
        self.map(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }
}
