//! Lanes: the number type the laws are written in, once.
//!
//! A [`Lane`] is one `f64` (oracle, observation, machines without AVX2) or four (the kernel). Every operation is a
//! single IEEE operation with the same operands in both, so a trajectory has the same bits on either path. Fused
//! multiply-add is explicit ([`Lane::mul_add`]) and used at the same places by construction.
//!
//! Contact memory is stored in groups of [`GROUP`] contacts: slot k of lane l lies at `k * GROUP + l`.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod scalar;

#[cfg(target_arch = "x86_64")]
pub use avx2::Avx2;

use crate::state::{Body, Force};

/// Contacts in one group: the width of the widest lane type.
pub const GROUP: usize = 4;

/// A bundle of numbers that a law is evaluated for at once.
pub trait Lane: Copy {
    /// Result of a comparison, one truth value per number.
    type Mask: Copy;
    /// Numbers in the bundle: 1 or [`GROUP`].
    const WIDTH: usize;

    /// The same number everywhere.
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

    /// Reads `WIDTH` numbers.
    ///
    /// # Safety
    /// `from` points to `WIDTH` readable numbers.
    unsafe fn load(from: *const f64) -> Self;
    /// Writes `WIDTH` numbers.
    ///
    /// # Safety
    /// `to` points to `WIDTH` writable numbers.
    unsafe fn store(self, to: *mut f64);

    /// Reads `WIDTH` numbers at scattered places of a table.
    ///
    /// # Safety
    /// `at` points to `WIDTH` indices inside the table.
    unsafe fn gather(table: *const f64, at: *const u32) -> Self;

    /// Difference of one record of two bodies, `b − a`, component by component (the fourth one is dropped).
    ///
    /// # Safety
    /// `a` and `b` point to `WIDTH` indices below the number of bodies; `FIELD` is 0 (position), 1 (velocity) or
    /// 2 (spin).
    unsafe fn difference<const FIELD: usize>(bodies: *const Body, a: *const u32, b: *const u32) -> [Self; 3];
    /// Sum of one record of two bodies, `a + b`.
    ///
    /// # Safety
    /// As for [`Lane::difference`].
    unsafe fn sum<const FIELD: usize>(bodies: *const Body, a: *const u32, b: *const u32) -> [Self; 3];
    /// One record of one body.
    ///
    /// # Safety
    /// As for [`Lane::difference`].
    unsafe fn record<const FIELD: usize>(bodies: *const Body, a: *const u32) -> [Self; 3];
    /// Adds to one record of a force, lane after lane: `FIELD` 0 is the force, 1 the torque.
    ///
    /// # Safety
    /// `at` points to `WIDTH` indices of writable forces.
    unsafe fn scatter<const FIELD: usize>(forces: *mut Force, at: *const u32, value: [Self; 3]);
    /// Adds `value` to the force (`FIELD` 0) or torque (1) of `a` and, lane after lane, subtracts it from that of `b`
    /// (`MODE` [`OPPOSITE`]), adds it ([`SAME`]), adds `other` ([`OTHER`]) or subtracts `other` ([`MINUS`]).
    ///
    /// # Safety
    /// `a` and `b` point to `WIDTH` indices of writable forces in `of_a` and `of_b`.
    unsafe fn scatter_pair<const FIELD: usize, const MODE: u8>(
        of_a: *mut Force,
        a: *const u32,
        of_b: *mut Force,
        b: *const u32,
        value: [Self; 3],
        other: [Self; 3],
    );
    /// Both records of a pair in one go, lane after lane: adds `force` and `torque_a` to the forces of `a`, subtracts
    /// `force` from those of `b` and adds to them `torque_a` (`MODE` [`SAME`]) or `torque_b` ([`OTHER`]).
    ///
    /// # Safety
    /// As for [`Lane::scatter_pair`].
    unsafe fn scatter_contact<const MODE: u8>(
        of_a: *mut Force,
        a: *const u32,
        of_b: *mut Force,
        b: *const u32,
        force: [Self; 3],
        torque_a: [Self; 3],
        torque_b: [Self; 3],
    );
}

/// See [`Lane::scatter_pair`].
pub const OPPOSITE: u8 = 0;
/// See [`Lane::scatter_pair`].
pub const SAME: u8 = 1;
/// See [`Lane::scatter_pair`].
pub const OTHER: u8 = 2;
/// See [`Lane::scatter_pair`].
pub const MINUS: u8 = 3;
