//! Contacts of pairs in three parts, meant to be done for several groups at a time: where the bodies are, how they
//! move against each other, what forces follow.

use std::mem::MaybeUninit;

use super::Pass;
use crate::boundary::Boundary;
use crate::contact::{ContactLaw, Encounter, PairGeometry, PairMotion, Response};
use crate::lane::{Lane, OPPOSITE, OTHER, SAME};
use crate::space::{Space, Vector};
use crate::state::{Force, Grains};

/// Where the bodies of a contact or group of contacts are and how they move. What a law, its space or its particles
/// do not need is never written.
#[derive(Clone, Copy)]
pub(super) struct Meeting<S: Space, L: Lane> {
    normal: S::Vector<L>,
    overlap: L,
    inverse_distance: L,
    velocity: S::Vector<L>,
    /// Where there are spins.
    spin_sum: MaybeUninit<S::Spin<L>>,
    /// R_a ω_a + R_b ω_b where particles differ.
    rim: MaybeUninit<S::Spin<L>>,
    /// Where contacts resist rolling.
    spin_difference: MaybeUninit<S::Spin<L>>,
    /// Where space deforms.
    separation: MaybeUninit<S::Vector<L>>,
}

/// How they move against each other.
#[derive(Clone, Copy)]
pub(super) struct Moving<S: Space, L: Lane> {
    approach: L,
    share: L,
    /// Where there are spins.
    tangent: MaybeUninit<crate::contact::tangential::Tangent<S, L>>,
}

/// One contact or group of contacts: geometry and forces.
pub struct Evaluated<S: Space, L: Lane> {
    /// Unit normal from a to b.
    pub normal: S::Vector<L>,
    /// Vector from a to b, nearest image, where space deforms; else zero for a pair [d].
    pub separation: S::Vector<L>,
    /// Overlap [d].
    pub overlap: L,
    /// Parts of the force.
    pub response: Response<S, L>,
    /// Force on a [k_n d].
    pub force: S::Vector<L>,
    /// Torque on a [k_n d²].
    pub torque_a: S::Spin<L>,
    /// Torque on b [k_n d²].
    pub torque_b: S::Spin<L>,
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Pass<'_, S, G, B, C> {
    /// Pair contacts a–b.
    ///
    /// # Safety
    /// `a`, `b` point to `L::WIDTH` indices of bodies, `memory` to the slots and `constants` to the constants of these
    /// contacts.
    #[inline(always)]
    pub unsafe fn pair<L: Lane>(
        &self,
        a: *const u32,
        b: *const u32,
        memory: *mut f64,
        constants: *const f64,
    ) -> Evaluated<S, L> {
        // SAFETY: the caller vouches.
        unsafe {
            let meeting = self.meet::<L>(a, b, constants);
            self.respond(&meeting, &self.move_on(&meeting, constants), memory, constants)
        }
    }

    /// First part: where the bodies are.
    ///
    /// # Safety
    /// `a`, `b` point to `L::WIDTH` indices of bodies, `constants` to the constants of these contacts.
    #[inline(always)]
    pub(super) unsafe fn meet<L: Lane>(
        &self,
        a: *const u32,
        b: *const u32,
        constants: *const f64,
    ) -> Meeting<S, L> {
        // SAFETY: the caller vouches for the indices; so throughout.
        let separation = S::vector(unsafe { L::difference::<0>(self.bodies, a, b) });
        let velocity = S::vector(unsafe { L::difference::<1>(self.bodies, a, b) });
        let (separation, velocity) = self.boundary.nearest(separation, velocity);
        let distance = separation.dot(separation).sqrt();
        let inverse_distance = L::splat(1.0).div(distance);
        let normal = separation.scale(inverse_distance);
        // SAFETY: see above.
        let [radius_a, radius_b, _] = unsafe { self.grains.pair::<L>(constants) };
        let mut meeting = Meeting {
            normal,
            overlap: radius_a.add(radius_b).sub(distance),
            inverse_distance,
            velocity,
            spin_sum: MaybeUninit::uninit(),
            rim: MaybeUninit::uninit(),
            spin_difference: MaybeUninit::uninit(),
            separation: MaybeUninit::uninit(),
        };
        if C::NEEDS_SPIN {
            // SAFETY: see above.
            unsafe {
                if G::EQUAL {
                    meeting.spin_sum.write(S::spin(L::sum::<2>(self.bodies, a, b)));
                    if C::ROLLS {
                        meeting.spin_difference.write(S::spin(L::difference::<2>(self.bodies, a, b)));
                    }
                } else {
                    let of_a: S::Spin<L> = S::spin(L::record::<2>(self.bodies, a));
                    let of_b: S::Spin<L> = S::spin(L::record::<2>(self.bodies, b));
                    meeting.spin_sum.write(of_a.add(of_b));
                    meeting.rim.write(of_a.scale(radius_a).add_scaled(radius_b, of_b));
                    if C::ROLLS {
                        meeting.spin_difference.write(of_b.add_scaled(L::splat(-1.0), of_a));
                    }
                }
            }
        }
        if B::DEFORMS {
            meeting.separation.write(separation);
        }
        meeting
    }

