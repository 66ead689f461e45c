//! Upkeep of near pairs (rarely found anew) and listed pairs (chosen among the near ones every few steps). Every thread
//! of a crew takes part; no result depends on what is listed, as long as no touching pair is missing.

use super::engine::Dem;
use super::listing::{list_pairs, list_walls};
use super::lists::{NEAR_MARGIN, speed};
use super::threads::{Crew, Shared};
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::neighbour::near_pairs;
use crate::space::Space;
use crate::state::{Chunk, Grains, Kinematics};

/// Smallest and largest displacement budget of a particle between two refreshes [d].
const LEAST_BUDGET: f64 = 4e-4;
pub(super) const MOST_BUDGET: f64 = 0.5 * NEAR_MARGIN;

/// Least speed a particle has a budget for, in mean speeds: in a violent state a slow particle that is hit would otherwise use
/// up its budget within a step.
const LEAST_SPEED: f64 = 0.6;

/// Bounds of the number of steps a refresh is meant to last.
const STEPS_PER_REFRESH: (f64, f64) = (6.0, 400.0);

/// Bodies and budgets of a chunk, and the chunk.
pub(super) type Parts<'a, S> =
    (&'a mut [<S as Space>::Body], &'a mut [f64], &'a mut Chunk<<S as Space>::Real, <S as Space>::Force>);

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// Gives every particle and wall a displacement budget for the coming steps and lists the pairs that may touch
    /// within it. Finds the near pairs anew first when a particle could leave its margin.
    pub(super) fn refresh(&mut self) {
        let dem = Shared::new(&raw mut *self);
        // SAFETY: this thread has the system to itself.
        unsafe { Self::refresh_together(dem.get(), &Crew::alone(), 0) };
    }

    /// The same by a crew.
    ///
    /// # Safety
    /// All threads of the crew call this, each with its number, right after a meeting, and nobody else uses the system.
    pub(super) unsafe fn refresh_together(dem: *mut Self, crew: &Crew, thread: usize) {
        // SAFETY: between meetings every chunk, its bodies and its budgets are one thread's alone, all else is only
        // read; at the meetings one thread has the system to itself.
        unsafe {
            let mine = crew.share(thread, (*dem).chunks.len());
            crew.meet(|| (*dem).prepare_budgets());
            for chunk in mine.clone() {
                Self::measure(dem, chunk);
            }
            crew.meet(|| (*dem).choose_interval());
            for chunk in mine.clone() {
                Self::give_budgets(dem, chunk);
            }
            crew.meet(|| (*dem).rebuild_if_strayed());
            for chunk in mine {
                Self::list(dem, chunk);
            }
            crew.meet(|| (*dem).finish_refresh());
        }
    }

    /// One thread, first: room for the budgets.
    fn prepare_budgets(&mut self) {
        let count = self.len();
        self.lists.refreshes += 1;
        self.lists.budget.resize(count, 0.0);
        self.lists.listed_at.resize(count, [f64::NAN; 3]);
        if let Some(walls) = &self.walls {
            self.lists.walls_at = walls.position;
        }
    }

    /// Speeds of the particles of a chunk, into their budgets, and their sum.
    unsafe fn measure(dem: *mut Self, chunk: usize) {
        // SAFETY: only this chunk and its budgets are written.
        unsafe {
            let (bodies, budget, own) = Self::parts(dem, chunk);
            let mut sum = 0.0;
            for (body, budget) in bodies.iter().zip(budget) {
                *budget = speed::<S>(body);
                sum += *budget;
            }
            own.rush = sum;
        }
    }

    /// One thread: how long the coming lists are to last.
    fn choose_interval(&mut self) {
        let total: f64 = self.chunks.iter().map(|chunk| chunk.rush).sum();
        let mean_speed = total / (self.len().max(1) as f64);
        // A refresh costs some two listed pairs per particle; a listed pair is paid every step, and their number
        // grows with the budget. The best interval is near this one (and no result depends on it).
        let steps = (0.09 / (mean_speed * self.dt + 1e-300)).sqrt();
        let steps = steps.clamp(STEPS_PER_REFRESH.0, STEPS_PER_REFRESH.1);
        self.lists.horizon = 1.5 * steps * self.dt;
        let horizon = self.lists.horizon;
        self.lists.least_budget = budget_of(LEAST_SPEED * mean_speed, horizon);
        if let Some(walls) = &self.walls {
            self.lists.wall_budget = walls.velocity.map(|velocity| budget_of(velocity.abs(), horizon));
        }
        self.lists.strain_budget = if B::DEFORMS {
            (horizon * self.boundary.fastest() * self.pair_reach()).clamp(1e-9, LEAST_BUDGET)
        } else {
            0.0
        };
        let strained = self.boundary.strain_since_mark(self.pair_reach()) + self.lists.strain_budget;
        self.lists.margin = NEAR_MARGIN - 0.5 * strained;
        self.lists.near_at.resize(self.bodies.len(), [f64::NAN; 3]);
    }

    /// Budgets of the particles of a chunk, and whether one of them could leave its margin.
    unsafe fn give_budgets(dem: *mut Self, chunk: usize) {
        // SAFETY: only this chunk, its bodies and its budgets are written.
        unsafe {
            let (bodies, budget, own) = Self::parts(dem, chunk);
            let (boundary, lists) = (&(*dem).boundary, &(*dem).lists);
            let near_at = &lists.near_at[own.start..own.end];
            let listed_at = lists.listed_at.as_ptr().cast_mut().add(own.start);
            let listed_at = std::slice::from_raw_parts_mut(listed_at, near_at.len());
            let mut stay = true;
            for (((body, budget), from), at) in bodies.iter_mut().zip(budget).zip(near_at).zip(listed_at) {
                let position = body.position();
                *at = position;
                *budget = budget_of(*budget, lists.horizon).max(lists.least_budget);
                body.set_budget(*budget);
                let from = boundary.since_mark(*from);
                let square: f64 = (0..3).map(|k| (position[k] - from[k]).powi(2)).sum();
                let room = lists.margin - *budget;
                // Written so that a NaN strays.
                stay &= room > 0.0 && square < room * room;
            }
            own.strayed = !stay;
        }
    }

    fn rebuild_if_strayed(&mut self) {
        if self.chunks.iter().any(|chunk| chunk.strayed) {
            self.rebuild();
        }
    }

    /// Lists the pairs and wall contacts of a chunk.
    unsafe fn list(dem: *mut Self, chunk: usize) {
        // SAFETY: only this chunk is written.
        unsafe {
            let shared = &*dem;
            let own = &mut *shared.chunks.as_ptr().cast_mut().add(chunk);
            let (bodies, lists) = (shared.bodies.as_slice(), &shared.lists);
            list_pairs::<S, G, B, C>(
                own,
                bodies,
                &lists.budget,
                &shared.grains,
                &shared.boundary,
                lists.strain_budget,
                &shared.law,
            );
            if let Some(walls) = &shared.walls {
                list_walls::<S, G, C>(own, bodies, &lists.budget, &shared.grains, walls, &lists.wall_budget);
            }
        }
    }

    /// One thread, last: tells every chunk which ghosts of earlier chunks, and of its own, lie in it.
    fn finish_refresh(&mut self) {
        self.lists.used = 0.0;
        self.lists.due = false;
        if !self.chunks.iter().any(|chunk| chunk.ghosts.changed) {
            return;
        }
        for chunk in &mut self.chunks {
            chunk.incoming.clear();
            chunk.ghosts.changed = false;
        }
        for c in 0..self.chunks.len() {
            let mut from = 0;
            // A chunk may have ghosts in itself, across a border of the space.
            for target in c..self.chunks.len() {
                let (particles, end) = (&self.chunks[c].ghosts.particles, self.chunks[target].end);
                let to = from + particles[from..].partition_point(|&particle| (particle as usize) < end);
                if from < to {
                    self.chunks[target].incoming.push((c, from..to));
                }
                from = to;
            }
        }
    }

    /// Bodies and budgets of a chunk, and the chunk.
    ///
    /// # Safety
    /// The caller has this chunk to itself.
    pub(super) unsafe fn parts<'a>(dem: *mut Self, chunk: usize) -> Parts<'a, S> {
        // SAFETY: the caller vouches; chunks do not overlap.
        unsafe {
            let shared = &*dem;
            let own = &mut *shared.chunks.as_ptr().cast_mut().add(chunk);
            let count = own.end - own.start;
            let bodies = shared.bodies.as_ptr().cast_mut().add(own.start);
            let budget = shared.lists.budget.as_ptr().cast_mut().add(own.start);
            (
                std::slice::from_raw_parts_mut(bodies, count),
                std::slice::from_raw_parts_mut(budget, count),
                own,
            )
        }
    }

    /// Finds the near pairs anew.
    pub(super) fn rebuild(&mut self) {
        self.lists.rebuilds += 1;
        self.work_out_gains();
        let bodies = &self.bodies;
        self.lists.near_at = bodies.iter().map(Kinematics::position).collect();
        self.lists.near_below.0.clear();
        let reach = 2.0 * NEAR_MARGIN + self.law.range();
        let size = 2.0 * self.grains.largest_radius() + reach;
        self.boundary.mark();
        let boundary = &self.boundary;
        let mut places: Vec<[f64; 3]> = bodies.iter().map(|body| boundary.inside(body.position())).collect();
        // Images near the borders of a periodic space join the search; `real` tells whose they are.
        let mut real: Vec<u32> = (0..bodies.len() as u32).collect();
        for slot in 0..bodies.len() {
            boundary.images(places[slot], size, &mut |image| {
                places.push(image);
                real.push(slot as u32);
            });
        }
        self.lists.cells.build(places.len(), size, |place| places[place]);
        let (cells, grains) = (&self.lists.cells, &self.grains);
        for chunk in &mut self.chunks {
            near_pairs(
                cells,
                chunk.start..chunk.end,
                |place| places[place],
                |place| real[place as usize],
                |i, j| grains.radius(i) + grains.radius(j) + reach,
                &mut chunk.near,
            );
        }
    }
}

/// Displacement budget [d] at a speed, for a time `horizon` [τ].
fn budget_of(speed: f64, horizon: f64) -> f64 {
    (horizon * speed).clamp(LEAST_BUDGET, MOST_BUDGET)
}
