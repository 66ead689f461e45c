//! Friction.

mod coulomb_spring;
mod frictionless;

pub use coulomb_spring::CoulombSpring;
pub use frictionless::Frictionless;

use crate::lane::Lane;
use crate::space::Space;

/// Kinematics a tangential law may use, at t_n − dt/2.
#[derive(Clone, Copy)]
pub struct Tangent<S: Space, L: Lane> {
    /// Velocity of the contact point of b minus that of a, without its normal part [d/τ].
    pub slip: S::Vector<L>,
    /// dn/dt: rate at which the normal turns [1/τ].
    pub normal_rate: S::Vector<L>,
    /// (ω·n) dt with the mean spin of the two bodies: angle by which the contact turns about its normal [1].
    pub turn: L,
}

/// A tangential law.
pub trait Tangential<S: Space>: Copy + Send + Sync + 'static {
    /// Slots of contact memory.
    const SLOTS: usize;
    /// Whether spins and torques exist.
    const NEEDS_SPIN: bool;
    /// Part of the kernel name.
    const NAME: &'static str;

    /// Tangential force on a of a contact with this `normal`, with `elastic` the elastic normal force and `active`
    /// whether the contact is closed.
    ///
    /// # Safety
    /// `memory` points to [`Tangential::SLOTS`] slots of a group at the first lane.
    unsafe fn force<L: Lane>(
        &self,
        normal: S::Vector<L>,
        tangent: &Tangent<S, L>,
        elastic: L,
        active: L::Mask,
        dt: L,
        memory: *mut f64,
    ) -> S::Vector<L>;
    /// k_t, for the time step [k_n].
    fn stiffness(&self) -> f64;
    /// Coulomb bound for an elastic normal force [k_n d]; infinite without a bound, zero without friction.
    fn bound(&self, elastic: f64) -> f64;
}
