//! Incremental tangential spring with Coulomb limit (paper 2024, eq. 7; discs 2008, Table I).
//!
//! The spring ξ is the tangential displacement of b against a since the contact closed; the force on a is k_t ξ.
//! Per step: ξ grows by the slip, follows the contact as it turns (about its tangents with the normal, about the
//! normal with the mean spin of the bodies: a rigidly rotating pair keeps its spring exactly, to second order), is
//! projected on the tangent plane, and is cut back to |k_t ξ| = μ f_e, the elastic part of the normal force alone.

use super::Tangential;
use crate::lane::{Lane, Real};
use crate::space::{Spatial, SpatialSlide, V3, Vector, twist};

/// Spring k_t, limit μ f_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoulombSpring {
    /// k_t [k_n].
    pub kt: f64,
    /// μ [1].
    pub mu: f64,
}

impl CoulombSpring {
    /// Where a tangential force exceeds μ f_e.
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
        elastic: L,
        active: L::Mask,
        dt: L,
        memory: *mut L::Scalar,
    ) -> (V3<L>, L::Mask) {
        // SAFETY: the caller vouches for the slots.
        let old: V3<L> = unsafe { V3::load(memory) };
        let turned = twist(old, normal, slide.turn);
        let grown = turned.add_scaled(dt, slide.slip);
        // The normal turned by dn: ξ loses its part along the new normal and gains half of it along dn.
        let along = grown.dot(normal);
        let half_turn = along.mul(dt.mul(L::splat(0.5)));
        let spring = grown.sub_scaled(along, normal).add_scaled(half_turn, slide.normal_rate);
        // An open contact has no spring, so it cannot slide either.
        let spring = spring.keep(active);
        // SAFETY: as above.
        unsafe { spring.store(memory) };
        let force = spring.scale(L::splat(self.kt));
        (force, self.slides(force, elastic))
    }

    #[inline(always)]
    unsafe fn limit<L: Lane>(&self, force: V3<L>, elastic: L, memory: *mut L::Scalar) -> V3<L> {
        let bound = L::splat(self.mu).mul(elastic);
        let length = force.dot(force).sqrt();
        let shrink = L::select(self.slides(force, elastic), bound.div(length), L::splat(1.0));
        // SAFETY: the caller vouches for the slots.
        unsafe {
            let spring: V3<L> = V3::load(memory);
            spring.scale(shrink).store(memory);
        }
        force.scale(shrink)
    }

    fn stiffness(&self) -> f64 {
        self.kt
    }
    fn bound(&self, elastic: f64) -> f64 {
        self.mu * elastic
    }
}
