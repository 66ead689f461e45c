//! Small tensors of plane strain.

use serde::{Deserialize, Serialize};

use super::real::Real;

/// A 2×2 tensor of the plane, for example a deformation gradient [1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat2<T = f64> {
    /// Row x, column x.
    pub xx: T,
    /// Row x, column y.
    pub xy: T,
    /// Row y, column x.
    pub yx: T,
    /// Row y, column y.
    pub yy: T,
}

impl<T: Real> Mat2<T> {
    /// The unit tensor.
    #[must_use]
    pub fn identity() -> Self {
        let (one, zero) = (T::constant(1.0), T::constant(0.0));
        Self { xx: one, xy: zero, yx: zero, yy: one }
    }

    /// Determinant.
    #[inline(always)]
    #[must_use]
    pub fn det(self) -> T {
        self.xx * self.yy - self.xy * self.yx
    }

    /// Inverse; the determinant must not vanish.
    #[inline(always)]
    #[must_use]
    pub fn inverse(self) -> Self {
        let r = T::constant(1.0) / self.det();
        Self { xx: self.yy * r, xy: -(self.xy * r), yx: -(self.yx * r), yy: self.xx * r }
    }

    /// Product `self · other`.
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> Self {
        Self {
            xx: self.xx * other.xx + self.xy * other.yx,
            xy: self.xx * other.xy + self.xy * other.yy,
            yx: self.yx * other.xx + self.yy * other.yx,
            yy: self.yx * other.xy + self.yy * other.yy,
        }
    }

    /// Every component times `factor`.
    #[inline(always)]
    #[must_use]
    pub fn scaled(self, factor: T) -> Self {
        Self { xx: self.xx * factor, xy: self.xy * factor, yx: self.yx * factor, yy: self.yy * factor }
    }
}

/// Symmetric stress of plane strain with its out-of-plane component [stress], tension positive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stress<T = f64> {
    /// σ_xx.
    pub xx: T,
    /// σ_yy.
    pub yy: T,
    /// σ_zz.
    pub zz: T,
    /// σ_xy.
    pub xy: T,
}

impl Stress<f64> {
    /// No stress.
    pub const ZERO: Self = Self { xx: 0.0, yy: 0.0, zz: 0.0, xy: 0.0 };

    /// The same stress as constants of another number type.
    #[inline(always)]
    #[must_use]
    pub fn lift<T: Real>(self) -> Stress<T> {
        Stress {
            xx: T::constant(self.xx),
            yy: T::constant(self.yy),
            zz: T::constant(self.zz),
            xy: T::constant(self.xy),
        }
    }
}

impl<T: Real> Stress<T> {
    /// Mean stress tr(σ)/3.
    #[inline(always)]
    #[must_use]
    pub fn mean(self) -> T {
        (self.xx + self.yy + self.zz) * (1.0 / 3.0)
    }

    /// Von Mises stress q = √(3/2 s:s).
    #[inline(always)]
    #[must_use]
    pub fn von_mises(self) -> T {
        let m = self.mean();
        let (a, b, c) = (self.xx - m, self.yy - m, self.zz - m);
        ((a * a + b * b + c * c + self.xy * self.xy * 2.0) * 1.5).sqrt()
    }

    /// R σ Rᵀ for the rotation R = [[cos, sin], [−sin, cos]].
    #[inline(always)]
    #[must_use]
    pub fn rotated(self, cos: T, sin: T) -> Self {
        let (cc, cs, ss) = (cos * cos, cos * sin, sin * sin);
        Self {
            xx: cc * self.xx + cs * self.xy * 2.0 + ss * self.yy,
            yy: ss * self.xx - cs * self.xy * 2.0 + cc * self.yy,
            zz: self.zz,
            xy: (cc - ss) * self.xy - cs * (self.xx - self.yy),
        }
    }
}
