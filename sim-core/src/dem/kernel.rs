//! The hot loops: contacts of a chunk. Written once; compiled for each path.

mod pair;
mod path;
mod wall;

use std::marker::PhantomData;
use std::mem::MaybeUninit;

pub use pair::Evaluated;
use pair::{Meeting, Moving, Pressed};
pub use path::Path;

use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::control::ServoWalls;
use crate::lane::{Gather, Lane, Number, Real, WIDEST};
use crate::space::Space;
use crate::state::{Chunk, ContactList, Grains};

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
    pub bodies: *const S::Body,
    /// Where the force of particle 0 is or would be: only those of the chunk at work need be there.
    pub forces: *mut S::Force,
    /// Time step [τ].
    pub dt: f64,
    /// The space.
    pub space: PhantomData<S>,
}

/// Where a contact lies in a list whose groups have so many rows.
#[inline(always)]
fn place<T: Number>(contact: usize, rows: usize) -> usize {
    contact / T::GROUP * rows * T::GROUP + contact % T::GROUP
}

/// Where the constants of a contact lie.
#[inline(always)]
fn constants<G: Grains, T: Number>(rows: *const T, contact: usize) -> *const T {
    rows.wrapping_add(if G::CONSTANTS == 0 { 0 } else { place::<T>(contact, 3) })
}

/// The constants of one pair in the rows of a group, lane 0.
pub fn constants_of<G: Grains, T: Number>(grains: &G, a: u32, b: u32) -> [T; 3 * WIDEST] {
    let mut rows = [T::default(); 3 * WIDEST];
    for (row, value) in grains.constants(a as usize, b as usize).into_iter().enumerate() {
        rows[row * T::GROUP] = T::of(value);
    }
    rows
}

/// Bundles that go through one part of the work before any of them goes on to the next. The chain of dependent
/// operations from the positions of a bundle to its forces is several times as long as the reorder buffer of a core;
/// cut in parts through small buffers in the first-level cache, several bundles are in flight.
const BATCH: usize = 16;

/// Sum of the numbers of a bundle.
#[inline(always)]
fn wide_sum<L: Lane<Scalar = f64>>(of: L) -> f64 {
    let mut lanes = [0.0; WIDEST];
    // SAFETY: there is room for the widest lane.
    unsafe { of.store(lanes.as_mut_ptr()) };
    lanes.iter().sum()
}

/// Where the forces on b of the contacts of a list go.
#[derive(Clone, Copy)]
struct Targets<S: Space> {
    forces: *mut S::Force,
    /// Indices of the first group.
    at: *const u32,
    /// Rows of a group.
    rows: usize,
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Pass<'_, S, G, B, C> {
    /// The contacts of a list: whole bundles in batches, then what is left; on a plain path one by one. Unless `IMAGES`, none
    /// crosses a border of the space.
    ///
    /// # Safety
    /// The list holds valid indices and memory for its groups; the forces of its particles a and those of `targets`
    /// are writable and no other thread touches them.
    #[inline(always)]
    unsafe fn contacts<L: Gather<Scalar = S::Real>, const IMAGES: bool>(
        &self,
        list: &mut ContactList<S::Real>,
        targets: Targets<S>,
    ) -> [f64; 2] {
        let mut virial = [L::Wide::splat(0.0); 2];
        let mut rest = [0.0; 2];
        let (indices, memory) = (list.indices.as_ptr(), list.memory.as_mut_ptr());
        let rows = list.constants.as_ptr();
        let full = if L::WIDTH == 1 { 0 } else { list.count - list.count % L::WIDTH };
        let mut first = 0;
        while first < full {
            let bundles = (full - first) / L::WIDTH;
            let count = if bundles < BATCH { bundles } else { BATCH };
            // SAFETY: these bundles are full.
            let own = unsafe { self.batch::<L, IMAGES>(indices, memory, rows, targets, first, count) };
            virial = [virial[0].add(own[0]), virial[1].add(own[1])];
            first += count * L::WIDTH;
        }
        if L::WIDTH != 1 && full < list.count {
            // What is left is a bundle whose last lanes repeat a pair: they are worked out and count nothing.
            let left = L::first(list.count - full);
            // SAFETY: lists keep room for whole groups.
            unsafe {
                let contact = self.one_bundle::<L, IMAGES>(indices, memory, rows, full).keep(left);
                self.apply_bundle::<L>(indices, targets, full, &contact, &mut virial);
            }
        }
        let one_by_one = if L::WIDTH == 1 { 0 } else { list.count };
        for k in one_by_one..list.count {
            // SAFETY: contact k is in the list.
            unsafe {
                let contact = self.one_bundle::<L, IMAGES>(indices, memory, rows, k);
                let a = indices.add(place::<S::Real>(k, 2));
                let target = targets.at.add(place::<S::Real>(k, targets.rows));
                let own = self.apply::<L>(a, targets.forces, target, &contact);
                rest[0] += wide_sum(own[0]);
                rest[1] += wide_sum(own[1]);
            }
        }
        if !B::DEFORMS {
            return rest;
        }
        // Exact sums: any order gives the same bits.
        [rest[0] + wide_sum(virial[0]), rest[1] + wide_sum(virial[1])]
    }

