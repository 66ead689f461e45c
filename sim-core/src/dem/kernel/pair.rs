//! Contacts of pairs in parts, meant to be done for several groups at a time: where the bodies are, how they move against
//! each other, what forces follow (where friction is bounded: springs, the few contacts that slide, forces).

use std::mem::MaybeUninit;

use super::Pass;
use crate::boundary::Boundary;
use crate::contact::{ContactLaw, Encounter, PairGeometry, PairMotion, Response};
use crate::lane::{Gather, Lane, NONE, OTHER, SAME};
use crate::space::{Space, Vector};
use crate::state::Grains;

/// Where the bodies of a contact or group of contacts are and how they move. What a law, its space or its particles
/// do not need is never written.
#[derive(Clone, Copy)]
pub(super) struct Meeting<S: Space, L: Gather> {
    normal: S::Vector<L>,
    overlap: L,
    inverse_distance: L,
    velocity: MaybeUninit<S::Vector<L>>,
    /// Where there are spins and particles are equal.
    spin_sum: MaybeUninit<S::Spin<L>>,
    /// The same where contacts resist rolling.
    spin_difference: MaybeUninit<S::Spin<L>>,
    /// ω_a and ω_b where particles differ.
    own_spins: MaybeUninit<[S::Spin<L>; 2]>,
    /// Where space deforms.
    separation: MaybeUninit<S::Vector<L::Wide>>,
}

impl<S: Space, L: Gather> Meeting<S, L> {
    /// Separation and gauge, which are where normal, overlap and inverse distance will be, become these.
    #[inline(always)]
    fn measure(&mut self, radius_a: L, radius_b: L) {
        let [overlap, inverse_distance] = L::meet([self.inverse_distance, self.overlap], radius_a, radius_b);
        (self.overlap, self.inverse_distance) = (overlap, inverse_distance);
        self.normal = self.normal.scale(inverse_distance);
    }
}

/// How they move against each other.
#[derive(Clone, Copy)]
pub(super) struct Moving<S: Space, L: Lane> {
    approach: L,
    share: L,
    /// Where there are spins.
    slide: MaybeUninit<S::Slide<L>>,
}

/// What a bounded law says beside the tangential force, which is what it remembers.
#[derive(Clone, Copy)]
pub(super) struct Pressed<S: Space, L: Lane> {
    normal: L,
    /// Where contacts resist rolling.
    rolling: MaybeUninit<S::Spin<L>>,
}

/// One contact or group of contacts: geometry and forces.
pub struct Evaluated<S: Space, L: Gather> {
    /// Unit normal from a to b.
    pub normal: S::Vector<L>,
    /// Vector from a to b, nearest image, where space deforms; else zero for a pair [d].
    pub separation: S::Vector<L::Wide>,
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

impl<S: Space, L: Gather> Evaluated<S, L> {
    /// The contacts of a mask; of the others the forces are zero.
    #[inline(always)]
    pub(super) fn keep(self, mask: L::Mask) -> Self {
        let (force, response) = (self.force.keep(mask), self.response);
        let (torque_a, torque_b) = (self.torque_a.keep(mask), self.torque_b.keep(mask));
        Self {
            force,
            torque_a,
            torque_b,
            response: Response { normal: response.normal.keep(mask), ..response },
            ..self
        }
    }
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Pass<'_, S, G, B, C> {
    /// Pair contacts a–b; unless `IMAGES`, no border of the space lies between the two.
    ///
    /// # Safety
    /// `a`, `b` point to `L::WIDTH` indices of bodies, `memory` to the slots and `constants` to the constants of these
    /// contacts.
    #[inline(always)]
    pub unsafe fn pair<L: Gather<Scalar = S::Real>, const IMAGES: bool>(
        &self,
        a: *const u32,
        b: *const u32,
        memory: *mut S::Real,
        constants: *const S::Real,
    ) -> Evaluated<S, L> {
        // SAFETY: the caller vouches.
        unsafe {
            let mut meeting = self.meet::<L, IMAGES>(a, b, constants);
            let moving = self.move_on(&mut meeting, constants);
            self.respond(&meeting, &moving, memory, constants)
        }
    }

