//! Contact laws: a law is put together from named slots (normal, damping, attraction, tangential, rolling), each
//! with a null type that costs nothing.
//!
//! Sign conventions: the normal n points from body a to body b; the overlap ov = −δ_n is positive in contact; the
//! approach u = d(ov)/dt; a repulsive normal force is positive. The tangential force is the one on a.

pub mod attraction;
pub mod damping;
mod law;
pub mod normal;
pub mod rolling;
pub mod tangential;

pub use law::{ContactLaw, Law, Stiffness};

use std::mem::MaybeUninit;

use crate::lane::Lane;
use crate::space::Space;

/// Where two bodies are, at t_n.
#[derive(Clone, Copy)]
pub struct PairGeometry<S: Space, L: Lane> {
    /// Unit vector from a to b.
    pub normal: S::Vector<L>,
    /// ov [d].
    pub overlap: L,
    /// 1/distance of the centres; zero for a wall, whose normal does not turn [1/d].
    pub inverse_distance: L,
    /// Radius of a [d].
    pub radius_a: L,
    /// Radius of b; zero for a wall [d].
    pub radius_b: L,
    /// √ of the mass in the dashpot [√m].
    pub root_mass: L,
}

/// How they moved, at t_n − dt/2.
#[derive(Clone, Copy)]
pub struct PairMotion<S: Space, L: Lane> {
    /// Velocity of b minus velocity of a [d/τ].
    pub velocity: S::Vector<L>,
    /// R_a ω_a + R_b ω_b [d/τ]; `None` where one radius belongs to all of `spin_sum`: equal particles, a wall.
    pub rim: Option<S::Spin<L>>,
    /// ω_a + ω_b (b: none for a wall) [1/τ].
    pub spin_sum: S::Spin<L>,
    /// ω_b − ω_a [1/τ].
    pub spin_difference: S::Spin<L>,
}

/// What a law makes of geometry and motion before it looks at the memory of the contact.
#[derive(Clone, Copy)]
pub struct Encounter<S: Space, L: Lane> {
    /// u = d(ov)/dt at t_n − dt/2 [d/τ].
    pub approach: L,
    /// Part of the step in which the contact is closed [1].
    pub share: L,
    /// How the contact points slide past each other; not written by a law without spins.
    pub slide: MaybeUninit<S::Slide<L>>,
}

/// Forces of one contact.
#[derive(Clone, Copy)]
pub struct Response<S: Space, L: Lane> {
    /// Normal force, all parts, positive when it pushes apart [k_n d].
    pub normal: L,
    /// Elastic part, ≥ 0 [k_n d].
    pub elastic: L,
    /// Attraction, ≥ 0 [k_n d].
    pub attraction: L,
    /// Viscous part [k_n d].
    pub viscous: L,
    /// Tangential force on a [k_n d].
    pub tangential: S::Shear<L>,
    /// Rolling moment on a [k_n d²].
    pub rolling: S::Spin<L>,
}