    /// The bundle of contacts that begins with `contact`, all parts at once.
    ///
    /// # Safety
    /// As for `contacts`; the group has room for the bundle.
    #[inline(always)]
    unsafe fn one_bundle<L: Gather<Scalar = S::Real>, const IMAGES: bool>(
        &self,
        indices: *const u32,
        memory: *mut S::Real,
        rows: *const S::Real,
        contact: usize,
    ) -> Evaluated<S, L> {
        // SAFETY: the caller vouches.
        unsafe {
            let a = indices.add(place::<S::Real>(contact, 2));
            let memory = memory.add(place::<S::Real>(contact, C::SLOTS));
            let constants = constants::<G, S::Real>(rows, contact);
            self.pair::<L, IMAGES>(a, a.add(<S::Real as Number>::GROUP), memory, constants)
        }
    }

    /// So many bundles from the contact `first` on, part by part.
    ///
    /// # Safety
    /// As for `contacts`; the bundles are full and at most [`BATCH`].
    #[inline(always)]
    unsafe fn batch<L: Gather<Scalar = S::Real>, const IMAGES: bool>(
        &self,
        indices: *const u32,
        memory: *mut S::Real,
        rows: *const S::Real,
        targets: Targets<S>,
        first: usize,
        count: usize,
    ) -> [L::Wide; 2] {
        let mut virial = [L::Wide::splat(0.0); 2];
        let mut meetings = [const { MaybeUninit::<Meeting<S, L>>::uninit() }; BATCH];
        let mut moving = [const { MaybeUninit::<Moving<S, L>>::uninit() }; BATCH];
        let (meetings, moving) = (meetings.as_mut_ptr(), moving.as_mut_ptr());
        // SAFETY: the caller vouches for the lists; the buffers are written before they are read.
        unsafe {
            let mut k = 0;
            while k < count {
                let contact = first + k * L::WIDTH;
                let a = indices.add(place::<S::Real>(contact, 2));
                let constants = constants::<G, S::Real>(rows, contact);
                meetings.add(k).write(MaybeUninit::new(self.meet::<L, IMAGES>(
                    a,
                    a.add(<S::Real as Number>::GROUP),
                    constants,
                )));
                k += 1;
            }
            k = 0;
            while k < count {
                let meeting = (*meetings.add(k)).assume_init_mut();
                let constants = constants::<G, S::Real>(rows, first + k * L::WIDTH);
                moving.add(k).write(MaybeUninit::new(self.move_on::<L>(meeting, constants)));
                k += 1;
            }
            if C::BOUNDED {
                return self.limited::<L>(indices, memory, rows, targets, first, count, meetings, moving);
            }
            k = 0;
            while k < count {
                let (meeting, moving) =
                    ((*meetings.add(k)).assume_init_ref(), (*moving.add(k)).assume_init_ref());
                let contact = first + k * L::WIDTH;
                let memory = memory.add(place::<S::Real>(contact, C::SLOTS));
                let constants = constants::<G, S::Real>(rows, contact);
                let evaluated = self.respond::<L>(meeting, moving, memory, constants);
                self.apply_bundle::<L>(indices, targets, contact, &evaluated, &mut virial);
                k += 1;
            }
        }
        virial
    }

