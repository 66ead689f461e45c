//! Contacts of particles with walls, in two parts as those of pairs: how particles and wall move, what forces follow.

use std::mem::MaybeUninit;

use super::{BATCH, Evaluated, Pass, place};
use crate::boundary::Boundary;
use crate::contact::{ContactLaw, Encounter, PairGeometry, PairMotion};
use crate::control::ServoWalls;
use crate::lane::{Gather, Lane, WIDEST};
use crate::space::{Space, Vector};
use crate::state::{ContactList, Grains};

/// How particles and a wall move against each other.
struct Touching<S: Space, L: Lane> {
    geometry: PairGeometry<S, L>,
    encounter: Encounter<S, L>,
    spin_difference: S::Spin<L>,
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Pass<'_, S, G, B, C> {
    /// Contacts with one wall (a particles; the wall has no index).
    ///
    /// # Safety
    /// `a` points to `L::WIDTH` indices of bodies, `memory` to the slots of these contacts.
    #[inline(always)]
    pub unsafe fn wall<L: Gather<Scalar = S::Real>>(
        &self,
        walls: &ServoWalls,
        wall: usize,
        a: *const u32,
        memory: *mut S::Real,
    ) -> Evaluated<S, L> {
        // SAFETY: the caller vouches.
        unsafe { self.push(&self.touch(walls, wall, a), memory) }
    }

    /// First part.
    ///
    /// # Safety
    /// `a` points to `L::WIDTH` indices of bodies.
    #[inline(always)]
    unsafe fn touch<L: Gather<Scalar = S::Real>>(
        &self,
        walls: &ServoWalls,
        wall: usize,
        a: *const u32,
    ) -> Touching<S, L> {
        let axis = ServoWalls::axis(wall);
        let outward = L::splat(ServoWalls::outward(wall));
        // SAFETY: the caller vouches for the indices; so throughout.
        let (position, own) = unsafe { S::places::<L>(self.bodies, a) };
        let zero = L::splat(0.0);
        let mut normal = [zero; 3];
        normal[axis] = outward;
        let mut velocity = [zero.sub(own[0]), zero.sub(own[1]), zero.sub(own[2])];
        velocity[axis] = L::splat(walls.velocity[wall]).sub(own[axis]);
        let (normal, velocity) = (S::vector(normal), S::vector(velocity));
        let distance = L::Wide::splat(walls.position[wall]).sub(position[axis]);
        let distance = distance.mul(L::Wide::splat(ServoWalls::outward(wall)));
        // SAFETY: see above.
        let radius = unsafe { self.grains.radii::<L>(a) };
        let overlap = L::narrow(radius.widen().sub(distance));
        // SAFETY: see above.
        let root_mass = unsafe { self.grains.root_wall_mass::<L>(a) };
        let geometry = PairGeometry {
            normal,
            overlap,
            inverse_distance: zero,
            radius_a: radius,
            radius_b: zero,
            root_mass,
        };
        let none: S::Spin<L> = S::Spin::zero();
        let mut motion: PairMotion<S, L> =
            PairMotion { velocity, rim: None, spin_sum: none, spin_difference: none };
        if C::NEEDS_SPIN {
            // SAFETY: see above.
            motion.spin_sum = unsafe { S::spins::<L>(self.bodies, a) };
            motion.spin_difference = none.add_scaled(L::splat(-1.0), motion.spin_sum);
        }
        let spin_difference = motion.spin_difference;
        let encounter = self.wall_law.encounter(&geometry, &motion, L::splat(self.dt));
        Touching { geometry, encounter, spin_difference }
    }

    /// Second part.
    ///
    /// # Safety
    /// `memory` points to the slots of these contacts.
    #[inline(always)]
    unsafe fn push<L: Gather<Scalar = S::Real>>(
        &self,
        touching: &Touching<S, L>,
        memory: *mut S::Real,
    ) -> Evaluated<S, L> {
        let Touching { geometry, encounter, spin_difference } = touching;
        // SAFETY: the caller vouches.
        let response =
            unsafe { self.wall_law.forces(geometry, encounter, *spin_difference, L::splat(self.dt), memory) };
        let PairGeometry { normal, overlap, radius_a: radius, .. } = *geometry;
        let force = S::contact_force(normal, response.normal, response.tangential);
        let none: S::Spin<L> = S::Spin::zero();
        let mut torque_a = none;
        if C::NEEDS_SPIN {
            let arm = L::splat(0.5).neg_mul_add(overlap, radius);
            torque_a = S::couple(normal, response.tangential).scale(arm);
            if C::ROLLS {
                torque_a = torque_a.add(response.rolling);
            }
        }
        Evaluated {
            normal,
            separation: S::Vector::zero(),
            overlap,
            response,
            force,
            torque_a,
            torque_b: none,
        }
    }

