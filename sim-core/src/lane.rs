//! Lanes: the number type the laws are written in, once.
//!
//! A [`Lane`] is one number (oracle, observation, machines without AVX2) or a register full of them (the kernel). Every
//! operation is a single IEEE operation with the same operands in both, so a trajectory has the same bits on either path.
//! Fused multiply-add is explicit ([`Lane::mul_add`]) and used at the same places by construction.
//!
//! What is not a position is kept in a [`Number`] of the run's choice: `f64`, four in a register of AVX2 and eight in one of
//! AVX-512, or `f32` (mixed precision), eight or sixteen in a register. Positions are `f64` always, and so is everything up to
//! how far two of them are apart.
//!
//! Contact memory is stored in groups of [`Number::GROUP`] contacts on every machine: slot k of place l lies at `k * GROUP + l`,
//! and a bundle is a whole group or an aligned part of one.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx2_plane;
#[cfg(target_arch = "x86_64")]
mod avx2_single;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod avx512_plane;
#[cfg(target_arch = "x86_64")]
mod avx512_single;
mod gather;
mod plane;
mod scalar;
#[cfg(target_arch = "x86_64")]
mod two;
#[cfg(target_arch = "x86_64")]
mod vector;

#[cfg(target_arch = "x86_64")]
pub use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub use avx2_single::Avx2Single;
#[cfg(target_arch = "x86_64")]
pub use avx512::Avx512;
#[cfg(target_arch = "x86_64")]
pub use avx512_single::Avx512Single;
pub use gather::{Gather, NONE, OTHER, Real, SAME};
pub use plane::{Plane, Widen};
#[cfg(target_arch = "x86_64")]
pub use two::Two;

/// Most contacts in one group.
pub const WIDEST: usize = 16;

/// What velocities, forces and memories of contacts are kept in.
pub trait Number: Copy + Default + PartialEq + std::fmt::Debug + Into<f64> + Send + Sync + 'static {
    /// Contacts in one group: numbers in the widest register there is.
    const GROUP: usize;
    /// Least relative difference by which a force at its bound is told from one below it [1].
    const AT_BOUND: f64;
    /// Part of the kernel name.
    const NAME: &'static str;
    /// Place of the torque among the numbers of a force: right after the force where that saves half of a register to write, else in
    /// the next row of four.
    const TORQUE: usize;
    /// Makes a body begin where it is fetched in the fewest pieces.
    type Alignment: Align;
    /// The same for a disc.
    type PlanarAlignment: Align;
    /// The same for a row of four numbers.
    type RowAlignment: Align;

    /// The nearest number.
    fn of(value: f64) -> Self;
}

/// Nothing but where something begins.
pub trait Align: Copy + Default + PartialEq + std::fmt::Debug + Send + Sync + 'static {}

/// A quarter of a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(align(16))]
pub struct Aligned16;
impl Align for Aligned16 {}

/// Half a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(align(32))]
pub struct Aligned32;
impl Align for Aligned32 {}

/// A cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(align(64))]
pub struct Aligned64;
impl Align for Aligned64 {}

impl Number for f64 {
    const GROUP: usize = 8;
    const AT_BOUND: f64 = 1e-12;
    const NAME: &'static str = "";
    const TORQUE: usize = 3;
    /// A body of three rows of 32 bytes.
    type Alignment = Aligned32;
    /// A disc of 16 + 32 bytes in a cache line.
    type PlanarAlignment = Aligned64;
    type RowAlignment = Aligned32;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
}

impl Number for f32 {
    const GROUP: usize = 16;
    const AT_BOUND: f64 = 1e-6;
    const NAME: &'static str = "mixed+";
    const TORQUE: usize = 4;
    /// A body of 32 + 16 + 16 bytes.
    type Alignment = Aligned64;
    /// A disc of 16 + 16 bytes.
    type PlanarAlignment = Aligned32;
    type RowAlignment = Aligned16;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }
}

/// A bundle of numbers that a law is evaluated for at once.
pub trait Lane: Copy {
    /// What it bundles.
    type Scalar: Number;
    /// Result of a comparison, one truth value per number.
    type Mask: Copy;
    /// Numbers in the bundle: a divisor of [`Number::GROUP`].
    const WIDTH: usize;

    /// The nearest number, everywhere.
    fn splat(value: f64) -> Self;
    /// self + other.
    fn add(self, other: Self) -> Self;
    /// self − other.
    fn sub(self, other: Self) -> Self;
    /// self · other.
    fn mul(self, other: Self) -> Self;
    /// self / other.
    fn div(self, other: Self) -> Self;
    /// self · factor + addend, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// addend − self · factor, rounded once.
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self;
    /// √self.
    fn sqrt(self) -> Self;
    /// |self|.
    fn abs(self) -> Self;
    /// The larger one; `other` when either is NaN.
    fn max(self, other: Self) -> Self;
    /// The smaller one; `other` when either is NaN.
    fn min(self, other: Self) -> Self;
    /// self < other.
    fn less(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The value where the mask holds, else +0.
    fn keep(self, mask: Self::Mask) -> Self;
    /// Both masks.
    fn both(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether the mask holds anywhere.
    fn any(mask: Self::Mask) -> bool;
    /// A mask that holds for the first `count` numbers.
    #[inline(always)]
    fn first(count: usize) -> Self::Mask {
        let mut places = [Self::Scalar::default(); WIDEST];
        for (lane, place) in places.iter_mut().enumerate() {
            *place = Self::Scalar::of(lane as f64);
        }
        // SAFETY: no bundle is wider.
        unsafe { Self::load(places.as_ptr()) }.less(Self::splat(count as f64))
    }

    /// Reads `WIDTH` numbers.
    ///
    /// # Safety
    /// `from` points to `WIDTH` readable numbers.
    unsafe fn load(from: *const Self::Scalar) -> Self;
    /// Writes `WIDTH` numbers.
    ///
    /// # Safety
    /// `to` points to `WIDTH` writable numbers.
    unsafe fn store(self, to: *mut Self::Scalar);
}
