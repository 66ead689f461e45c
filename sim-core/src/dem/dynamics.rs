//! What the rest of the program may do with a running particle system.

use serde::{Deserialize, Serialize};

use super::View;
use super::engine::{Dem, set_motion};
use super::lists::speed;
use super::motion::Moves;
use crate::boundary::Boundary;
use crate::contact::ContactLaw;
use crate::lane::Number;
use crate::state::{ContactList, Grains, Kinematics};

/// A particle system with its laws chosen. Object-safe and coarse: called per batch of steps.
///
/// Numbering is always the original one of [`InitialState`]; how particles are sorted inside is nobody's business.
pub trait Dynamics: Send {
    /// Does exactly `steps` steps unless the state stops being finite or sane (see [`Fault`]). Slicing never changes
    /// results.
    ///
    /// # Errors
    /// [`Fault`] with the step at which it was seen; the state must then be thrown away.
    fn run(&mut self, steps: u64) -> Result<(), Fault>;

    /// Steps done since the initial state.
    fn steps(&self) -> u64;

    /// Time since the initial state [τ].
    fn time(&self) -> f64;

    /// Present time step [τ].
    fn dt(&self) -> f64;

    /// Changes the time step; velocities are re-synchronised so that the order of the scheme is kept.
    fn set_dt(&mut self, dt: f64);

    /// A time step that is certainly stable for the contacts of this instant (see `time_step`): the scheme is stable
    /// below it whatever the motion on this network [τ]. Infinite when nothing touches.
    fn critical_dt(&self) -> f64;

    /// The consistent picture of this instant. Costs about one to three plain steps; changes nothing.
    fn view(&self) -> View;

    /// Positions of the inner faces of the six walls, x low, x high, y low, … [d].
    fn wall_positions(&self) -> [f64; 6];

    /// Largest particle speed of the last step [d/τ]; cheap.
    fn max_speed(&self) -> f64;

    /// Gives chosen particles new velocities and spins (kicks).
    fn set_motion(&mut self, changes: &[Motion]);

    /// Sets the drag that acts from now on; kept in checkpoints.
    fn set_drag(&mut self, drag: Drag);

    /// Sizes for benchmarks and memory estimates.
    fn counters(&self) -> Counters;

    /// Name of the compiled kernel, for example `dem3d+hooke+viscous+constant_adhesion+coulomb;avx2`.
    fn kernel(&self) -> String;

    /// The complete state as checkpoint sections; the matching constructor continues to the same bits.
    fn save(&self) -> Vec<u8>;
}

/// Parameters of cohesive spheres in reduced units d = m = k_n = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereParameters {
    /// p/σe: pressure on the walls [k_n/d].
    pub pressure: f64,
    /// f_c of a pair [k_n d].
    pub adhesion: f64,
    /// f_c of a wall contact [k_n d] (already multiplied by the wall fraction).
    pub wall_adhesion: f64,
    /// Damping ratio α_n [1].
    pub alpha_n: f64,
    /// Whether the particle mass replaces the effective mass in the dashpot.
    pub damping_uses_particle_mass: bool,
    /// Whether elastic plus viscous force is kept from pulling.
    pub clamp_viscous: bool,
    /// Friction coefficient of pairs μ [1].
    pub mu: f64,
    /// Friction coefficient of walls [1].
    pub mu_wall: f64,
    /// k_t/k_n [1].
    pub kt: f64,
    /// Mass of one wall [m].
    pub wall_mass: f64,
    /// Which walls move: x low, x high, y low, … .
    pub moving: [bool; 6],
    /// Whether velocities, forces and contact memories are kept in single precision.
    pub mixed: bool,
}

impl SphereParameters {
    /// Springs alone: no load, adhesion, damping or friction, walls at rest; k_t = 1.5 k_n and m_w = 96 m as in the
    /// 2024 study.
    #[must_use]
    pub fn springs() -> Self {
        Self {
            pressure: 0.0,
            adhesion: 0.0,
            wall_adhesion: 0.0,
            alpha_n: 0.0,
            damping_uses_particle_mass: false,
            clamp_viscous: false,
            mu: 0.0,
            mu_wall: 0.0,
            kt: 1.5,
            wall_mass: 96.0,
            moving: [false; 6],
            mixed: false,
        }
    }
}

/// Where a system starts.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialState {
    /// Centres [d].
    pub positions: Vec<[f64; 3]>,
    /// Velocities at t = 0 [d/τ].
    pub velocities: Vec<[f64; 3]>,
    /// Angular velocities at t = 0 [1/τ].
    pub spins: Vec<[f64; 3]>,
    /// Inner faces of the walls: x low, x high, y low, y high, z low, z high [d].
    pub walls: [f64; 6],
    /// Velocities of the walls at t = 0 [d/τ].
    pub wall_velocities: [f64; 6],
}