    /// All contacts of a list with a wall: adds to the particles, returns the sum of the normal forces.
    ///
    /// # Safety
    /// The list holds valid indices and memory for its groups; the forces of its particles are writable and no other
    /// thread touches them.
    #[inline(always)]
    pub(super) unsafe fn wall_contacts<L: Gather<Scalar = S::Real>>(
        &self,
        walls: &ServoWalls,
        wall: usize,
        list: &mut ContactList<S::Real>,
    ) -> f64 {
        let (indices, memory) = (list.indices.as_ptr(), list.memory.as_mut_ptr());
        let full = if L::WIDTH == 1 { 0 } else { list.count - list.count % L::WIDTH };
        let mut touching = [const { MaybeUninit::<Touching<S, L>>::uninit() }; BATCH];
        let touching = touching.as_mut_ptr();
        let (mut sum, mut first) = (0.0_f64, 0);
        while first < full {
            let bundles = (full - first) / L::WIDTH;
            let count = if bundles < BATCH { bundles } else { BATCH };
            // SAFETY: these bundles are full; the buffer is written before it is read.
            unsafe {
                let mut k = 0;
                while k < count {
                    let a = indices.add(place::<S::Real>(first + k * L::WIDTH, 2));
                    touching.add(k).write(MaybeUninit::new(self.touch::<L>(walls, wall, a)));
                    k += 1;
                }
                k = 0;
                while k < count {
                    let contact = first + k * L::WIDTH;
                    let a = indices.add(place::<S::Real>(contact, 2));
                    let memory = memory.add(place::<S::Real>(contact, C::SLOTS));
                    let evaluated = self.push::<L>((*touching.add(k)).assume_init_ref(), memory);
                    sum = self.add_wall_bundle::<L>(a, &evaluated, L::WIDTH, sum);
                    k += 1;
                }
            }
            first += count * L::WIDTH;
        }
        // SAFETY: lists keep room for whole groups; contact k is in the list.
        unsafe {
            if L::WIDTH != 1 && full < list.count {
                // As of pairs: the last lanes repeat a particle and count nothing.
                let left = list.count - full;
                let a = indices.add(place::<S::Real>(full, 2));
                let memory = memory.add(place::<S::Real>(full, C::SLOTS));
                let evaluated = self.wall::<L>(walls, wall, a, memory).keep(L::first(left));
                sum = self.add_wall_bundle::<L>(a, &evaluated, left, sum);
            }
            let one_by_one = if L::WIDTH == 1 { 0 } else { list.count };
            for k in one_by_one..list.count {
                let a = indices.add(place::<S::Real>(k, 2));
                let memory = memory.add(place::<S::Real>(k, C::SLOTS));
                let evaluated = self.wall::<L>(walls, wall, a, memory);
                sum = self.add_wall_bundle::<L>(a, &evaluated, 1, sum);
            }
        }
        sum
    }

    /// Adds the forces of a bundle of contacts with a wall to the particles, and the first `count` normal forces to a sum.
    ///
    /// # Safety
    /// `a` points to `L::WIDTH` indices of bodies; their forces are writable and no other thread touches them.
    #[inline(always)]
    unsafe fn add_wall_bundle<L: Gather<Scalar = S::Real>>(
        &self,
        a: *const u32,
        contact: &Evaluated<S, L>,
        count: usize,
        mut sum: f64,
    ) -> f64 {
        let mut lanes = [S::Real::default(); WIDEST];
        // SAFETY: the caller vouches for indices and forces; no bundle is wider than the lanes.
        unsafe {
            let (force, torque) = (contact.force, contact.torque_a);
            if C::NEEDS_SPIN {
                S::scatter::<L, true>(self.forces, a, force, torque);
            } else {
                S::scatter::<L, false>(self.forces, a, force, torque);
            }
            contact.response.normal.store(lanes.as_mut_ptr());
        }
        for &part in &lanes[..count] {
            sum += part.into();
        }
        sum
    }
}
