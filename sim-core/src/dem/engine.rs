//! The particle system: parameters, state and lists, put together.

use std::marker::PhantomData;

use super::kernel::{Pass, Path};
use super::lists::NEAR_MARGIN;
use super::motion::DragRates;
use super::{Drag, InitialState};
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::control::ServoWalls;
use crate::lane::Number;
use crate::neighbour::CellList;
use crate::space::Space;
use crate::state::{Chunk, Grains, Kinematics, chunk_bounds};

/// A discrete element system: space, sizes, boundary and law chosen at compile time.
pub struct Dem<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> {
    // Parameters.
    pub(super) law: C,
    pub(super) wall_law: C,
    pub(super) path: Path,
    pub(super) threads: usize,
    // State.
    pub(super) grains: G,
    pub(super) boundary: B,
    pub(super) walls: Option<ServoWalls>,
    pub(super) step: u64,
    pub(super) dt: f64,
    pub(super) time: f64,
    /// By slot.
    pub(super) bodies: Vec<S::Body>,
    /// Original number of the particle in each slot.
    pub(super) original: Vec<u32>,
    pub(super) drag: Drag,
    /// Rates by slot when the drag differs between particles.
    pub(super) drag_by_slot: Vec<f64>,
    // Lists and scratch: none of it changes a bit of the trajectory.
    /// Zero between steps. Where space deforms, of all particles: they move when all forces are known. Else of the largest chunk,
    /// once for every thread: a chunk moves right after its forces, and a small buffer used anew for every chunk stays in a
    /// cache that all the forces would be too large for.
    pub(super) forces: Vec<S::Force>,
    /// In the plane, where sizes differ: dt/m, dt/m, dt/I, 0 by slot.
    pub(super) gains: Vec<[S::Real; 4]>,
    pub(super) chunks: Vec<Chunk<S::Real, S::Force>>,
    pub(super) lists: Lists,
    pub(super) space: PhantomData<S>,
}

/// Validity of the neighbour lists.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    /// Positions when the near pairs were found [d].
    pub near_at: Vec<[f64; 3]>,
    /// Near pairs by their higher index: where those of a particle start, and the lower indices; empty until somebody asks.
    pub near_below: (Vec<u32>, Vec<u32>),
    /// Positions of particles and walls where their budgets begin: at the last refresh, or when they got a new one [d].
    pub listed_at: Vec<[f64; 3]>,
    pub walls_at: [f64; 6],
    /// Displacement each particle may make before the next refresh [d], by slot.
    pub budget: Vec<f64>,
    /// Least of them [d].
    pub least_budget: f64,
    /// Displacement each wall may make before the next refresh [d].
    pub wall_budget: [f64; 6],
    /// Relative displacement by deformation that a pair may make before the next refresh [d].
    pub strain_budget: f64,
    /// Largest share of a budget that may be used up.
    pub used: f64,
    /// Largest share of a budget used up in the last step.
    pub pace: f64,
    /// Time for which a particle of steady speed keeps within its budget [τ].
    pub horizon: f64,
    /// Distance a particle may have gone since the near pairs were found, less budgets [d].
    pub margin: f64,
    /// Whether a refresh must come before the next step.
    pub due: bool,
    pub cells: CellList,
    pub rebuilds: u64,
    pub refreshes: u64,
    pub prolonged: u64,
}

impl<S: Space, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dem<S, G, B, C> {
    /// A system at rest in its lists, at step 0; velocities of `initial` are those of t = 0.
    #[expect(clippy::too_many_arguments, reason = "the parts of a system, each of its own type")]
    pub(super) fn new(
        law: C,
        wall_law: C,
        grains: G,
        boundary: B,
        walls: Option<ServoWalls>,
        initial: &InitialState,
        dt: f64,
        path: Path,
        threads: usize,
    ) -> Self {
        let bodies = (0..initial.positions.len())
            .map(|i| {
                let spin = if C::NEEDS_SPIN { initial.spins[i] } else { [0.0; 3] };
                S::Body::new(initial.positions[i], initial.velocities[i], spin)
            })
            .collect::<Vec<_>>();
        let original = (0..bodies.len() as u32).collect();
        let mut dem =
            Self::assemble(law, wall_law, grains, boundary, walls, bodies, original, dt, path, threads);
        dem.sort();
        dem.start_at_half_step();
        dem
    }

    /// A system from its parts, without lists.
    #[expect(clippy::too_many_arguments, reason = "the parts of a system, each of its own type")]
    pub(super) fn assemble(
        law: C,
        wall_law: C,
        grains: G,
        boundary: B,
        walls: Option<ServoWalls>,
        bodies: Vec<S::Body>,
        original: Vec<u32>,
        dt: f64,
        path: Path,
        threads: usize,
    ) -> Self {
        let bounds = chunk_bounds(bodies.len());
        let chunks: Vec<Chunk<S::Real, S::Force>> =
            bounds.windows(2).map(|bound| Chunk::new(bound[0], bound[1], C::SLOTS)).collect();
        let threads = threads.clamp(1, chunks.len());
        let largest = chunks.iter().map(|chunk| chunk.end - chunk.start).max().unwrap_or(0);
        let forces = if B::DEFORMS { bodies.len() } else { threads * largest };
        Self {
            law,
            wall_law,
            path,
            threads,
            grains,
            boundary,
            walls,
            step: 0,
            dt,
            time: 0.0,
            forces: vec![S::Force::default(); forces],
            original,
            bodies,
            drag: Drag::None,
            drag_by_slot: Vec::new(),
            gains: Vec::new(),
            chunks,
            lists: Lists::default(),
            space: PhantomData,
        }
    }

