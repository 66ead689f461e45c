//! Whether new lists are really due. The bound on the way of particles that is kept every step takes the fastest of each moment
//! to be always the same, and on a straight way; and lists last as long as the first particle keeps its budget, when nearly
//! all have used a small part of theirs. So before lists are made anew one looks how far particles have really gone, and the few
//! that have gone far get a new budget where they are, if all they may touch with it is listed already.

use super::engine::Dem;
use super::refresh::MOST_BUDGET;
use super::threads::Crew;
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::control::ServoWalls;
use crate::lane::Number;
use crate::space::Space;
use crate::state::{Chunk, Grains, Kinematics};

/// Used share of a budget from which a particle asks for a new one.
const SPENT: f64 = 0.5;

/// Particles of a chunk that may ask at a time: when there are more, new lists cost less.
const MOST_SPENDERS: usize = 32;

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// New lists by a crew, if they are really due.
    ///
    /// # Safety
    /// All threads of the crew call this, each with its number, right after a meeting, and nobody else uses the system.
    pub(super) unsafe fn refresh_if_due(dem: *mut Self, crew: &Crew, thread: usize) {
        // SAFETY: between meetings every chunk is one thread's alone; at the meeting one thread has the system to itself.
        unsafe {
            // Where space deforms, positions tell the deformation and the way of a particle in one.
            if !B::DEFORMS {
                for chunk in crew.share(thread, (*dem).chunks.len()) {
                    Self::measure_ways(dem, chunk);
                }
                crew.meet(|| (*dem).prolong());
            }
            if (*dem).lists.due {
                Self::refresh_together(dem, crew, thread);
            }
        }
    }

    /// Finds the particles of a chunk that have used up much of their budget.
    unsafe fn measure_ways(dem: *mut Self, chunk: usize) {
        // SAFETY: only this chunk is written.
        unsafe {
            let listed_at = &(*dem).lists.listed_at;
            let (bodies, _, own) = Self::parts(dem, chunk);
            own.spenders.clear();
            for ((body, from), particle) in bodies.iter().zip(&listed_at[own.start..own.end]).zip(own.start..)
            {
                let ([x, y, z], inverse_budget) = (body.position(), body.inverse_budget());
                let [dx, dy, dz] = [x - from[0], y - from[1], z - from[2]];
                let share = (dx * dx + dy * dy + dz * dz) * (inverse_budget * inverse_budget);
                // Written so that a NaN has spent its budget.
                let keeps = share < SPENT * SPENT;
                if !keeps {
                    own.spenders.push(particle as u32);
                }
            }
        }
    }

    /// One thread: gives new budgets to those who need them, or says that new lists are due.
    fn prolong(&mut self) {
        let walls_keep = self.walls.as_ref().is_none_or(|walls| {
            (0..6).all(|wall| {
                let way = (walls.position[wall] - self.lists.walls_at[wall]).abs();
                way < SPENT * self.lists.wall_budget[wall]
            })
        });
        // A pair still apart by half a step's travel has a share of the step in contact: lists must reach as far beyond what
        // has been used, which is less than half a budget of a particle that keeps its own and nothing of a new one.
        let in_reach = SPENT + 0.5 * self.lists.pace < 1.0;
        let few = self.chunks.iter().all(|chunk| chunk.spenders.len() <= MOST_SPENDERS);
        let keeps = walls_keep
            && in_reach
            && few
            && (0..self.chunks.len()).all(|chunk| {
                let spenders = std::mem::take(&mut self.chunks[chunk].spenders);
                let keeps = spenders.iter().all(|&particle| self.renew_budget(chunk, particle));
                self.chunks[chunk].spenders = spenders;
                keeps
            });
        self.lists.used = SPENT;
        self.lists.due = !keeps;
        self.lists.prolonged += u64::from(keeps);
    }

    /// Gives a particle of a chunk a budget from where it is, twice the old one or as large; whether all that it may touch with it
    /// is listed.
    fn renew_budget(&mut self, chunk: usize, particle: u32) -> bool {
        let i = particle as usize;
        let old = self.lists.budget[i];
        let Some(budget) = [2.0 * old, old].into_iter().find(|&budget| self.covers(chunk, particle, budget))
        else {
            return false;
        };
        self.lists.budget[i] = budget;
        self.lists.listed_at[i] = self.bodies[i].position();
        self.bodies[i].set_budget(budget);
        true
    }

    /// Whether all that a particle may touch within a budget from where it is is listed.
    fn covers(&mut self, chunk: usize, particle: u32, budget: f64) -> bool {
        if self.lists.near_below.0.is_empty() {
            self.lists.near_below = near_below(&self.chunks, self.bodies.len());
        }
        let (lists, i) = (&self.lists, particle as usize);
        let x = self.bodies[i].position();
        let gone: f64 = (0..3).map(|k| (x[k] - lists.near_at[i][k]).powi(2)).sum();
        let room = lists.margin - budget;
        // As at a refresh: written so that a NaN strays.
        let stays = budget <= MOST_BUDGET && room > 0.0 && gone < room * room;
        if !stays {
            return false;
        }
        let reach = self.grains.radius(i) + budget + lists.strain_budget + self.law.range();
        let may_touch = |other: u32| {
            let j = other as usize;
            let y = lists.listed_at[j];
            let apart = self.boundary.separation([y[0] - x[0], y[1] - x[1], y[2] - x[2]]);
            let square: f64 = apart.iter().map(|d| d * d).sum();
            let cutoff = reach + self.grains.radius(j) + lists.budget[j];
            square < cutoff * cutoff
        };
        let listed = |a: u32, b: u32, owner: usize| {
            let owner = &self.chunks[owner];
            (if (b as usize) < owner.end { &owner.inner } else { &owner.outer }).contains((a, b))
        };
        let above = &self.chunks[chunk].near;
        let above = above[above.partition_point(|pair| pair.0 < particle)..].iter();
        let (starts, below) = &lists.near_below;
        let mut below = below[starts[i] as usize..starts[i + 1] as usize].iter();
        let pairs_covered = above
            .take_while(|pair| pair.0 == particle)
            .all(|&(_, b)| !may_touch(b) || listed(particle, b, chunk))
            && below.all(|&a| {
                let owner = self.chunks.partition_point(|chunk| chunk.end <= a as usize);
                !may_touch(a) || listed(a, particle, owner)
            });
        let reach = self.grains.radius(i) + budget;
        pairs_covered
            && (self.walls.is_none()
                || (0..6).all(|wall| {
                    let way = (lists.walls_at[wall] - x[ServoWalls::axis(wall)]) * ServoWalls::outward(wall);
                    way - lists.wall_budget[wall] >= reach
                        || self.chunks[chunk].walls[wall].contains((particle, particle))
                }))
    }
}

/// The near pairs (a, b), a < b, by b: those of b are `lower[starts[b]..starts[b + 1]]`.
fn near_below<T: Number, F>(chunks: &[Chunk<T, F>], particles: usize) -> (Vec<u32>, Vec<u32>) {
    let near = || chunks.iter().flat_map(|chunk| &chunk.near);
    let mut starts = vec![0_u32; particles + 1];
    for &(_, b) in near() {
        starts[b as usize] += 1;
    }
    let mut end = 0;
    for start in &mut starts {
        end += *start;
        *start = end;
    }
    // Filled from the back of every run, which moves its end to its start.
    let mut lower = vec![0; end as usize];
    for &(a, b) in near() {
        starts[b as usize] -= 1;
        lower[starts[b as usize] as usize] = a;
    }
    (starts, lower)
}