    /// The parts after the second for a law whose bound is a part of its own.
    ///
    /// # Safety
    /// As for `batch`; the first two parts are done.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "the second half of `batch`, with its buffers")]
    unsafe fn limited<L: Gather<Scalar = S::Real>>(
        &self,
        indices: *const u32,
        memory: *mut S::Real,
        rows: *const S::Real,
        targets: Targets<S>,
        first: usize,
        count: usize,
        meetings: *mut MaybeUninit<Meeting<S, L>>,
        moving: *mut MaybeUninit<Moving<S, L>>,
    ) -> [L::Wide; 2] {
        let mut virial = [L::Wide::splat(0.0); 2];
        let mut pressed = [const { MaybeUninit::<Pressed<S, L>>::uninit() }; BATCH];
        // Bundles with contacts that slide. Which ones do, nobody can predict; so they are noted without a branch.
        let mut sliding = [0_usize; BATCH + 1];
        let mut slides = 0;
        let (pressed, noted) = (pressed.as_mut_ptr(), sliding.as_mut_ptr());
        // SAFETY: the caller vouches for lists and buffers; `pressed` is written before it is read.
        unsafe {
            let mut k = 0;
            while k < count {
                let (meeting, moving) =
                    ((*meetings.add(k)).assume_init_ref(), (*moving.add(k)).assume_init_ref());
                let contact = first + k * L::WIDTH;
                let memory = memory.add(place::<S::Real>(contact, C::SLOTS));
                let constants = constants::<G, S::Real>(rows, contact);
                let (own, slide) = self.press::<L>(meeting, moving, memory, constants);
                pressed.add(k).write(MaybeUninit::new(own));
                *noted.add(slides) = k;
                slides += usize::from(slide);
                k += 1;
            }
            for &k in sliding.get_unchecked(..slides) {
                let meeting = (*meetings.add(k)).assume_init_ref();
                let memory = memory.add(place::<S::Real>(first + k * L::WIDTH, C::SLOTS));
                self.limit::<L>(meeting, memory);
            }
            k = 0;
            while k < count {
                let (meeting, pressed) =
                    ((*meetings.add(k)).assume_init_ref(), (*pressed.add(k)).assume_init_ref());
                let contact = first + k * L::WIDTH;
                let memory = memory.add(place::<S::Real>(contact, C::SLOTS));
                let constants = constants::<G, S::Real>(rows, contact);
                let evaluated = self.resolve::<L>(meeting, pressed, memory, constants);
                self.apply_bundle::<L>(indices, targets, contact, &evaluated, &mut virial);
                k += 1;
            }
        }
        virial
    }

    /// Adds the forces of the bundle that begins with `contact`, and its part of the virial.
    ///
    /// # Safety
    /// As for `batch`.
    #[inline(always)]
    unsafe fn apply_bundle<L: Gather<Scalar = S::Real>>(
        &self,
        indices: *const u32,
        targets: Targets<S>,
        contact: usize,
        evaluated: &Evaluated<S, L>,
        virial: &mut [L::Wide; 2],
    ) {
        // SAFETY: the caller vouches for the indices.
        let own = unsafe {
            let a = indices.add(place::<S::Real>(contact, 2));
            let target = targets.at.add(place::<S::Real>(contact, targets.rows));
            self.apply::<L>(a, targets.forces, target, evaluated)
        };
        if B::DEFORMS {
            *virial = [virial[0].add(own[0]), virial[1].add(own[1])];
        }
    }

    /// The force pass of one chunk.
    ///
    /// # Safety
    /// The lists of the chunk hold valid indices; the forces of its particles are writable and no other thread
    /// touches them; bodies are not written meanwhile.
    #[inline(always)]
    unsafe fn chunk<L: Gather<Scalar = S::Real>>(&self, chunk: &mut Chunk<S::Real, S::Force>) {
        // Laws on the stack: what they derive from their parameters is worked out once, not after every store.
        let (law, wall_law) = (*self.law, *self.wall_law);
        // SAFETY: the caller vouches.
        unsafe { Pass { law: &law, wall_law: &wall_law, ..*self }.chunk_with_own_laws::<L>(chunk) }
    }

