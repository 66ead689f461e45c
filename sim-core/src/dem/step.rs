//! One step as a list of phases, and the loop over steps on one or several threads.

use super::Fault;
use super::engine::Dem;
use super::lists::SORT_EVERY;
use super::motion::{Deformation, Moves};
use super::threads::{Crew, Shared};
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::state::{Gain, Grains};

/// Steps between two looks at whether the state is still sane.
const LOOK_EVERY: u64 = 64;

impl<S: Moves, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// Does `steps` steps.
    pub(super) fn advance_steps(&mut self, steps: u64) -> Result<(), Fault> {
        let chunks = self.chunks.len();
        let threads = self.threads.min(chunks);
        let crew = Crew::new(threads, chunks);
        let fault = std::sync::Mutex::new(None);
        let shared = Shared::new(&raw mut *self);
        let work = |thread: usize| {
            let _poison = crew.poison_on_panic();
            for round in 1..=steps {
                // SAFETY: all threads of the crew do the same; the crew deals out the chunks.
                unsafe { Self::step_together(shared.get(), &crew, thread, round, &fault) };
                if crew.stopped() {
                    break;
                }
            }
        };
        if crew.is_alone() {
            work(0);
        } else {
            std::thread::scope(|scope| {
                for thread in 1..threads {
                    let work = &work;
                    scope.spawn(move || work(thread));
                }
                work(0);
            });
        }
        fault.into_inner().expect("no thread panics with the fault in hand").map_or(Ok(()), Err)
    }

    /// One step of a crew.
    ///
    /// A chunk may move as soon as the forces of all chunks up to it are done: later chunks neither add to its forces
    /// nor look at its bodies, because the lower index owns a contact. A thread therefore moves every chunk right
    /// after its forces, once those of the chunks before it are there.
    ///
    /// # Safety
    /// All threads of the crew call this, each with its number, and nobody else uses the system.
    unsafe fn step_together(
        dem: *mut Self,
        crew: &Crew,
        thread: usize,
        round: u64,
        fault: &std::sync::Mutex<Option<Fault>>,
    ) {
        // SAFETY: every chunk has one thread; who moves a chunk has waited for the forces it depends on; the meetings
        // separate steps and lists.
        unsafe {
            let chunks = (*dem).chunks.len();
            let mine = crew.share(thread, chunks);
            for chunk in mine.clone() {
                Self::force_phase(dem, chunk, thread);
                crew.report(chunk, round);
                if !B::DEFORMS {
                    crew.await_chunks(0..chunk, round);
                    Self::motion_phase(dem, chunk, thread);
                }
            }
            if B::DEFORMS {
                // A deforming space moves by the virial of all chunks.
                crew.await_chunks(0..chunks, round);
                for chunk in mine {
                    Self::motion_phase(dem, chunk, thread);
                }
            }
            crew.meet(|| {
                if let Err(what) = (*dem).serial_phase() {
                    *fault.lock().expect("no thread panics with the fault in hand") = Some(what);
                    crew.stop();
                }
            });
            if !crew.stopped() && (*dem).lists.due {
                Self::refresh_if_due(dem, crew, thread);
            }
        }
    }

    /// Phase 1: contact forces of one chunk.
    ///
    /// # Safety
    /// No other thread works on this chunk; nobody moves bodies, walls or lists meanwhile.
    unsafe fn force_phase(dem: *mut Self, chunk: usize, thread: usize) {
        // SAFETY: fields are reached one by one through the raw pointer; only this chunk is borrowed mutably, and
        // only forces of its own particles are written.
        unsafe {
            let shared = &*dem;
            let forces = shared.forces_of(chunk, thread).wrapping_sub(shared.chunks[chunk].start);
            let own = (&raw mut (*dem).chunks).cast::<Vec<crate::state::Chunk<S::Real, S::Force>>>();
            let own = (*own).as_mut_ptr().add(chunk);
            shared.pass(forces).run(shared.path, &mut *own);
        }
    }

    /// Phase 2: adds the ghosts of earlier chunks, then moves the particles of one chunk.
    ///
    /// # Safety
    /// The force phases of this chunk and all before it are over (of all chunks, where space deforms); no other thread
    /// works on this chunk.
    unsafe fn motion_phase(dem: *mut Self, chunk: usize, thread: usize) {
        // SAFETY: only bodies and forces of this chunk are written; ghosts are read.
        unsafe {
            let shared = &*dem;
            let (start, end) = (shared.chunks[chunk].start, shared.chunks[chunk].end);
            let forces = shared.forces_of(chunk, thread);
            let bodies = shared.bodies.as_ptr().cast_mut();
            for (from, places) in &shared.chunks[chunk].incoming {
                let ghosts = &shared.chunks[*from].ghosts;
                let particles = &ghosts.particles[places.clone()];
                for (&particle, ghost) in particles.iter().zip(&ghosts.forces[places.clone()]) {
                    let force = &mut *forces.add(particle as usize - start);
                    // All of it is read before it is written: then a row is an operation or two.
                    force.gain(ghost);
                }
            }
            let bodies = std::slice::from_raw_parts_mut(bodies.add(start), end - start);
            let forces = std::slice::from_raw_parts_mut(forces, end - start);
            let (grains, drag, dt) = (&shared.grains, shared.drag_rates(), shared.dt);
            let rate = if B::DEFORMS { shared.boundary.next_rate(shared.virial(), dt) } else { [0.0; 3] };
            let gains = if S::DIMENSION == 2 { &shared.gains[start..end] } else { &[] };
            let local_damping = shared.boundary.local_damping();
            let deformation = Deformation { rate, local_damping, drag, gains };
            let rush = if C::NEEDS_SPIN {
                S::advance::<G, true>(shared.path, bodies, forces, start, grains, deformation, dt)
            } else {
                S::advance::<G, false>(shared.path, bodies, forces, start, grains, deformation, dt)
            };
            let own = shared.chunks.as_ptr().cast_mut().add(chunk);
            (*own).rush = rush;
        }
    }

    /// Phase 3, one thread: moves the walls, counts the step, says whether the lists are due.
    fn serial_phase(&mut self) -> Result<(), Fault> {
        let dt = self.dt;
        let mut rush = self.chunks.iter().map(|chunk| chunk.rush).fold(0.0, f64::max) * 3.0_f64.sqrt();
        if let Some(walls) = &mut self.walls {
            let mut force = [0.0; 6];
            for chunk in &self.chunks {
                for (sum, part) in force.iter_mut().zip(chunk.wall_force) {
                    *sum += part;
                }
            }
            walls.advance(force, dt);
            for wall in 0..6 {
                rush = rush.max(walls.velocity[wall].abs() / self.lists.wall_budget[wall]);
            }
        }
        if B::DEFORMS {
            self.boundary.advance(self.virial(), dt);
            rush = rush.max(self.boundary.fastest() * self.pair_reach() / self.lists.strain_budget);
        }
        self.step += 1;
        self.time += dt;
        if self.step.is_multiple_of(LOOK_EVERY) {
            self.look()?;
        }
        self.lists.pace = rush * dt;
        self.lists.used += self.lists.pace;
        if self.step.is_multiple_of(SORT_EVERY) {
            self.look()?;
            self.sort();
        } else if self.lists.used + 0.5 * self.lists.pace >= 1.0 {
            // The half step: a pair still apart by half a step's travel already has a share of the step in contact.
            if rush.is_finite() {
                self.lists.due = true;
            } else {
                self.look()?;
            }
        }
        Ok(())
    }

    /// Σ F_α r_α over all contacts [k_n d].
    pub(super) fn virial(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for chunk in &self.chunks {
            for (total, part) in sum.iter_mut().zip(chunk.virial) {
                *total += part;
            }
        }
        sum
    }
}
