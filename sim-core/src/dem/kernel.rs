//! The hot loops: contacts of a chunk, motion of a chunk. Written once; compiled for each path.

use std::marker::PhantomData;
use std::mem::MaybeUninit;

use crate::boundary::Boundary;
use crate::contact::{ContactLaw, PairGeometry, PairMotion, Response};
use crate::control::ServoWalls;
use crate::lane::{GROUP, Lane, OPPOSITE, OTHER, SAME};
use crate::space::{Space, Vector};
use crate::state::{Body, Chunk, ContactList, Force, Grains};

/// Which compiled copy of the hot loops runs; all give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// One contact at a time.
    Plain,
    /// One contact at a time, fused multiply-add in hardware.
    #[cfg(target_arch = "x86_64")]
    PlainFma,
    /// Four contacts at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Path {
    /// The fastest path of this machine, or its plain one.
    #[must_use]
    pub fn choose(choice: crate::KernelChoice) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let fma = std::arch::is_x86_feature_detected!("fma");
            if choice == crate::KernelChoice::Auto && fma && std::arch::is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
            if fma {
                return Self::PlainFma;
            }
        }
        let _ = choice;
        Self::Plain
    }

    /// Part of the kernel name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "scalar",
            #[cfg(target_arch = "x86_64")]
            Self::PlainFma => "scalar",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => "avx2",
        }
    }
}

/// Everything the force pass of a chunk reads, and where it writes.
pub struct Pass<'a, S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> {
    /// Law of pairs.
    pub law: &'a C,
    /// Law of wall contacts.
    pub wall_law: &'a C,
    /// Sizes and masses.
    pub grains: &'a G,
    /// Nearest images.
    pub boundary: &'a B,
    /// Walls, where there are any.
    pub walls: Option<&'a ServoWalls>,
    /// All bodies.
    pub bodies: *const Body,
    /// All forces; a chunk writes those of its own particles alone.
    pub forces: *mut Force,
    /// Time step [τ].
    pub dt: f64,
    /// The space.
    pub space: PhantomData<S>,
}

/// Where the constants of a contact lie.
#[inline(always)]
unsafe fn constants<G: Grains>(list: &ContactList, group: usize, lane: usize) -> *const f64 {
    // SAFETY: the caller names a contact of the list.
    unsafe { list.constants.as_ptr().add(if G::CONSTANTS == 0 { 0 } else { group * 3 * GROUP + lane }) }
}

/// The constants of one pair in the rows of a group, lane 0.
pub fn constants_of<G: Grains>(grains: &G, a: u32, b: u32) -> [f64; 3 * GROUP] {
    let mut rows = [0.0; 3 * GROUP];
    for (row, value) in grains.constants(a as usize, b as usize).into_iter().enumerate() {
        rows[row * GROUP] = value;
    }
    rows
}

/// Groups whose meetings are worked out before the law is applied to any of them. The chain of dependent operations
/// from the positions of a group to its forces fills the reorder buffer of a core; cut in two through a small buffer
/// in the first-level cache, several groups are in flight.
const BATCH: usize = 16;

/// A contact or group of contacts before the law.
#[derive(Clone, Copy)]
struct Meeting<S: Space, L: Lane> {
    separation: S::Vector<L>,
    geometry: PairGeometry<S, L>,
    motion: PairMotion<S, L>,
}