    /// First part: where the bodies are.
    ///
    /// # Safety
    /// `a`, `b` point to `L::WIDTH` indices of bodies, `constants` to the constants of these contacts.
    #[inline(always)]
    pub(super) unsafe fn meet<L: Gather<Scalar = S::Real>, const IMAGES: bool>(
        &self,
        a: *const u32,
        b: *const u32,
        constants: *const S::Real,
    ) -> Meeting<S, L> {
        // SAFETY: the caller vouches for the indices; so throughout.
        let separation: S::Vector<L::Wide> = unsafe { S::separation::<L>(self.bodies, a, b) };
        let separation = if IMAGES { self.boundary.nearest(separation) } else { separation };
        let square = separation.dot(separation);
        // Written out, here and below: a closure that is not inlined into the caller with the features makes a call of
        // every instruction.
        let [x, y, z] = S::vector_record(separation);
        let apart: S::Vector<L> = S::vector([L::narrow(x), L::narrow(y), L::narrow(z)]);
        // SAFETY: see above.
        let [radius_a, radius_b, _] = unsafe { self.grains.pair::<L>(constants) };
        let gauge = L::gauge(square, radius_a, radius_b);
        let mut meeting = Meeting {
            normal: apart,
            overlap: gauge[1],
            inverse_distance: gauge[0],
            velocity: MaybeUninit::uninit(),
            spin_sum: MaybeUninit::uninit(),
            spin_difference: MaybeUninit::uninit(),
            own_spins: MaybeUninit::uninit(),
            separation: MaybeUninit::uninit(),
        };
        // SAFETY: see above.
        unsafe {
            let between = if C::NEEDS_SPIN && G::EQUAL {
                let (between, spin_sum) = S::motion::<L>(self.bodies, a, b);
                meeting.spin_sum.write(spin_sum);
                if C::ROLLS {
                    let of_a = S::spins::<L>(self.bodies, a);
                    let of_b = S::spins::<L>(self.bodies, b);
                    meeting.spin_difference.write(of_b.add_scaled(L::splat(-1.0), of_a));
                }
                between
            } else {
                S::velocity::<L>(self.bodies, a, b)
            };
            meeting.velocity.write(self.boundary.carried(apart, between));
            if C::NEEDS_SPIN && !G::EQUAL {
                meeting.own_spins.write([S::spins::<L>(self.bodies, a), S::spins::<L>(self.bodies, b)]);
            }
        }
        if B::DEFORMS {
            meeting.separation.write(separation);
        }
        if !S::LATE_ROOTS {
            meeting.measure(radius_a, radius_b);
        }
        meeting
    }