    /// What the law sees of a meeting.
    ///
    /// # Safety
    /// The meeting came from [`Pass::meet`] of this type of pass and these constants.
    #[inline(always)]
    unsafe fn unfold<L: Lane>(
        &self,
        meeting: &Meeting<S, L>,
        constants: *const f64,
    ) -> (PairGeometry<S, L>, PairMotion<S, L>) {
        let zero: S::Spin<L> = S::Spin::zero();
        // SAFETY: `meet` wrote what the conditions ask for; the caller vouches for the constants.
        unsafe {
            let [radius_a, radius_b, root_mass] = self.grains.pair::<L>(constants);
            let (mut spin_sum, mut rim, mut spin_difference) = (zero, zero, zero);
            if C::NEEDS_SPIN {
                spin_sum = meeting.spin_sum.assume_init();
                rim = if G::EQUAL { spin_sum.scale(radius_a) } else { meeting.rim.assume_init() };
                if C::ROLLS {
                    spin_difference = meeting.spin_difference.assume_init();
                }
            }
            let geometry = PairGeometry {
                normal: meeting.normal,
                overlap: meeting.overlap,
                inverse_distance: meeting.inverse_distance,
                radius_a,
                radius_b,
                root_mass,
            };
            (geometry, PairMotion { velocity: meeting.velocity, rim, spin_sum, spin_difference })
        }
    }

    /// Second part: how the bodies move against each other.
    ///
    /// # Safety
    /// The meeting came from [`Pass::meet`] of this type of pass and these constants.
    #[inline(always)]
    pub(super) unsafe fn move_on<L: Lane>(
        &self,
        meeting: &Meeting<S, L>,
        constants: *const f64,
    ) -> Moving<S, L> {
        // SAFETY: the caller vouches.
        let (geometry, motion) = unsafe { self.unfold(meeting, constants) };
        let Encounter { approach, share, tangent } =
            self.law.encounter(&geometry, &motion, L::splat(self.dt));
        let mut moving = Moving { approach, share, tangent: MaybeUninit::uninit() };
        if C::NEEDS_SPIN {
            moving.tangent.write(tangent);
        }
        moving
    }

    /// Third part: the forces.
    ///
    /// # Safety
    /// Meeting and moving came from the parts before with these constants; `memory` points to the slots of these
    /// contacts.
    #[inline(always)]
    pub(super) unsafe fn respond<L: Lane>(
        &self,
        meeting: &Meeting<S, L>,
        moving: &Moving<S, L>,
        memory: *mut f64,
        constants: *const f64,
    ) -> Evaluated<S, L> {
        // SAFETY: the caller vouches.
        let (geometry, motion) = unsafe { self.unfold(meeting, constants) };
        let PairGeometry { normal, overlap, radius_a, radius_b, .. } = geometry;
        let encounter = Encounter {
            approach: moving.approach,
            share: moving.share,
            tangent: if C::NEEDS_SPIN {
                // SAFETY: the part before wrote it.
                unsafe { moving.tangent.assume_init() }
            } else {
                crate::contact::tangential::Tangent {
                    slip: S::Vector::zero(),
                    normal_rate: S::Vector::zero(),
                    turn: L::splat(0.0),
                }
            },
        };
        let zero: S::Spin<L> = S::Spin::zero();
        // SAFETY: the caller vouches for the slots.
        let response: Response<S, L> = unsafe {
            self.law.forces(&geometry, &encounter, motion.spin_difference, L::splat(self.dt), memory)
        };
        let force = response.tangential.sub_scaled(response.normal, normal);
        let (mut torque_a, mut torque_b) = (zero, zero);
        if C::NEEDS_SPIN {
            let half = L::splat(0.5);
            let couple = S::moment(normal, response.tangential);
            torque_a = couple.scale(half.neg_mul_add(overlap, radius_a));
            torque_b = if G::EQUAL { torque_a } else { couple.scale(half.neg_mul_add(overlap, radius_b)) };
            if C::ROLLS {
                torque_a = torque_a.add(response.rolling);
                torque_b = torque_b.add_scaled(L::splat(-1.0), response.rolling);
            }
        }
        // SAFETY: `meet` wrote it where space deforms.
        let separation =
            if B::DEFORMS { unsafe { meeting.separation.assume_init() } } else { S::Vector::zero() };
        Evaluated { normal, separation, overlap, response, force, torque_a, torque_b }
    }

    /// Adds the forces of pair contacts; those of b go to `forces_b` at `b_target`.
    ///
    /// # Safety
    /// As for [`Pass::pair`]; the forces are writable and no other thread touches them.
    #[inline(always)]
    pub(super) unsafe fn apply<L: Lane>(
        &self,
        a: *const u32,
        forces_b: *mut Force,
        b_target: *const u32,
        contact: &Evaluated<S, L>,
    ) {
        let force = S::vector_record(contact.force);
        // SAFETY: the caller vouches for the indices; so below.
        unsafe { L::scatter_pair::<0, OPPOSITE>(self.forces, a, forces_b, b_target, force, force) };
        if C::NEEDS_SPIN || B::DEFORMS {
            let mut torque_a = S::spin_record(contact.torque_a);
            if B::DEFORMS {
                const { assert!(!B::DEFORMS || S::DIMENSION == 2, "only the plane has room for the virial") };
                // A planar torque leaves the first two numbers of its row free: they take F_α r_α of the contacts a
                // particle owns. Sums per particle, unlike sums per list, do not depend on what else is listed.
                let separation = S::vector_record(contact.separation);
                torque_a[0] = L::splat(0.0).sub(force[0].mul(separation[0]));
                torque_a[1] = L::splat(0.0).sub(force[1].mul(separation[1]));
            }
            // SAFETY: see above.
            unsafe {
                if G::EQUAL && !C::ROLLS && !B::DEFORMS {
                    L::scatter_pair::<1, SAME>(self.forces, a, forces_b, b_target, torque_a, torque_a);
                } else {
                    let torque_b = S::spin_record(contact.torque_b);
                    L::scatter_pair::<1, OTHER>(self.forces, a, forces_b, b_target, torque_a, torque_b);
                }
            }
        }
    }
}
