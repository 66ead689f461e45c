//! The embedding space: vectors and spins of discs in the plane and spheres in space.

mod planar;
mod spatial;
mod vector;

pub use planar::Planar;
pub use spatial::{Spatial, SpatialSlide, cross, sub_dot};
pub use vector::{V1, V2, V3, Vector};

use crate::lane::{Gather, Lane, Real};
use crate::state::{Gain, Kinematics};

/// What two bodies do past each other: what [`Space::slide`] needs.
#[derive(Clone, Copy)]
pub struct Passing<S: Space, L: Lane> {
    /// Unit vector from a to b at t_n.
    pub normal: S::Vector<L>,
    /// Velocity of b minus that of a at t_n − dt/2 [d/τ].
    pub velocity: S::Vector<L>,
    /// Their approach [d/τ].
    pub approach: L,
    /// Their motion across the normal.
    pub across: S::Across<L>,
    /// ω_a + ω_b [1/τ].
    pub spin_sum: S::Spin<L>,
    /// dt/2 [τ].
    pub half_dt: L,
}

/// Dimension, vectors and rotations, and how bodies and forces lie in memory. Where three components are handed over, a planar
/// system leaves the third one of positions and the first two of spins at zero and never computes with them.
pub trait Space: Copy + Send + Sync + 'static {
    /// What velocities, forces and memories of contacts are kept in.
    type Real: Real;
    /// Dimension.
    const DIMENSION: usize;
    /// Whether root and quotient of a distance are left to the second part of a contact. The first one waits for bodies, which
    /// has more of them on their way then; where the second part is long enough by itself, that is no gain.
    const LATE_ROOTS: bool;
    /// A displacement, velocity or force.
    type Vector<L: Lane>: Vector<L>;
    /// An angular velocity or torque: one number in the plane.
    type Spin<L: Lane>: Vector<L>;
    /// Motion across the normal.
    type Across<L: Lane>: Copy;
    /// How the points of a contact slide past each other, at t_n − dt/2.
    type Slide<L: Lane>: Copy;
    /// A tangential force: a vector in space, in the plane the number along t = (−n_y, n_x).
    type Shear<L: Lane>: Vector<L>;

    /// The vector of a record.
    fn vector<L: Lane>(record: [L; 3]) -> Self::Vector<L>;
    /// The record of a vector.
    fn vector_record<L: Lane>(vector: Self::Vector<L>) -> [L; 3];
    /// The spin of a record.
    fn spin<L: Lane>(record: [L; 3]) -> Self::Spin<L>;
    /// The record of a spin.
    fn spin_record<L: Lane>(spin: Self::Spin<L>) -> [L; 3];
    /// Approach u = −v·(n − (dt/2) dn/dt) of two bodies, and how they move across their normal. Velocities are those of
    /// t_n − dt/2, so the normal is taken there too.
    fn approach<L: Lane>(
        normal: Self::Vector<L>,
        velocity: Self::Vector<L>,
        inverse_distance: L,
        half_dt: L,
    ) -> (L, Self::Across<L>);
    /// How the contact points slide past each other, with `rim` the sum of lever arm times spin.
    fn slide<L: Lane>(passing: &Passing<Self, L>, rim: Self::Spin<L>) -> Self::Slide<L>;
    /// Force on a: tangential force less the normal force along the normal.
    fn contact_force<L: Lane>(normal: Self::Vector<L>, push: L, shear: Self::Shear<L>) -> Self::Vector<L>;
    /// Moment of a tangential force at unit distance along the normal.
    fn couple<L: Lane>(normal: Self::Vector<L>, shear: Self::Shear<L>) -> Self::Spin<L>;
    /// A moment cut to a bound ≥ 0.
    fn limit_moment<L: Lane>(moment: Self::Spin<L>, bound: L) -> Self::Spin<L>;
    /// A tangential force as a vector.
    fn shear_vector<L: Lane>(normal: Self::Vector<L>, shear: Self::Shear<L>) -> Self::Vector<L>;

    /// Record of a body.
    type Body: Kinematics;
    /// Record of the force on a body.
    type Force: Gain;

    /// Difference of the positions of bodies, b − a.
    ///
    /// # Safety
    /// `a` and `b` point to `L::WIDTH` indices of bodies; so below.
    unsafe fn separation<L: Gather<Scalar = Self::Real>>(
        bodies: *const Self::Body,
        a: *const u32,
        b: *const u32,
    ) -> Self::Vector<L::Wide>;
    /// Difference of their velocities, b − a.
    ///
    /// # Safety
    /// See [`Space::separation`].
    unsafe fn velocity<L: Gather<Scalar = Self::Real>>(
        bodies: *const Self::Body,
        a: *const u32,
        b: *const u32,
    ) -> Self::Vector<L>;
    /// The same and ω_a + ω_b.
    ///
    /// # Safety
    /// See [`Space::separation`].
    unsafe fn motion<L: Gather<Scalar = Self::Real>>(
        bodies: *const Self::Body,
        a: *const u32,
        b: *const u32,
    ) -> (Self::Vector<L>, Self::Spin<L>);
    /// Spins of bodies.
    ///
    /// # Safety
    /// See [`Space::separation`].
    unsafe fn spins<L: Gather<Scalar = Self::Real>>(
        bodies: *const Self::Body,
        at: *const u32,
    ) -> Self::Spin<L>;
    /// Positions and velocities of bodies.
    ///
    /// # Safety
    /// See [`Space::separation`].
    unsafe fn places<L: Gather<Scalar = Self::Real>>(
        bodies: *const Self::Body,
        at: *const u32,
    ) -> ([L::Wide; 3], [L; 3]);
    /// Adds to the forces of `at`, lane after lane; torques where `SPIN`.
    ///
    /// # Safety
    /// `at` points to `L::WIDTH` indices of writable forces.
    unsafe fn scatter<L: Gather<Scalar = Self::Real>, const SPIN: bool>(
        forces: *mut Self::Force,
        at: *const u32,
        force: Self::Vector<L>,
        torque: Self::Spin<L>,
    );
    /// Adds to the forces of pairs, lane after lane: `force` and a torque to those of `a`, its opposite and a torque to those of
    /// `b`. There are no torques ([`NONE`](crate::lane::NONE)), the first for both ([`SAME`](crate::lane::SAME)) or one for each
    /// ([`OTHER`](crate::lane::OTHER)).
    ///
    /// # Safety
    /// `a` and `b` point to `L::WIDTH` indices of writable forces in `of_a` and `of_b`.
    unsafe fn scatter_pair<L: Gather<Scalar = Self::Real>, const TORQUES: u8>(
        of_a: *mut Self::Force,
        a: *const u32,
        of_b: *mut Self::Force,
        b: *const u32,
        force: Self::Vector<L>,
        torques: [Self::Spin<L>; 2],
    );
}