/// A new velocity and spin for one particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Particle, original numbering.
    pub particle: usize,
    /// Velocity [d/τ].
    pub velocity: [f64; 3],
    /// Angular velocity [1/τ].
    pub spin: [f64; 3],
}

/// A drag −γ m v and −γ I ω on particles; rates γ in 1/τ.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Drag {
    /// None.
    #[default]
    None,
    /// The same on all particles [1/τ].
    All(f64),
    /// One rate per particle, original numbering [1/τ].
    Each(Vec<f64>),
}

/// The state stopped making sense: caught within a bounded number of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Step at which it was seen.
    pub step: u64,
    /// Evidence: not finite, a particle crosses several diameters a step, a particle left the box, … .
    pub what: String,
}

/// Sizes of the present state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Particles.
    pub particles: u64,
    /// Touching pairs.
    pub contacts: u64,
    /// Pairs evaluated by the force pass each step (touching ones included).
    pub listed_pairs: u64,
    /// Pairs in the neighbour list.
    pub near_pairs: u64,
    /// Touching particle-wall pairs.
    pub wall_contacts: u64,
    /// Neighbour list rebuilds so far in this process.
    pub rebuilds: u64,
    /// Refreshes of the force pass list so far in this process.
    pub refreshes: u64,
    /// Refreshes put off so far, because new budgets for some particles did.
    pub prolonged: u64,
    /// Threads used.
    pub threads: u64,
    /// Bytes of the state and its lists.
    pub bytes: u64,
}

impl<S: Moves, G: Grains, B: Boundary<S>, C: ContactLaw<S>> Dynamics for Dem<S, G, B, C> {
    fn run(&mut self, steps: u64) -> Result<(), Fault> {
        self.advance_steps(steps)
    }

    fn steps(&self) -> u64 {
        self.step
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn dt(&self) -> f64 {
        self.dt
    }

    fn set_dt(&mut self, dt: f64) {
        self.change_dt(dt);
    }

    fn critical_dt(&self) -> f64 {
        self.network_limit()
    }

    fn view(&self) -> View {
        self.picture()
    }

    fn wall_positions(&self) -> [f64; 6] {
        self.walls.as_ref().map_or([0.0; 6], |walls| walls.position)
    }

    fn max_speed(&self) -> f64 {
        self.bodies.iter().map(speed::<S>).fold(0.0, f64::max)
    }

    fn set_motion(&mut self, changes: &[Motion]) {
        let mut slot_of = vec![0_usize; self.bodies.len()];
        for (slot, &particle) in self.original.iter().enumerate() {
            slot_of[particle as usize] = slot;
        }
        for change in changes {
            let body = &mut self.bodies[slot_of[change.particle]];
            let spin = if C::NEEDS_SPIN { change.spin } else { body.motion().1 };
            set_motion::<S>(body, change.velocity, spin);
        }
        // Budgets were made for the old speeds.
        self.refresh();
    }

    fn set_drag(&mut self, drag: Drag) {
        self.drag = drag;
        self.order_drag();
    }

    fn counters(&self) -> Counters {
        let touching = |list: &ContactList<S::Real>| {
            (0..list.count)
                .filter(|&k| (0..C::SLOTS).any(|slot| list.slot(k, slot) != S::Real::of(C::vacant(slot))))
                .count() as u64
        };
        let mut counters = Counters {
            particles: self.bodies.len() as u64,
            rebuilds: self.lists.rebuilds,
            refreshes: self.lists.refreshes,
            prolonged: self.lists.prolonged,
            threads: self.threads as u64,
            ..Counters::default()
        };
        if C::SLOTS == 0 {
            counters.contacts = self.probe().pairs.len() as u64;
            counters.wall_contacts = self.probe().walls.len() as u64;
        }
        let mut bytes = self.bodies.capacity() * size_of::<S::Body>()
            + self.forces.capacity() * size_of::<S::Force>()
            + self.gains.capacity() * size_of::<[S::Real; 4]>()
            + (self.lists.near_at.capacity() + self.lists.listed_at.capacity()) * size_of::<[f64; 3]>()
            + self.lists.budget.capacity() * size_of::<f64>()
            + (self.lists.near_below.0.capacity() + self.lists.near_below.1.capacity()) * size_of::<u32>()
            + self.lists.cells.bytes();
        for chunk in &self.chunks {
            if C::SLOTS > 0 {
                counters.contacts += touching(&chunk.inner) + touching(&chunk.outer);
                counters.wall_contacts += chunk.walls.iter().map(touching).sum::<u64>();
            }
            counters.listed_pairs += (chunk.inner.count + chunk.outer.count) as u64;
            counters.near_pairs += chunk.near.len() as u64;
            bytes += chunk.bytes();
        }
        counters.bytes = bytes as u64;
        counters
    }

    fn kernel(&self) -> String {
        format!("{};{}", Self::law_name(), self.path.name())
    }

    fn save(&self) -> Vec<u8> {
        self.persist()
    }
}