    /// See `chunk`.
    #[inline(always)]
    unsafe fn chunk_with_own_laws<L: Gather<Scalar = S::Real>>(&self, chunk: &mut Chunk<S::Real, S::Force>) {
        let group_of = <S::Real as Number>::GROUP;
        let inner =
            Targets { forces: self.forces, at: chunk.inner.indices.as_ptr().wrapping_add(group_of), rows: 2 };
        // SAFETY: the list holds valid indices of this chunk.
        let of_inner = unsafe { self.contacts::<L, false>(&mut chunk.inner, inner) };

        if let Some(walls) = self.walls {
            for wall in 0..6 {
                // SAFETY: the list holds valid indices of this chunk.
                let sum = unsafe { self.wall_contacts::<L>(walls, wall, &mut chunk.walls[wall]) };
                chunk.wall_force[wall] = sum;
            }
        }

        chunk.ghosts.forces.fill(S::Force::default());
        let outer =
            Targets { forces: chunk.ghosts.forces.as_mut_ptr(), at: chunk.ghosts.targets.as_ptr(), rows: 1 };
        // SAFETY: the list holds valid indices and there is a ghost for every b.
        let of_outer = unsafe { self.contacts::<L, true>(&mut chunk.outer, outer) };
        if B::DEFORMS {
            chunk.virial = [of_inner[0] + of_outer[0], of_inner[1] + of_outer[1], 0.0];
        }
    }

    /// One pair, to look at: the same bits on every path; fused operations are the machine's own where it has them.
    ///
    /// # Safety
    /// `memory` and `constants` are those of the pair, in the first lane; `path` was chosen by [`Path::choose`] on this machine.
    pub unsafe fn one_pair(
        &self,
        path: Path,
        a: u32,
        b: u32,
        memory: *mut S::Real,
        constants: *const S::Real,
    ) -> Evaluated<S, S::Real> {
        // SAFETY: the caller vouches; the path was detected.
        unsafe {
            match path {
                Path::Plain => self.pair::<S::Real, true>(&raw const a, &raw const b, memory, constants),
                #[cfg(target_arch = "x86_64")]
                Path::PlainFma | Path::Avx2 | Path::Avx512 => self.one_pair_fma(a, b, memory, constants),
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "fma")]
    unsafe fn one_pair_fma(
        &self,
        a: u32,
        b: u32,
        memory: *mut S::Real,
        constants: *const S::Real,
    ) -> Evaluated<S, S::Real> {
        // SAFETY: the caller vouches.
        unsafe { self.pair::<S::Real, true>(&raw const a, &raw const b, memory, constants) }
    }

    /// The force pass of one chunk on a path.
    ///
    /// # Safety
    /// As for `chunk`; `path` was chosen by [`Path::choose`] on this machine.
    pub unsafe fn run(&self, path: Path, chunk: &mut Chunk<S::Real, S::Force>) {
        // SAFETY: the caller vouches; the path was detected.
        unsafe {
            match path {
                Path::Plain => self.chunk::<S::Real>(chunk),
                #[cfg(target_arch = "x86_64")]
                Path::PlainFma => self.run_plain_fma(chunk),
                #[cfg(target_arch = "x86_64")]
                Path::Avx2 => self.run_avx2(chunk),
                #[cfg(target_arch = "x86_64")]
                Path::Avx512 => self.run_avx512(chunk),
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "fma")]
    unsafe fn run_plain_fma(&self, chunk: &mut Chunk<S::Real, S::Force>) {
        // SAFETY: the caller vouches.
        unsafe { self.chunk::<S::Real>(chunk) }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq,avx512bw")]
    unsafe fn run_avx512(&self, chunk: &mut Chunk<S::Real, S::Force>) {
        // SAFETY: the caller vouches.
        unsafe { self.chunk::<<S::Real as Real>::Fastest>(chunk) }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn run_avx2(&self, chunk: &mut Chunk<S::Real, S::Force>) {
        // SAFETY: the caller vouches.
        unsafe { self.chunk::<<S::Real as Real>::Fast>(chunk) }
    }
}
