//! What the kernel does with the records of discs.

use super::Lane;
use crate::state::{PlanarBody, PlanarForce};

/// A bundle with one of as many `f64` beside it.
pub trait Widen: Lane {
    /// As many `f64`.
    type Wide: Lane<Scalar = f64>;

    /// The nearest numbers.
    fn narrow(wide: Self::Wide) -> Self;
    /// The same numbers.
    fn widen(self) -> Self::Wide;
    /// What [`Widen::meet`] wants to know of the `square` of the distance of bodies with these radii.
    fn gauge(square: Self::Wide, radius_a: Self, radius_b: Self) -> [Self; 2];
    /// Overlap and 1/distance of bodies with these radii, from their gauge; exact to rounding whatever the overlap.
    fn meet(gauge: [Self; 2], radius_a: Self, radius_b: Self) -> [Self; 2];
}

/// A bundle that can be read from discs and added to their forces.
pub trait Plane: Widen {
    /// Differences of the positions and of the velocities of two discs, `b − a`.
    ///
    /// # Safety
    /// `a` and `b` point to `WIDTH` indices below the number of bodies.
    unsafe fn discs_apart(
        bodies: *const PlanarBody<Self::Scalar>,
        a: *const u32,
        b: *const u32,
    ) -> ([Self::Wide; 2], [Self; 2]);
    /// Spins of discs.
    ///
    /// # Safety
    /// As for [`Plane::discs_apart`].
    unsafe fn disc_spins(bodies: *const PlanarBody<Self::Scalar>, at: *const u32) -> Self;
    /// Lane after lane, adds `force` and `torque_a` to the forces of `a`, `−force` and `torque_b` to those of `b`.
    ///
    /// # Safety
    /// `a` and `b` point to `WIDTH` indices of writable forces in `of_a` and `of_b`.
    unsafe fn scatter_discs(
        of_a: *mut PlanarForce<Self::Scalar>,
        a: *const u32,
        of_b: *mut PlanarForce<Self::Scalar>,
        b: *const u32,
        force: [Self; 2],
        torque_a: Self,
        torque_b: Self,
    );
}