    /// Number of particles.
    pub(super) fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Largest distance of the centres of a listed or near pair [d].
    pub(super) fn pair_reach(&self) -> f64 {
        2.0 * (self.grains.largest_radius() + NEAR_MARGIN) + self.law.range()
    }

    /// The force pass over the present state.
    pub(super) fn pass(&self, forces: *mut S::Force) -> Pass<'_, S, G, B, C> {
        Pass {
            law: &self.law,
            wall_law: &self.wall_law,
            grains: &self.grains,
            boundary: &self.boundary,
            walls: self.walls.as_ref(),
            bodies: self.bodies.as_ptr(),
            forces,
            dt: self.dt,
            space: PhantomData,
        }
    }

    /// Where the forces of the particles of a chunk are while a thread works on it.
    pub(super) fn forces_of(&self, chunk: usize, thread: usize) -> *mut S::Force {
        let first =
            if B::DEFORMS { self.chunks[chunk].start } else { self.forces.len() / self.threads * thread };
        self.forces.as_ptr().cast_mut().wrapping_add(first)
    }

    pub(super) fn drag_rates(&self) -> DragRates<'_> {
        match &self.drag {
            Drag::None => DragRates::None,
            Drag::All(rate) => DragRates::All(*rate),
            Drag::Each(_) => DragRates::Each(&self.drag_by_slot),
        }
    }

    /// Brings the rates of drag into slot order.
    pub(super) fn order_drag(&mut self) {
        if let Drag::Each(rates) = &self.drag {
            self.drag_by_slot = self.original.iter().map(|&particle| rates[particle as usize]).collect();
        } else {
            self.drag_by_slot.clear();
        }
    }

    /// Turns velocities of t_n into those of t_n − dt/2 (at the start).
    fn start_at_half_step(&mut self) {
        // With dt = 0 the scheme evaluates the law at the instant itself.
        let dt = std::mem::replace(&mut self.dt, 0.0);
        let now = self.probe();
        self.dt = dt;
        for (slot, body) in self.bodies.iter_mut().enumerate() {
            let force = &now.forces[slot];
            let (mut velocity, mut spin) = body.motion();
            for axis in 0..3 {
                velocity[axis] -= 0.5 * dt * force.force()[axis] * self.grains.inverse_mass(slot);
                spin[axis] -= 0.5 * dt * force.torque()[axis] * self.grains.inverse_inertia(slot);
            }
            set_motion::<S>(body, velocity, spin);
        }
        if let Some(walls) = &mut self.walls {
            for wall in 0..6 {
                walls.velocity[wall] -= 0.5 * dt * walls.acceleration(wall, now.wall_force[wall]);
            }
        }
        self.refresh();
    }

    /// Changes the time step, keeping the velocities of t_n.
    pub(super) fn change_dt(&mut self, dt: f64) {
        if dt.to_bits() == self.dt.to_bits() {
            return;
        }
        let now = self.probe();
        let shift = 0.5 * (self.dt - dt);
        for (slot, body) in self.bodies.iter_mut().enumerate() {
            let force = &now.forces[slot];
            let (mut velocity, mut spin) = body.motion();
            for axis in 0..3 {
                velocity[axis] += shift * force.force()[axis] * self.grains.inverse_mass(slot);
                spin[axis] += shift * force.torque()[axis] * self.grains.inverse_inertia(slot);
            }
            set_motion::<S>(body, velocity, spin);
        }
        if let Some(walls) = &mut self.walls {
            for wall in 0..6 {
                walls.velocity[wall] += shift * walls.acceleration(wall, now.wall_force[wall]);
            }
        }
        // Rates remembered by dashpots belong to the old step.
        for chunk in &mut self.chunks {
            for list in [&mut chunk.inner, &mut chunk.outer].into_iter().chain(&mut chunk.walls) {
                for k in 0..list.count {
                    for slot in 0..C::TANGENTIAL_SLOT {
                        *list.slot_mut(k, slot) = S::Real::of(C::vacant(slot));
                    }
                }
            }
        }
        self.dt = dt;
        self.work_out_gains();
        self.refresh();
    }

    /// What the motion of discs takes from their sizes and the time step.
    pub(super) fn work_out_gains(&mut self) {
        if S::DIMENSION != 2 {
            return;
        }
        let gain = |slot: usize| {
            let per_mass = self.dt * self.grains.inverse_mass(slot);
            let per_inertia = if C::NEEDS_SPIN { self.dt * self.grains.inverse_inertia(slot) } else { 0.0 };
            [per_mass, per_mass, per_inertia, 0.0].map(S::Real::of)
        };
        self.gains = (0..self.len()).map(gain).collect();
    }
}

/// Gives a body another velocity and spin.
pub(super) fn set_motion<S: Space>(body: &mut S::Body, velocity: [f64; 3], spin: [f64; 3]) {
    *body = S::Body::new(body.position(), velocity, spin).with_budget_of(body);
}