    /// What the law sees of a meeting.
    ///
    /// # Safety
    /// The meeting came from [`Pass::meet`] of this type of pass and these constants.
    #[inline(always)]
    unsafe fn unfold<L: Gather<Scalar = S::Real>>(
        &self,
        meeting: &Meeting<S, L>,
        constants: *const S::Real,
    ) -> (PairGeometry<S, L>, PairMotion<S, L>) {
        let zero: S::Spin<L> = S::Spin::zero();
        // SAFETY: `meet` wrote what the conditions ask for; the caller vouches for the constants.
        unsafe {
            let [radius_a, radius_b, root_mass] = self.grains.pair::<L>(constants);
            let (mut spin_sum, mut rim, mut spin_difference) = (zero, None, zero);
            if C::NEEDS_SPIN {
                if G::EQUAL {
                    spin_sum = meeting.spin_sum.assume_init();
                    if C::ROLLS {
                        spin_difference = meeting.spin_difference.assume_init();
                    }
                } else {
                    let [of_a, of_b] = meeting.own_spins.assume_init();
                    spin_sum = of_a.add(of_b);
                    rim = Some(of_a.scale(radius_a).add_scaled(radius_b, of_b));
                    spin_difference = of_b.add_scaled(L::splat(-1.0), of_a);
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
            (
                geometry,
                PairMotion { velocity: meeting.velocity.assume_init(), rim, spin_sum, spin_difference },
            )
        }
    }

    /// Second part: how the bodies move against each other.
    ///
    /// # Safety
    /// The meeting came from [`Pass::meet`] of this type of pass and these constants, and has been nowhere since.
    #[inline(always)]
    pub(super) unsafe fn move_on<L: Gather<Scalar = S::Real>>(
        &self,
        meeting: &mut Meeting<S, L>,
        constants: *const S::Real,
    ) -> Moving<S, L> {
        if S::LATE_ROOTS {
            // SAFETY: the caller vouches for the constants.
            let [radius_a, radius_b, _] = unsafe { self.grains.pair::<L>(constants) };
            meeting.measure(radius_a, radius_b);
        }
        // SAFETY: the caller vouches.
        let (geometry, motion) = unsafe { self.unfold(meeting, constants) };
        let Encounter { approach, share, slide } = self.law.encounter(&geometry, &motion, L::splat(self.dt));
        Moving { approach, share, slide }
    }

    /// Third part: the forces.
    ///
    /// # Safety
    /// Meeting and moving came from the parts before with these constants; `memory` points to the slots of these
    /// contacts.
    #[inline(always)]
    pub(super) unsafe fn respond<L: Gather<Scalar = S::Real>>(
        &self,
        meeting: &Meeting<S, L>,
        moving: &Moving<S, L>,
        memory: *mut S::Real,
        constants: *const S::Real,
    ) -> Evaluated<S, L> {
        // SAFETY: the caller vouches.
        let (geometry, motion) = unsafe { self.unfold(meeting, constants) };
        let encounter = Encounter { approach: moving.approach, share: moving.share, slide: moving.slide };
        // SAFETY: the caller vouches for the slots.
        let response: Response<S, L> = unsafe {
            self.law.forces(&geometry, &encounter, motion.spin_difference, L::splat(self.dt), memory)
        };
        // SAFETY: see above.
        unsafe { self.act(meeting, response, constants) }
    }

    /// Third part of a bounded law: springs and dashpots without the bound of friction; whether one of the contacts
    /// exceeds it, so that [`Pass::limit`] must follow.
    ///
    /// # Safety
    /// As for [`Pass::respond`].
    #[inline(always)]
    pub(super) unsafe fn press<L: Gather<Scalar = S::Real>>(
        &self,
        meeting: &Meeting<S, L>,
        moving: &Moving<S, L>,
        memory: *mut S::Real,
        constants: *const S::Real,
    ) -> (Pressed<S, L>, bool) {
        // SAFETY: the caller vouches.
        let (geometry, motion) = unsafe { self.unfold(meeting, constants) };
        let encounter = Encounter { approach: moving.approach, share: moving.share, slide: moving.slide };
        // SAFETY: the caller vouches for the slots.
        let (Response { normal, rolling, .. }, sliding) = unsafe {
            self.law.stretch(&geometry, &encounter, motion.spin_difference, L::splat(self.dt), memory)
        };
        let mut pressed = Pressed { normal, rolling: MaybeUninit::uninit() };
        if C::ROLLS {
            pressed.rolling.write(rolling);
        }
        (pressed, L::any(sliding))
    }

    /// Fourth part, for groups with contacts that slide.
    ///
    /// # Safety
    /// The meeting came from [`Pass::meet`]; `memory` points to the slots of these contacts.
    #[inline(always)]
    pub(super) unsafe fn limit<L: Gather<Scalar = S::Real>>(
        &self,
        meeting: &Meeting<S, L>,
        memory: *mut S::Real,
    ) {
        // SAFETY: the caller vouches.
        unsafe { self.law.limit(meeting.overlap, memory) };
    }

    /// Last part of a bounded law: forces and torques.
    ///
    /// # Safety
    /// Meeting and pressed came from the parts before with these constants; `memory` points to the slots of these
    /// contacts.
    #[inline(always)]
    pub(super) unsafe fn resolve<L: Gather<Scalar = S::Real>>(
        &self,
        meeting: &Meeting<S, L>,
        pressed: &Pressed<S, L>,
        memory: *const S::Real,
        constants: *const S::Real,
    ) -> Evaluated<S, L> {
        let zero = L::splat(0.0);
        // SAFETY: `press` wrote it where contacts resist rolling; the caller vouches for the rest.
        unsafe {
            let rolling = if C::ROLLS { pressed.rolling.assume_init() } else { S::Spin::zero() };
            let (normal, tangential) = (pressed.normal, self.law.held(memory));
            // The parts of the normal force are of no use to a force pass.
            let response =
                Response { normal, elastic: zero, attraction: zero, viscous: zero, tangential, rolling };
            self.act(meeting, response, constants)
        }
    }

    /// Forces and torques of a response.
    ///
    /// # Safety
    /// The meeting came from [`Pass::meet`] of this type of pass and these constants.
    #[inline(always)]
    unsafe fn act<L: Gather<Scalar = S::Real>>(
        &self,
        meeting: &Meeting<S, L>,
        response: Response<S, L>,
        constants: *const S::Real,
    ) -> Evaluated<S, L> {
        let Meeting { normal, overlap, .. } = *meeting;
        let force = S::contact_force(normal, response.normal, response.tangential);
        let (mut torque_a, mut torque_b) = (S::Spin::zero(), S::Spin::zero());
        if C::NEEDS_SPIN {
            // SAFETY: the caller vouches for the constants.
            let [radius_a, radius_b, _] = unsafe { self.grains.pair::<L>(constants) };
            let half = L::splat(0.5);
            let couple = S::couple(normal, response.tangential);
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

    /// Adds the forces of pair contacts; those of b go to `forces_b` at `b_target`. Returns −F_α r_α where space deforms (the plane),
    /// each rounded to a multiple of [`VIRIAL_UNIT`]: sums of such numbers are exact, so they depend neither on their
    /// order nor on what else is listed.
    ///
    /// # Safety
    /// As for [`Pass::pair`]; the forces are writable and no other thread touches them.
    #[inline(always)]
    pub(super) unsafe fn apply<L: Gather<Scalar = S::Real>>(
        &self,
        a: *const u32,
        forces_b: *mut S::Force,
        b_target: *const u32,
        contact: &Evaluated<S, L>,
    ) -> [L::Wide; 2] {
        let (force, torques) = (contact.force, [contact.torque_a, contact.torque_b]);
        // SAFETY: the caller vouches for the indices.
        unsafe {
            if !C::NEEDS_SPIN {
                S::scatter_pair::<L, NONE>(self.forces, a, forces_b, b_target, force, torques);
            } else if G::EQUAL && !C::ROLLS {
                S::scatter_pair::<L, SAME>(self.forces, a, forces_b, b_target, force, torques);
            } else {
                S::scatter_pair::<L, OTHER>(self.forces, a, forces_b, b_target, force, torques);
            }
        }
        if !B::DEFORMS {
            return [L::Wide::splat(0.0); 2];
        }
        let ([f_x, f_y, _], [x, y, _]) = (S::vector_record(force), S::vector_record(contact.separation));
        let shift = L::Wide::splat(VIRIAL_SHIFT);
        [f_x.widen().neg_mul_add(x, shift).sub(shift), f_y.widen().neg_mul_add(y, shift).sub(shift)]
    }
}

/// 2⁻⁴⁸: unit of the virial of one contact [k_n d²].
#[cfg(test)]
const VIRIAL_UNIT: f64 = 1.0 / 281_474_976_710_656.0;

/// Adding and subtracting 1.5 · 2⁵² units rounds to whole units, and sums below 2⁵³ units are exact: sums of 32 k_n d²,
/// where a packing at the largest pressure of the 2008 study has 0.3.
const VIRIAL_SHIFT: f64 = 24.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shift_rounds_to_units() {
        assert_eq!(VIRIAL_SHIFT, 1.5 * 2.0_f64.powi(52) * VIRIAL_UNIT);
        for product in [1e-7_f64, -0.3, 1.234e-11] {
            let rounded = (VIRIAL_SHIFT - product) - VIRIAL_SHIFT;
            assert!((rounded / VIRIAL_UNIT).fract() == 0.0 && (rounded + product).abs() <= 0.5 * VIRIAL_UNIT);
        }
    }
}
