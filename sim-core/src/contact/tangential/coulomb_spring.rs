//! Incremental tangential spring with Coulomb limit (paper 2024, eq. 7; discs 2008, Table I).
//!
//! The spring ξ is the tangential displacement of b against a since the contact closed; the force on a is k_t ξ.
//! Per step: ξ grows by the slip, follows the contact as it turns (about its tangents with the normal, about the
//! normal with the mean spin of the bodies: a rigidly rotating pair keeps its spring exactly, to second order), is
//! projected on the tangent plane, and is cut back to |k_t ξ| = μ f_e, the elastic part of the normal force alone.

use super::Tangential;
use crate::lane::{Lane, Real};
use crate::space::{Spatial, SpatialSlide, V3, Vector, cross};

/// Spring k_t, limit μ f_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoulombSpring {
    /// k_t [k_n].
    pub kt: f64,
    /// μ [1].
    pub mu: f64,
}

impl CoulombSpring {
    /// Where the force of a spring exceeds μ f_e.
    #[inline(always)]
    fn slides<L: Lane>(&self, spring: V3<L>, elastic: L) -> L::Mask {
        let bound = L::splat(self.mu).mul(elastic);
        bound.mul(bound).less(L::splat(self.kt * self.kt).mul(spring.dot(spring)))
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
        // Turned about the normal by θ, exact to second order: (1 − θ²/2) ξ + θ n × ξ, and grown by the slip.
        let (turn, one) = (slide.turn, L::splat(1.0));
        let cosine = L::splat(0.5).mul(turn).neg_mul_add(turn, one);
        let turned = old.scale(cosine).add_scaled(turn, cross(normal, old));
        let grown = turned.add_scaled(dt, slide.slip);
        // The normal turned by dn: ξ loses its part along the new normal and gains half of it along dn, together its part
        // along the normal times the normal between the two. That part is worked out beside `grown`, not after it.
        let along = cosine.mul_add(old.dot(normal), dt.mul(slide.slip.dot(normal)));
        let spring = grown.sub_scaled(along, slide.normal_between);
        // An open contact has no spring, so it cannot slide either.
        let spring = spring.keep(active);
        // SAFETY: as above.
        unsafe { spring.store(memory) };
        (spring.scale(L::splat(self.kt)), self.slides(spring, elastic))
    }

    #[inline(always)]
    unsafe fn limit<L: Lane>(&self, elastic: L, memory: *mut L::Scalar) {
        // SAFETY: the caller vouches for the slots.
        unsafe {
            let spring: V3<L> = V3::load(memory);
            let bound = L::splat(self.mu).mul(elastic);
            let force = L::splat(self.kt).mul(spring.dot(spring).sqrt());
            let shrink = L::select(self.slides(spring, elastic), bound.div(force), L::splat(1.0));
            spring.scale(shrink).store(memory);
        }
    }

    #[inline(always)]
    unsafe fn held<L: Lane>(&self, memory: *const L::Scalar) -> V3<L> {
        // SAFETY: the caller vouches for the slots.
        let spring: V3<L> = unsafe { V3::load(memory) };
        spring.scale(L::splat(self.kt))
    }

    fn stiffness(&self) -> f64 {
        self.kt
    }
    fn bound(&self, elastic: f64) -> f64 {
        self.mu * elastic
    }
}
