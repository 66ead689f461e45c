//! The embedding space: vectors and spins of discs in the plane and spheres in space.

mod planar;
mod spatial;
mod vector;

pub use planar::Planar;
pub use spatial::Spatial;
pub use vector::{V1, V2, V3, Vector};

use crate::lane::Lane;

/// Dimension, vectors and rotations. Records in memory always have three components; a planar system leaves the
/// third one of positions and the first two of spins at zero and never computes with them.
pub trait Space: Copy + Send + Sync + 'static {
    /// Dimension.
    const DIMENSION: usize;
    /// A displacement, velocity or force.
    type Vector<L: Lane>: Vector<L>;
    /// An angular velocity or torque: one number in the plane.
    type Spin<L: Lane>: Vector<L>;

    /// The vector of a record.
    fn vector<L: Lane>(record: [L; 3]) -> Self::Vector<L>;
    /// The record of a vector.
    fn vector_record<L: Lane>(vector: Self::Vector<L>) -> [L; 3];
    /// The spin of a record.
    fn spin<L: Lane>(record: [L; 3]) -> Self::Spin<L>;
    /// The record of a spin.
    fn spin_record<L: Lane>(spin: Self::Spin<L>) -> [L; 3];
    /// ω × r: velocity of a point of a rotating body.
    fn spin_cross<L: Lane>(spin: Self::Spin<L>, arm: Self::Vector<L>) -> Self::Vector<L>;
    /// r × F.
    fn moment<L: Lane>(arm: Self::Vector<L>, force: Self::Vector<L>) -> Self::Spin<L>;
    /// Angle by which a contact turns about its normal in a step, (ω·n) dt; zero in the plane, where no spin does that.
    fn turn<L: Lane>(normal: Self::Vector<L>, spin: Self::Spin<L>, dt: L) -> L;
    /// Turns a tangential vector about the contact normal by an angle, exact to second order; in the plane there is
    /// no such turn.
    fn twist<L: Lane>(tangent: Self::Vector<L>, normal: Self::Vector<L>, angle: L) -> Self::Vector<L>;
}
