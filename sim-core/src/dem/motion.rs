//! Motion of the particles of a chunk: v(t+dt/2) = v(t−dt/2) + dt a(t), x(t+dt) = x(t) + dt v(t+dt/2), the velocity
//! Verlet scheme with velocities kept at half steps; one fused pass that also clears the forces.

mod planar;
mod spatial;

use super::kernel::Path;
use crate::lane::Real;
use crate::space::{Planar, Space, Spatial};
use crate::state::{Body, Force, Grains, PlanarBody, PlanarForce};

/// Rates of drag by slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DragRates<'a> {
    /// None.
    None,
    /// The same for all [1/τ].
    All(f64),
    /// By slot [1/τ].
    Each(&'a [f64]),
}

impl DragRates<'_> {
    /// Rate of a slot [1/τ].
    pub fn of(self, slot: usize) -> f64 {
        match self {
            Self::None => 0.0,
            Self::All(rate) => rate,
            Self::Each(rates) => rates[slot],
        }
    }
}

/// What moves particles in one step beside contact forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformation<'a, T> {
    /// Strain rates at t_n + dt/2, in the plane [1/τ].
    pub rate: [f64; 3],
    /// Coefficient c of the local damping: every component of force and torque counts 1 − c sign(F v), in the plane [1].
    pub local_damping: f64,
    /// Drag on velocities relative to the deformation, and on spins.
    pub drag: DragRates<'a>,
    /// dt/m, dt/m, dt/I, 0 of every particle of the chunk, in the plane.
    pub gains: &'a [[T; 4]],
}

/// A space whose bodies can be moved.
pub trait Moves: Space {
    /// Moves the bodies of a chunk (`first` is the slot of the first one) and clears their forces; returns the largest
    /// |v component| over displacement budget [1/τ].
    ///
    /// # Safety
    /// `path` was chosen by [`Path::choose`] on this machine.
    unsafe fn advance<G: Grains, const SPIN: bool>(
        path: Path,
        bodies: &mut [Self::Body],
        forces: &mut [Self::Force],
        first: usize,
        grains: &G,
        deformation: Deformation<'_, Self::Real>,
        dt: f64,
    ) -> f64;
}

impl<R: Real> Moves for Spatial<R> {
    unsafe fn advance<G: Grains, const SPIN: bool>(
        path: Path,
        bodies: &mut [Body<R>],
        forces: &mut [Force<R>],
        first: usize,
        grains: &G,
        deformation: Deformation<'_, R>,
        dt: f64,
    ) -> f64 {
        // SAFETY: the caller vouches.
        unsafe { spatial::advance::<R, G, SPIN>(path, bodies, forces, first, grains, deformation.drag, dt) }
    }
}

impl<R: Real> Moves for Planar<R> {
    unsafe fn advance<G: Grains, const SPIN: bool>(
        path: Path,
        bodies: &mut [PlanarBody<R>],
        forces: &mut [PlanarForce<R>],
        first: usize,
        _: &G,
        deformation: Deformation<'_, R>,
        dt: f64,
    ) -> f64 {
        // SAFETY: the caller vouches.
        unsafe { planar::advance(path, bodies, forces, first, deformation, dt) }
    }
}