/// One contact or group of contacts: geometry and forces.
pub struct Evaluated<S: Space, L: Lane> {
    /// Unit normal from a to b.
    pub normal: S::Vector<L>,
    /// Vector from a to b, nearest image [d].
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
        unsafe { self.respond(&self.meet::<L>(a, b, constants), memory) }
    }

    /// First half of a pair contact: where the bodies are and how they move.
    ///
    /// # Safety
    /// `a`, `b` point to `L::WIDTH` indices of bodies, `constants` to the constants of these contacts.
    #[inline(always)]
    unsafe fn meet<L: Lane>(&self, a: *const u32, b: *const u32, constants: *const f64) -> Meeting<S, L> {
        // SAFETY: the caller vouches for the indices; so throughout.
        let separation = S::vector(unsafe { L::difference::<0>(self.bodies, a, b) });
        let velocity = S::vector(unsafe { L::difference::<1>(self.bodies, a, b) });
        let (separation, velocity) = self.boundary.nearest(separation, velocity);
        let distance = separation.dot(separation).sqrt();
        let inverse_distance = L::splat(1.0).div(distance);
        let normal = separation.scale(inverse_distance);
        // SAFETY: see above.
        let [radius_a, radius_b, root_mass] = unsafe { self.grains.pair::<L>(constants) };
        let overlap = radius_a.add(radius_b).sub(distance);
        let geometry = PairGeometry { normal, overlap, inverse_distance, radius_a, radius_b, root_mass };

        let zero: S::Spin<L> = S::Spin::zero();
        let mut motion: PairMotion<S, L> =
            PairMotion { velocity, rim: zero, spin_sum: zero, spin_difference: zero };
        if C::NEEDS_SPIN {
            // SAFETY: see above.
            unsafe {
                if G::EQUAL {
                    motion.spin_sum = S::spin(L::sum::<2>(self.bodies, a, b));
                    motion.rim = motion.spin_sum.scale(radius_a);
                    if C::ROLLS {
                        motion.spin_difference = S::spin(L::difference::<2>(self.bodies, a, b));
                    }
                } else {
                    let of_a: S::Spin<L> = S::spin(L::record::<2>(self.bodies, a));
                    let of_b: S::Spin<L> = S::spin(L::record::<2>(self.bodies, b));
                    motion.spin_sum = of_a.add(of_b);
                    motion.rim = of_a.scale(radius_a).add_scaled(radius_b, of_b);
                    if C::ROLLS {
                        motion.spin_difference = of_b.add_scaled(L::splat(-1.0), of_a);
                    }
                }
            }
        }
        Meeting { separation, geometry, motion }
    }

    /// Second half of a pair contact: the law.
    ///
    /// # Safety
    /// `memory` points to the slots of these contacts.
    #[inline(always)]
    unsafe fn respond<L: Lane>(&self, meeting: &Meeting<S, L>, memory: *mut f64) -> Evaluated<S, L> {
        let Meeting { separation, geometry, motion } = meeting;
        let separation = *separation;
        let PairGeometry { normal, overlap, radius_a, radius_b, .. } = *geometry;
        let zero: S::Spin<L> = S::Spin::zero();
        // SAFETY: the caller vouches for the slots.
        let response = unsafe { self.law.evaluate(geometry, motion, L::splat(self.dt), memory) };
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
        Evaluated { normal, separation, overlap, response, force, torque_a, torque_b }
    }

    /// Contacts with one wall (a particles; the wall has no index).
    ///
    /// # Safety
    /// `a` points to `L::WIDTH` indices of bodies, `memory` to the slots of these contacts.
    #[inline(always)]
    pub unsafe fn wall<L: Lane>(
        &self,
        walls: &ServoWalls,
        wall: usize,
        a: *const u32,
        memory: *mut f64,
    ) -> Evaluated<S, L> {
        let axis = ServoWalls::axis(wall);
        let outward = L::splat(ServoWalls::outward(wall));
        // SAFETY: the caller vouches for the indices; so throughout.
        let (position, own) = unsafe { (L::record::<0>(self.bodies, a), L::record::<1>(self.bodies, a)) };
        let zero = L::splat(0.0);
        let mut normal = [zero; 3];
        normal[axis] = outward;
        let mut velocity = [zero.sub(own[0]), zero.sub(own[1]), zero.sub(own[2])];
        velocity[axis] = L::splat(walls.velocity[wall]).sub(own[axis]);
        let (normal, velocity) = (S::vector(normal), S::vector(velocity));
        let distance = L::splat(walls.position[wall]).sub(position[axis]).mul(outward);
        // SAFETY: see above.
        let radius = unsafe { self.grains.radii::<L>(a) };
        let overlap = radius.sub(distance);
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
            PairMotion { velocity, rim: none, spin_sum: none, spin_difference: none };
        if C::NEEDS_SPIN {
            // SAFETY: see above.
            motion.spin_sum = S::spin(unsafe { L::record::<2>(self.bodies, a) });
            motion.rim = motion.spin_sum.scale(radius);
            motion.spin_difference = none.add_scaled(L::splat(-1.0), motion.spin_sum);
        }
        // SAFETY: see above.
        let response = unsafe { self.wall_law.evaluate(&geometry, &motion, L::splat(self.dt), memory) };
        let force = response.tangential.sub_scaled(response.normal, normal);
        let mut torque_a = none;
        if C::NEEDS_SPIN {
            let arm = L::splat(0.5).neg_mul_add(overlap, radius);
            torque_a = S::moment(normal, response.tangential).scale(arm);
            if C::ROLLS {
                torque_a = torque_a.add(response.rolling);
            }
        }
        Evaluated {
            normal,
            separation: normal.scale(distance),
            overlap,
            response,
            force,
            torque_a,
            torque_b: none,
        }
    }

    /// Adds the forces of pair contacts; those of b go to `forces_b` at `b_target`.
    ///
    /// # Safety
    /// As for [`Pass::pair`]; the forces are writable and no other thread touches them.
    #[inline(always)]
    unsafe fn apply<L: Lane>(
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

    /// Inner contacts of a chunk.
    #[inline(always)]
    unsafe fn inner<L: Lane>(&self, list: &mut ContactList, group: usize, lane: usize) {
        let indices = list.indices[group].as_ptr();
        // SAFETY: the list holds valid indices of this chunk and memory for its groups.
        unsafe {
            let (a, b) = (indices.add(lane), indices.add(GROUP + lane));
            let memory = list.memory.as_mut_ptr().add(group * C::SLOTS * GROUP + lane);
            let constants = constants::<G>(list, group, lane);
            let contact = self.pair::<L>(a, b, memory, constants);
            self.apply::<L>(a, self.forces, b, &contact);
        }
    }

    /// The first `groups` groups of the inner contacts, in batches.
    #[inline(always)]
    unsafe fn inner_batches<L: Lane>(&self, list: &mut ContactList, groups: usize) {
        let mut meetings = [const { MaybeUninit::<Meeting<S, L>>::uninit() }; BATCH];
        let (indices, memory) = (list.indices.as_ptr().cast::<u32>(), list.memory.as_mut_ptr());
        let mut first = 0;
        while first < groups {
            let count = if groups - first < BATCH { groups - first } else { BATCH };
            let mut k = 0;
            while k < count {
                // SAFETY: the list holds valid indices of this chunk and memory for its groups; the buffer is written
                // before it is read.
                unsafe {
                    let a = indices.add((first + k) * 2 * GROUP);
                    let constants = constants::<G>(list, first + k, 0);
                    meetings.as_mut_ptr().add(k).write(MaybeUninit::new(self.meet::<L>(
                        a,
                        a.add(GROUP),
                        constants,
                    )));
                }
                k += 1;
            }
            k = 0;
            while k < count {
                // SAFETY: as above.
                unsafe {
                    let a = indices.add((first + k) * 2 * GROUP);
                    let meeting = (*meetings.as_ptr().add(k)).assume_init_ref();
                    let contact = self.respond::<L>(meeting, memory.add((first + k) * C::SLOTS * GROUP));
                    self.apply::<L>(a, self.forces, a.add(GROUP), &contact);
                }
                k += 1;
            }
            first += count;
        }
    }

    /// The force pass of one chunk.
    ///
    /// # Safety
    /// The lists of the chunk hold valid indices; the forces of its particles are writable and no other thread
    /// touches them; bodies are not written meanwhile.
    #[inline(always)]
    unsafe fn chunk<L: Lane>(&self, chunk: &mut Chunk) {
        let whole = |count: usize| if L::WIDTH == GROUP { count / GROUP } else { 0 };

        let groups = whole(chunk.inner.count);
        // SAFETY: these groups are full; so for every list below.
        unsafe { self.inner_batches::<L>(&mut chunk.inner, groups) };
        for k in groups * GROUP..chunk.inner.count {
            // SAFETY: pair k is in the list.
            unsafe { self.inner::<f64>(&mut chunk.inner, k / GROUP, k % GROUP) };
        }

        if let Some(walls) = self.walls {
            for wall in 0..6 {
                let list = &mut chunk.walls[wall];
                let mut sum = 0.0;
                let groups = whole(list.count);
                for group in 0..groups {
                    let mut normal = [0.0; GROUP];
                    // SAFETY: see above.
                    unsafe {
                        let contact = self.wall_contact::<L>(walls, wall, list, group, 0);
                        contact.store(normal.as_mut_ptr());
                    }
                    for part in normal {
                        sum += part;
                    }
                }
                for k in groups * GROUP..list.count {
                    // SAFETY: see above.
                    sum += unsafe { self.wall_contact::<f64>(walls, wall, list, k / GROUP, k % GROUP) };
                }
                chunk.wall_force[wall] = sum;
            }
        }

        chunk.ghosts.forces.fill(Force::default());
        let groups = whole(chunk.outer.count);
        for group in 0..groups {
            // SAFETY: see above.
            unsafe { self.outer::<L>(chunk, group, 0) };
        }
        for k in groups * GROUP..chunk.outer.count {
            // SAFETY: see above.
            unsafe { self.outer::<f64>(chunk, k / GROUP, k % GROUP) };
        }
        if B::DEFORMS {
            // SAFETY: this thread owns the forces of the chunk.
            chunk.virial = unsafe { self.virial(chunk.start, chunk.end) };
        }
    }

    /// One group of contacts with a wall: adds to the particles, returns the normal forces.
    #[inline(always)]
    unsafe fn wall_contact<L: Lane>(
        &self,
        walls: &ServoWalls,
        wall: usize,
        list: &mut ContactList,
        group: usize,
        lane: usize,
    ) -> L {
        // SAFETY: the list holds valid indices of this chunk and memory for its groups.
        unsafe {
            let a = list.indices[group].as_ptr().add(lane);
            let memory = list.memory.as_mut_ptr().add(group * C::SLOTS * GROUP + lane);
            let contact = self.wall::<L>(walls, wall, a, memory);
            L::scatter::<0>(self.forces, a, S::vector_record(contact.force));
            if C::NEEDS_SPIN {
                L::scatter::<1>(self.forces, a, S::spin_record(contact.torque_a));
            }
            contact.response.normal
        }
    }

    /// Σ F_α r_α of the contacts owned by the particles of a chunk [k_n d]: four partial sums by slot, so that the
    /// order is fixed and additions overlap.
    #[inline(always)]
    unsafe fn virial(&self, start: usize, end: usize) -> [f64; 3] {
        let mut parts = [[0.0; 2]; 4];
        for slot in start..end {
            // SAFETY: the caller owns these forces.
            let torque = unsafe { &(*self.forces.add(slot)).torque };
            let part = &mut parts[slot % 4];
            part[0] += torque[0];
            part[1] += torque[1];
        }
        let sum = |axis: usize| (parts[0][axis] + parts[1][axis]) + (parts[2][axis] + parts[3][axis]);
        [sum(0), sum(1), 0.0]
    }

    /// One group of contacts with later chunks.
    #[inline(always)]
    unsafe fn outer<L: Lane>(&self, chunk: &mut Chunk, group: usize, lane: usize) {
        let indices = chunk.outer.indices[group].as_ptr();
        let targets = chunk.ghosts.targets[group].as_ptr();
        let ghosts = chunk.ghosts.forces.as_mut_ptr();
        // SAFETY: the list holds valid indices, memory for its groups and a ghost for every b.
        unsafe {
            let (a, b) = (indices.add(lane), indices.add(GROUP + lane));
            let memory = chunk.outer.memory.as_mut_ptr().add(group * C::SLOTS * GROUP + lane);
            let constants = constants::<G>(&chunk.outer, group, lane);
            let contact = self.pair::<L>(a, b, memory, constants);
            self.apply::<L>(a, ghosts, targets.add(lane), &contact);
        }
    }

    /// The force pass of one chunk on a path.
    ///
    /// # Safety
    /// As for `chunk`; `path` was chosen by [`Path::choose`] on this machine.
    pub unsafe fn run(&self, path: Path, chunk: &mut Chunk) {
        // SAFETY: the caller vouches; the path was detected.
        unsafe {
            match path {
                Path::Plain => self.chunk::<f64>(chunk),
                #[cfg(target_arch = "x86_64")]
                Path::PlainFma => self.run_plain_fma(chunk),
                #[cfg(target_arch = "x86_64")]
                Path::Avx2 => self.run_avx2(chunk),
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "fma")]
    unsafe fn run_plain_fma(&self, chunk: &mut Chunk) {
        // SAFETY: the caller vouches.
        unsafe { self.chunk::<f64>(chunk) }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn run_avx2(&self, chunk: &mut Chunk) {
        // SAFETY: the caller vouches.
        unsafe { self.chunk::<crate::lane::Avx2>(chunk) }
    }
}
