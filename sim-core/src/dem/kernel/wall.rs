//! Contacts of particles with walls.

use super::{Evaluated, Pass};
use crate::boundary::Boundary;
use crate::contact::{ContactLaw, PairGeometry, PairMotion};
use crate::control::ServoWalls;
use crate::lane::{Gather, Lane, Number};
use crate::space::{Space, Vector};
use crate::state::{ContactList, Grains};

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
        let axis = ServoWalls::axis(wall);
        let outward = L::splat(ServoWalls::outward(wall));
        // SAFETY: the caller vouches for the indices; so throughout.
        let (position, own) = unsafe { (L::position(self.bodies, a), L::record::<1>(self.bodies, a)) };
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
            motion.spin_sum = S::spin(unsafe { L::record::<2>(self.bodies, a) });
            motion.spin_difference = none.add_scaled(L::splat(-1.0), motion.spin_sum);
        }
        // SAFETY: see above.
        let response = unsafe { self.wall_law.evaluate(&geometry, &motion, L::splat(self.dt), memory) };
        let force = S::contact_force(normal, response.normal, response.tangential);
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

    /// One group of contacts with a wall: adds to the particles, returns the normal forces.
    #[inline(always)]
    pub(super) unsafe fn wall_contact<L: Gather<Scalar = S::Real>>(
        &self,
        walls: &ServoWalls,
        wall: usize,
        list: &mut ContactList<S::Real>,
        group: usize,
        lane: usize,
    ) -> L {
        let group_of = <S::Real as Number>::GROUP;
        // SAFETY: the list holds valid indices of this chunk and memory for its groups.
        unsafe {
            let a = list.indices.as_ptr().add(group * 2 * group_of + lane);
            let memory = list.memory.as_mut_ptr().add(group * C::SLOTS * group_of + lane);
            let contact = self.wall::<L>(walls, wall, a, memory);
            L::scatter::<0>(self.forces, a, S::vector_record(contact.force));
            if C::NEEDS_SPIN {
                L::scatter::<1>(self.forces, a, S::spin_record(contact.torque_a));
            }
            contact.response.normal
        }
    }
}
