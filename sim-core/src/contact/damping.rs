//! Dissipation along the normal.

mod lagged;
mod none;
mod viscous;

pub use lagged::Lagged;
pub use none::NoDamping;
pub use viscous::{Viscous, damping_ratio};

use crate::lane::Lane;

/// A normal dashpot.
pub trait Damping: Copy + Send + Sync + 'static {
    /// Slots of contact memory.
    const SLOTS: usize;
    /// Whether the force jumps when a contact opens or closes.
    const JUMPS: bool;
    /// Part of the kernel name.
    const NAME: &'static str;

    /// Viscous force, positive when it pushes apart. `share` is the part of the step in which the contact is closed,
    /// `active` its being above zero.
    ///
    /// # Safety
    /// `memory` points to [`Damping::SLOTS`] slots of a group at the first lane.
    unsafe fn viscous<L: Lane>(
        &self,
        approach: L,
        root_mass: L,
        share: L,
        active: L::Mask,
        memory: *mut L::Scalar,
    ) -> L;
    /// Elastic and viscous force together.
    fn repulsion<L: Lane>(&self, elastic: L, viscous: L) -> L;
    /// Value of the memory of an open contact.
    fn vacant() -> f64;
    /// Dashpot coefficient over √mass, for the time step [√(k_n m)].
    fn coefficient(&self) -> f64;
}
