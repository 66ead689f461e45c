//! What the kernel does with the records of bodies and forces.

use super::{Number, Plane};
use crate::state::{Body, Force};

/// A number that is its own bundle: the plain path.
pub trait Real: Number + Gather<Scalar = Self, Mask = bool, Wide = f64> {
    /// The bundle that fills a register of AVX2, where machines have that.
    type Fast: Gather<Scalar = Self>;
    /// The bundle that fills a register of AVX-512, where machines have that.
    type Fastest: Gather<Scalar = Self>;
}

/// A bundle that can be read from bodies and added to forces.
pub trait Gather: Plane {
    /// Numbers at scattered places of a table.
    ///
    /// # Safety
    /// `at` points to `WIDTH` indices inside the table.
    unsafe fn gather(table: *const f64, at: *const u32) -> Self;

    /// Difference of the positions of two bodies, `b − a`.
    ///
    /// # Safety
    /// `a` and `b` point to `WIDTH` indices below the number of bodies.
    unsafe fn separation(bodies: *const Body<Self::Scalar>, a: *const u32, b: *const u32) -> [Self::Wide; 3];
    /// Positions of bodies.
    ///
    /// # Safety
    /// As for [`Gather::separation`].
    unsafe fn position(bodies: *const Body<Self::Scalar>, a: *const u32) -> [Self::Wide; 3];
    /// Difference of one record of two bodies, `b − a`, component by component (the fourth one is dropped).
    ///
    /// # Safety
    /// As for [`Gather::separation`]; `FIELD` is 1 (velocity) or 2 (spin).
    unsafe fn difference<const FIELD: usize>(
        bodies: *const Body<Self::Scalar>,
        a: *const u32,
        b: *const u32,
    ) -> [Self; 3];
    /// Difference of velocities, `b − a`, and sum of spins.
    ///
    /// # Safety
    /// As for [`Gather::separation`].
    unsafe fn motion(bodies: *const Body<Self::Scalar>, a: *const u32, b: *const u32) -> [[Self; 3]; 2];
    /// One record of one body.
    ///
    /// # Safety
    /// As for [`Gather::difference`].
    unsafe fn record<const FIELD: usize>(bodies: *const Body<Self::Scalar>, a: *const u32) -> [Self; 3];
    /// Adds to the first row of forces, lane after lane.
    ///
    /// # Safety
    /// `at` points to `WIDTH` indices of writable forces.
    unsafe fn scatter(forces: *mut Force<Self::Scalar>, at: *const u32, value: [Self; 3]);
    /// Adds `value` to the first row of the forces of `a` and, lane after lane, subtracts it from that of `b`.
    ///
    /// # Safety
    /// `a` and `b` point to `WIDTH` indices of writable forces in `of_a` and `of_b`.
    unsafe fn scatter_pair(
        of_a: *mut Force<Self::Scalar>,
        a: *const u32,
        of_b: *mut Force<Self::Scalar>,
        b: *const u32,
        value: [Self; 3],
    );
    /// Both records of a pair in one go, lane after lane: adds `force` and `torque_a` to the forces of `a`, subtracts
    /// `force` from those of `b` and adds to them `torque_a` (`MODE` [`SAME`]) or `torque_b` ([`OTHER`]).
    ///
    /// # Safety
    /// As for [`Gather::scatter_pair`].
    unsafe fn scatter_contact<const MODE: u8>(
        of_a: *mut Force<Self::Scalar>,
        a: *const u32,
        of_b: *mut Force<Self::Scalar>,
        b: *const u32,
        force: [Self; 3],
        torque_a: [Self; 3],
        torque_b: [Self; 3],
    );
    /// Adds force and torque to the forces of `at`.
    ///
    /// # Safety
    /// As for [`Gather::scatter`].
    unsafe fn scatter_both(
        forces: *mut Force<Self::Scalar>,
        at: *const u32,
        force: [Self; 3],
        torque: [Self; 3],
    );
}

/// No torques; see [`crate::space::Space::scatter_pair`].
pub const NONE: u8 = 0;
/// See [`Gather::scatter_contact`].
pub const SAME: u8 = 1;
/// See [`Gather::scatter_contact`].
pub const OTHER: u8 = 2;
