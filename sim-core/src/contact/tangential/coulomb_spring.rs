//! Incremental tangential spring with Coulomb limit (paper 2024, eq. 7; discs 2008, Table I).
//!
//! The spring ξ is the tangential displacement of b against a since the contact closed; the force on a is k_t ξ, which is what
//! is remembered. Per step: ξ grows by the slip, follows the contact as it turns (about its tangents with the normal, about the
//! normal with the mean spin of the bodies: a rigidly rotating pair keeps its spring exactly, to second order), and the force is
//! cut back to μ f_e, the elastic part of the normal force alone.

use super::Tangential;
use crate::lane::{Lane, Real};
use crate::space::{Spatial, SpatialSlide, V3, Vector, cross, sub_dot};

/// Spring k_t, limit μ f_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoulombSpring {
    /// k_t [k_n].
    pub kt: f64,
    /// μ [1].
    pub mu: f64,
}

impl CoulombSpring {
    /// Where a force exceeds μ f_e.
    #[inline(always)]
    fn slides<L: Lane>(&self, force: V3<L>, elastic: L) -> L::Mask {
        let bound = L::splat(self.mu).mul(elastic);
        bound.mul(bound).less(force.dot(force))
    }
}

impl<R: Real> Tangential<Spatial<R>> for CoulombSpring {
    const SLOTS: usize = 3;
    const NEEDS_SPIN: bool = true;
    const BOUNDED: bool = true;
    const REVERSES: bool = true;
    const NAME: &'static str = "+coulomb";

    #[inline(always)]
    unsafe fn stretch<L: Lane>(
        &self,
        normal: V3<L>,
        slide: &SpatialSlide<L>,
        approach: L,
        elastic: L,
        active: L::Mask,
        dt: L,
        memory: *mut L::Scalar,
    ) -> (V3<L>, L::Mask) {
        let SpatialSlide { between, normal_between, turn } = *slide;
        // SAFETY: the caller vouches for the slots.
        let old: V3<L> = unsafe { V3::load(memory) };
        let growth = L::splat(self.kt).mul(dt);
        // Turned about the normal by θ, exact to second order, (1 − θ²/2) f + θ n × f; grown by the slip, v + u n' with the normal n'
        // half a step ago; and the normal turned by dn since: f loses its part along the new normal and gains half of it along
        // dn, together that part times n'. What this leaves along n is of second order, and lost in the next step.
        let along = sub_dot(growth.mul(approach), normal, old);
        let cosine = L::splat(0.5).mul(turn).neg_mul_add(turn, L::splat(1.0));
        let turned = old.scale(cosine).add_scaled(turn, cross(normal, old));
        let force = turned.add_scaled(growth, between).add_scaled(along, normal_between);
        // An open contact has no spring, so it cannot slide either.
        let force = force.keep(active);
        // SAFETY: as above.
        unsafe { force.store(memory) };
        (force, self.slides(force, elastic))
    }

    #[inline(always)]
    unsafe fn limit<L: Lane>(&self, elastic: L, memory: *mut L::Scalar) {
        // SAFETY: the caller vouches for the slots.
        unsafe {
            let force: V3<L> = V3::load(memory);
            let bound = L::splat(self.mu).mul(elastic);
            let shrink = bound.div(force.dot(force).sqrt());
            let shrink = L::select(self.slides(force, elastic), shrink, L::splat(1.0));
            force.scale(shrink).store(memory);
        }
    }

    #[inline(always)]
    unsafe fn held<L: Lane>(&self, memory: *const L::Scalar) -> V3<L> {
        // SAFETY: the caller vouches for the slots.
        unsafe { V3::load(memory) }
    }

    fn stiffness(&self) -> f64 {
        self.kt
    }
    fn bound(&self, elastic: f64) -> f64 {
        self.mu * elastic
    }
}
