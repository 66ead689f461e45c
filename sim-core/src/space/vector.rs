//! Vectors of one, two and three lanes.

use crate::lane::{Lane, Number};

/// What the laws need of a vector.
pub trait Vector<L: Lane>: Copy {
    /// Components.
    const COMPONENTS: usize;
    /// The zero vector.
    fn zero() -> Self;
    /// self + other.
    fn add(self, other: Self) -> Self;
    /// self · factor.
    fn scale(self, factor: L) -> Self;
    /// self + factor · other, one rounding per component.
    fn add_scaled(self, factor: L, other: Self) -> Self;
    /// self − factor · other, one rounding per component.
    fn sub_scaled(self, factor: L, other: Self) -> Self;
    /// self · other, summed from the first component on.
    fn dot(self, other: Self) -> L;
    /// The vector where the mask holds, else zero.
    fn keep(self, mask: L::Mask) -> Self;
    /// Reads the components from consecutive slots of a group memory.
    ///
    /// # Safety
    /// `from` points to [`Vector::COMPONENTS`] slots of the group, at the first lane to read.
    unsafe fn load(from: *const L::Scalar) -> Self;
    /// Writes the components to consecutive slots of a group memory.
    ///
    /// # Safety
    /// As for [`Vector::load`], writable.
    unsafe fn store(self, to: *mut L::Scalar);
}

macro_rules! vector {
    ($(#[$doc:meta])* $name:ident, $count:literal, first $first:tt, rest [$($rest:tt),*]) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<L>(pub [L; $count]);

        impl<L: Lane> Vector<L> for $name<L> {
            const COMPONENTS: usize = $count;

            #[inline(always)]
            fn zero() -> Self {
                Self([L::splat(0.0); $count])
            }
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                Self([self.0[$first].add(other.0[$first]), $(self.0[$rest].add(other.0[$rest])),*])
            }
            #[inline(always)]
            fn scale(self, factor: L) -> Self {
                Self([self.0[$first].mul(factor), $(self.0[$rest].mul(factor)),*])
            }
            #[inline(always)]
            fn add_scaled(self, factor: L, other: Self) -> Self {
                Self([
                    factor.mul_add(other.0[$first], self.0[$first]),
                    $(factor.mul_add(other.0[$rest], self.0[$rest])),*
                ])
            }
            #[inline(always)]
            fn sub_scaled(self, factor: L, other: Self) -> Self {
                Self([
                    factor.neg_mul_add(other.0[$first], self.0[$first]),
                    $(factor.neg_mul_add(other.0[$rest], self.0[$rest])),*
                ])
            }
            #[inline(always)]
            fn dot(self, other: Self) -> L {
                let sum = self.0[$first].mul(other.0[$first]);
                $(let sum = self.0[$rest].mul_add(other.0[$rest], sum);)*
                sum
            }
            #[inline(always)]
            fn keep(self, mask: L::Mask) -> Self {
                Self([self.0[$first].keep(mask), $(self.0[$rest].keep(mask)),*])
            }
            #[inline(always)]
            unsafe fn load(from: *const L::Scalar) -> Self {
                // SAFETY: the caller vouches for the slots.
                unsafe { Self([L::load(from), $(L::load(from.add($rest * <L::Scalar as Number>::GROUP))),*]) }
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut L::Scalar) {
                // SAFETY: the caller vouches for the slots.
                unsafe {
                    self.0[$first].store(to);
                    $(self.0[$rest].store(to.add($rest * <L::Scalar as Number>::GROUP));)*
                }
            }
        }
    };
}

vector!(
    /// One component: a spin in the plane.
    V1, 1, first 0, rest []
);
vector!(
    /// Two components.
    V2, 2, first 0, rest [1]
);
vector!(
    /// Three components.
    V3, 3, first 0, rest [1, 2]
);
