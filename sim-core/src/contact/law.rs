//! A complete law, put together from its slots.

use std::mem::MaybeUninit;

use super::attraction::Attraction;
use super::damping::Damping;
use super::normal::Normal;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{Encounter, PairGeometry, PairMotion, Response};
use crate::lane::{Lane, Number};
use crate::space::{Passing, Space, Vector};

/// Normal, damping, attraction, tangential and rolling law of one kind of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law<N, D, A, T, R> {
    /// Elastic repulsion.
    pub normal: N,
    /// Dashpot.
    pub damping: D,
    /// Attraction.
    pub attraction: A,
    /// Friction.
    pub tangential: T,
    /// Rolling resistance.
    pub rolling: R,
}

/// Stiffnesses and dashpot of a law, for the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Along the normal [k_n].
    pub normal: f64,
    /// Tangential [k_n].
    pub tangential: f64,
    /// Rolling [k_n d²].
    pub rolling: f64,
    /// Dashpot coefficient over √mass [√k_n].
    pub damping: f64,
}

/// What the engine sees of a law.
pub trait ContactLaw<S: Space>: Copy + Send + Sync + 'static {
    /// Slots of memory per contact.
    const SLOTS: usize;
    /// Whether spins and torques exist.
    const NEEDS_SPIN: bool;
    /// Whether there are rolling moments.
    const ROLLS: bool;
    /// Whether [`ContactLaw::stretch`] leaves the bound of friction to [`ContactLaw::limit`].
    const BOUNDED: bool;
    /// Slot of the tangential memory.
    const TANGENTIAL_SLOT: usize;

    /// Largest gap at which the pair interacts [d].
    fn range(&self) -> f64;
    /// How one contact (or one group of them) moves; needs no memory.
    fn encounter<L: Lane>(
        &self,
        geometry: &PairGeometry<S, L>,
        motion: &PairMotion<S, L>,
        dt: L,
    ) -> Encounter<S, L>;
    /// Its forces, updating its memory, without the bound of friction where the law is [`ContactLaw::BOUNDED`]; the mask
    /// says where [`ContactLaw::limit`] must follow.
    ///
    /// # Safety
    /// `memory` points to [`ContactLaw::SLOTS`] slots of a group at the first lane.
    unsafe fn stretch<L: Lane>(
        &self,
        geometry: &PairGeometry<S, L>,
        encounter: &Encounter<S, L>,
        spin_difference: S::Spin<L>,
        dt: L,
        memory: *mut L::Scalar,
    ) -> (Response<S, L>, L::Mask);
    /// Cuts the tangential memory of a contact back to the bound, where its force exceeds it.
    ///
    /// # Safety
    /// As for [`ContactLaw::stretch`].
    unsafe fn limit<L: Lane>(&self, overlap: L, memory: *mut L::Scalar);
    /// The tangential force that a [`ContactLaw::BOUNDED`] law remembers.
    ///
    /// # Safety
    /// As for [`ContactLaw::stretch`].
    unsafe fn held<L: Lane>(&self, memory: *const L::Scalar) -> S::Shear<L>;
    /// Its forces, updating its memory.
    ///
    /// # Safety
    /// As for [`ContactLaw::stretch`].
    #[inline(always)]
    unsafe fn forces<L: Lane>(
        &self,
        geometry: &PairGeometry<S, L>,
        encounter: &Encounter<S, L>,
        spin_difference: S::Spin<L>,
        dt: L,
        memory: *mut L::Scalar,
    ) -> Response<S, L> {
        // SAFETY: the caller vouches for the slots.
        unsafe {
            let (mut response, sliding) = self.stretch(geometry, encounter, spin_difference, dt, memory);
            if Self::BOUNDED && L::any(sliding) {
                self.limit(geometry.overlap, memory);
                response.tangential = self.held(memory);
            }
            response
        }
    }
    /// Memory of an open contact, slot by slot.
    fn vacant(slot: usize) -> f64;
    /// Whether a slot changes sign when the two bodies swap roles.
    fn reverses(slot: usize) -> bool;
    /// For the time step.
    fn stiffness(&self) -> Stiffness;
    /// Elastic normal energy and potential of the attraction [k_n d²].
    fn potential(&self, overlap: f64) -> (f64, f64);
    /// Coulomb bound for an elastic normal force [k_n d].
    fn bound(&self, elastic: f64) -> f64;
    /// Part of the kernel name.
    fn name() -> String;
}

impl<S, N, D, A, T, R> ContactLaw<S> for Law<N, D, A, T, R>
where
    S: Space,
    N: Normal,
    D: Damping,
    A: Attraction,
    T: Tangential<S>,
    R: Rolling<S>,
{
    const SLOTS: usize = D::SLOTS + T::SLOTS + R::SLOTS;
    const NEEDS_SPIN: bool = T::NEEDS_SPIN || R::ROLLS;
    const ROLLS: bool = R::ROLLS;
    const BOUNDED: bool = T::BOUNDED;
    const TANGENTIAL_SLOT: usize = D::SLOTS;

    fn range(&self) -> f64 {
        self.attraction.range()
    }

    #[inline(always)]
    fn encounter<L: Lane>(
        &self,
        geometry: &PairGeometry<S, L>,
        motion: &PairMotion<S, L>,
        dt: L,
    ) -> Encounter<S, L> {
        let half = L::splat(0.5);
        let half_dt = half.mul(dt);
        let (normal, velocity) = (geometry.normal, motion.velocity);
        let (approach, across) = S::approach(normal, velocity, geometry.inverse_distance, half_dt);

        let overlap = geometry.overlap;
        let share = L::splat(1.0).keep(L::splat(0.0).less(overlap));
        let share =
            if D::JUMPS || A::JUMPS { share_of_step(overlap, approach, half_dt, share) } else { share };

        let slide = if T::NEEDS_SPIN {
            // Lever arms reach the middle of the overlap: R − ov/2, with the overlap of t_n − dt/2.
            let rim = match motion.rim {
                None => {
                    let arm = half.neg_mul_add(overlap, geometry.radius_a);
                    motion.spin_sum.scale(half.mul(half_dt).mul_add(approach, arm))
                }
                Some(rim) => {
                    let quarter = half.mul(half_dt.neg_mul_add(approach, overlap));
                    rim.sub_scaled(quarter, motion.spin_sum)
                }
            };
            let spin_sum = motion.spin_sum;
            let passing = Passing { normal, velocity, approach, across, spin_sum, half_dt };
            MaybeUninit::new(S::slide(&passing, rim))
        } else {
            MaybeUninit::uninit()
        };
        Encounter { approach, share, slide }
    }

    #[inline(always)]
    unsafe fn stretch<L: Lane>(
        &self,
        geometry: &PairGeometry<S, L>,
        encounter: &Encounter<S, L>,
        spin_difference: S::Spin<L>,
        dt: L,
        memory: *mut L::Scalar,
    ) -> (Response<S, L>, L::Mask) {
        let PairGeometry { normal, overlap, root_mass, .. } = *geometry;
        let Encounter { approach, share, ref slide } = *encounter;
        let active = L::splat(0.0).less(share);

        let elastic = self.normal.elastic(overlap);
        // SAFETY: the caller vouches for the slots; so below.
        let viscous = unsafe { self.damping.viscous(approach, root_mass, share, active, memory) };
        let attraction = self.attraction.force(overlap, share);
        let normal_force = self.damping.repulsion(elastic, viscous).sub(attraction);

        let (tangential, sliding) = if T::NEEDS_SPIN {
            // SAFETY: see above.
            unsafe {
                let slide = slide.assume_init_ref();
                self.tangential.stretch(
                    normal,
                    slide,
                    approach,
                    elastic,
                    active,
                    dt,
                    memory.add(D::SLOTS * L::Scalar::GROUP),
                )
            }
        } else {
            (S::Shear::zero(), active)
        };
        let rolling = if R::ROLLS {
            // SAFETY: see above.
            unsafe {
                self.rolling.moment(
                    spin_difference,
                    elastic,
                    active,
                    dt,
                    memory.add((D::SLOTS + T::SLOTS) * L::Scalar::GROUP),
                )
            }
        } else {
            S::Spin::zero()
        };
        (Response { normal: normal_force, elastic, attraction, viscous, tangential, rolling }, sliding)
    }

    #[inline(always)]
    unsafe fn limit<L: Lane>(&self, overlap: L, memory: *mut L::Scalar) {
        // SAFETY: the caller vouches for the slots.
        unsafe {
            self.tangential.limit(self.normal.elastic(overlap), memory.add(D::SLOTS * L::Scalar::GROUP));
        }
    }

    #[inline(always)]
    unsafe fn held<L: Lane>(&self, memory: *const L::Scalar) -> S::Shear<L> {
        // SAFETY: the caller vouches for the slots.
        unsafe { self.tangential.held(memory.add(D::SLOTS * L::Scalar::GROUP)) }
    }

    fn reverses(slot: usize) -> bool {
        let rolling = slot >= D::SLOTS + T::SLOTS;
        rolling || (T::REVERSES && slot >= D::SLOTS)
    }

    fn vacant(slot: usize) -> f64 {
        if slot < D::SLOTS { D::vacant() } else { 0.0 }
    }

    fn stiffness(&self) -> Stiffness {
        Stiffness {
            normal: self.normal.stiffness().max(self.attraction.stiffness()),
            tangential: self.tangential.stiffness(),
            rolling: self.rolling.stiffness(),
            damping: self.damping.coefficient(),
        }
    }

    fn potential(&self, overlap: f64) -> (f64, f64) {
        (self.normal.energy(overlap), self.attraction.energy(overlap))
    }

    fn bound(&self, elastic: f64) -> f64 {
        self.tangential.bound(elastic)
    }

    fn name() -> String {
        [N::NAME, D::NAME, A::NAME, T::NAME, R::NAME].concat()
    }
}

/// The part of [t_n − dt/2, t_n + dt/2] in which the contact is closed.
///
/// Adhesion and dashpot jump when a contact opens or closes. A force switched on at the next full step is wrong by
/// up to half a step of impulse, which makes any scheme first order; weighting the step in which the overlap changes
/// sign, s = 1/2 + ov/(|u| dt), restores the second order (tests: restitution against the exact solution).
/// `whole` is 1 for a closed contact and 0 for an open one.
#[inline(always)]
fn share_of_step<L: Lane>(overlap: L, approach: L, half_dt: L, whole: L) -> L {
    let half_travel = approach.abs().mul(half_dt);
    let crossing = overlap.abs().less(half_travel);
    if L::any(crossing) {
        let travel = half_travel.add(half_travel);
        let part = overlap.div(travel).add(L::splat(0.5)).max(L::splat(0.0)).min(L::splat(1.0));
        L::select(crossing, part, whole)
    } else {
        whole
    }
}
