//! A running scene of plastic discs.

mod checkpoint;
mod outcome;

use std::collections::VecDeque;

use record::{Outcome, Row};
use scene::plastic::{Contact, Method, ReducedPlastic, Setup, Variant};
use serde::{Deserialize, Serialize};

use super::explicit::{Explicit, flush};
use super::implicit::Implicit;
use super::observe::network::Impulses;
use super::observe::state::{Mark, State, View};
use super::setup::{BOTTOM, Scenery, TOP, build};
use super::world::World;
use crate::{Options, Progress, SimError, Simulation};

/// Crossings of the largest disc by an S-wave over which wall forces of an assembly are averaged.
const WINDOW: f64 = 3.0;

/// Everything that is measured on the way; part of a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Log {
    steps: u64,
    states: Vec<State>,
    marks: VecDeque<Mark>,
    /// Time step until the next record.
    dt: f64,
    /// Impulses of the interval before the last state.
    last_network: Impulses,
    last_interval: f64,
    since: f64,
    next_strain: f64,
    finished: bool,
    status: String,
}

/// How a step is made; scratch space alone, nothing that a run depends on.
enum Solver {
    Implicit(Box<Implicit>),
    Explicit(Box<Explicit>),
}

impl Solver {
    fn new(scene: &ReducedPlastic, world: &World) -> Self {
        match scene.method {
            Method::Implicit => Self::Implicit(Box::new(Implicit::new(world))),
            Method::Explicit => Self::Explicit(Box::new(Explicit::new(world))),
        }
    }

    /// The step until the next record: as the scene has it, and within the stable one.
    fn time_step(&self, scene: &ReducedPlastic, world: &World) -> f64 {
        let speed = closing_speed(world);
        match self {
            Self::Implicit(_) => scene.time_step_at(speed),
            Self::Explicit(explicit) => scene.whole_step(explicit.time_step(world), speed),
        }
    }
}

/// Speed at which the box closes.
fn closing_speed(world: &World) -> f64 {
    world.walls[BOTTOM].velocity[1] - world.walls[TOP].velocity[1]
}

/// The simulation.
pub struct PlasticDiscs {
    scene: ReducedPlastic,
    world: World,
    width: f64,
    height: f64,
    window: f64,
    log: Log,
    solver: Solver,
    pool: Option<rayon::ThreadPool>,
}

impl PlasticDiscs {
    /// Builds a scene.
    ///
    /// # Errors
    /// [`SimError::Scene`] when the scene cannot be built.
    pub fn new(scene: &ReducedPlastic, options: &Options) -> Result<Self, SimError> {
        let Scenery { world, width, height } = build(scene)?;
        let window = if scene.setup == Setup::Assembly {
            WINDOW / (world.law.material.shear() / world.law.material.density).sqrt()
        } else if scene.method == Method::Explicit {
            // the last step alone shows the noise of single impacts
            scene.strain_step * height / scene.wall_speed
        } else {
            0.0
        };
        let solver = Solver::new(scene, &world);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(options.threads.max(1))
            .build()
            .map_err(|error| SimError::Internal(format!("thread pool: {error}")))?;
        let dt = solver.time_step(scene, &world);
        let log = Log { next_strain: scene.strain_step, dt, ..Log::default() };
        Ok(Self { scene: scene.clone(), world, width, height, window, log, solver, pool: Some(pool) })
    }

    /// The world, to look at.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The states recorded so far.
    #[must_use]
    pub fn states(&self) -> &[State] {
        &self.log.states
    }

    fn step(&mut self) -> Result<(), SimError> {
        let step = self.log.steps + 1;
        let done = match &mut self.solver {
            Solver::Implicit(solver) => solver.step(&mut self.world, self.log.dt),
            Solver::Explicit(solver) => solver.step(&mut self.world, self.log.dt),
        };
        done.map_err(|failure| SimError::NotConverged { step, what: failure.to_string() })?;
        self.log.steps = step;
        self.pace();
        let strain = self.strain();
        if strain >= self.log.next_strain * (1.0 - 1e-9) || strain >= self.scene.strain_end * (1.0 - 1e-9) {
            self.record(strain);
        }
        Ok(())
    }

    /// The speed of the walls in the next step, if the scene has a programme. It follows the bound within the time an
    /// S-wave takes through the box, so that a change is no shock.
    fn pace(&mut self) {
        let Some(pace) = self.scene.pace else { return };
        let elastic = self.log.states.last().map_or(0.0, |state| state.elastic);
        let mass: f64 = self.world.bodies.iter().flat_map(|body| &body.mass).sum();
        let allowed = (6.0 * pace.ratio * elastic / mass).sqrt().min(self.scene.wall_speed).max(pace.speed);
        let material = &self.world.law.material;
        let crossing = self.height / (material.shear() / material.density).sqrt();
        let speed = closing_speed(&self.world);
        let share = (self.world.last_dt / crossing).min(1.0);
        let factor = (speed + share * (allowed - speed)) / speed;
        for wall in &mut self.world.walls {
            wall.velocity = wall.velocity.map(|v| v * factor);
        }
    }

    fn strain(&self) -> f64 {
        let walls = &self.world.walls;
        1.0 - (walls[TOP].point[1] - walls[BOTTOM].point[1]) / self.height
    }

    /// The present state of affairs with the contact impulses of the interval before the last record.
    fn view(&self) -> View<'_> {
        View {
            world: &self.world,
            width: self.width,
            height: self.height,
            marks: &self.log.marks,
            window: self.window,
            network: &self.log.last_network,
            interval: self.log.last_interval,
        }
    }

    fn record(&mut self, strain: f64) {
        let interval = self.world.time - self.log.since;
        if let Solver::Explicit(_) = self.solver {
            let World { memory, network, impulses, .. } = &mut self.world;
            flush(&mut memory.slots, network);
            let bearing = memory.slots.iter().filter(|slot| slot.impulse != [0.0; 2]);
            *impulses = bearing.map(|slot| (slot.key, slot.impulse)).collect();
        }
        self.log.last_network = std::mem::take(&mut self.world.network);
        self.log.last_interval = interval;
        let state = self.view().state(self.log.steps);
        self.log.marks.push_back(Mark { time: self.world.time, impulse: self.world.wall_impulse.clone() });
        while self.log.marks.len() > 2 && self.log.marks[1].time < self.world.time - self.window {
            self.log.marks.pop_front();
        }
        self.log.since = self.world.time;
        while self.log.next_strain <= strain * (1.0 + 1e-9) {
            self.log.next_strain += self.scene.strain_step;
        }
        let phi_reached = self.scene.phi_end.is_some_and(|phi| state.phi >= phi);
        if phi_reached || strain >= self.scene.strain_end * (1.0 - 1e-9) {
            self.log.finished = true;
            self.log.status = if phi_reached { "phi_reached" } else { "strain_reached" }.to_owned();
        }
        self.log.states.push(state);
        self.log.dt = self.solver.time_step(&self.scene, &self.world);
    }

    /// Steps the whole run is expected to take, from the strain covered so far.
    fn expected_steps(&self) -> u64 {
        let strain = self.strain();
        let whole = self.scene.expected_strain();
        if self.log.finished {
            self.log.steps
        } else if strain > 0.02 * whole && self.log.steps > 0 {
            let estimate = self.log.steps as f64 * whole / strain;
            (estimate as u64).max(self.log.steps + 1)
        } else {
            self.scene.expected_steps().max(self.log.steps + 1)
        }
    }
}

impl Simulation for PlasticDiscs {
    fn advance(&mut self, steps: u64) -> Result<Progress, SimError> {
        let pool = self.pool.take().expect("put back below");
        let result = pool.install(|| {
            for _ in 0..steps {
                if self.log.finished {
                    break;
                }
                self.step()?;
            }
            Ok(())
        });
        self.pool = Some(pool);
        result.map(|()| self.progress())
    }

    fn progress(&self) -> Progress {
        let mut live = Row::new();
        if let Some(state) = self.log.states.last() {
            for (name, value) in [("phi", state.phi), ("sigma", state.sigma), ("z", state.z)] {
                // a value that is not finite is left out here and refused in the outcome
                let _ = live.number(name, value);
            }
        }
        let expected_steps = self.expected_steps();
        let fraction =
            if self.log.finished { 1.0 } else { (self.log.steps as f64 / expected_steps as f64).min(1.0) };
        Progress {
            steps: self.log.steps,
            expected_steps,
            fraction,
            finished: self.log.finished,
            particles: self.world.bodies.iter().map(|body| body.template.point_count() as u64).sum(),
            live,
        }
    }

    fn outcome(&self) -> Result<Outcome, SimError> {
        outcome::outcome(self).map_err(|what| SimError::Internal(format!("outcome: {what}")))
    }

    fn save(&self) -> Vec<u8> {
        checkpoint::save(self)
    }

    fn kernel(&self) -> String {
        kernel(&self.scene)
    }
}

/// Name of the kernel of a scene.
pub(super) fn kernel(scene: &ReducedPlastic) -> String {
    let friction = if scene.mu > 0.0 { "coulomb" } else { "frictionless" };
    let material = if scene.sigma_y.is_some() { "von_mises" } else { "elastic" };
    let bar = if scene.f_bar { "+f_bar" } else { "" };
    let method = match scene.method {
        Method::Implicit => "implicit",
        Method::Explicit => "explicit",
    };
    let variant = match scene.variant {
        Variant::TotalBilinear => "total_lagrangian+bilinear",
        Variant::TotalCubic => "total_lagrangian+cubic",
        Variant::UpdatedCubic => "updated_lagrangian+cubic",
    };
    let contact = match scene.contact {
        Contact::Markers => "markers",
        Contact::CommonMesh => "common_mesh",
    };
    format!("mpm2d+{variant}{bar}+{material}+{method}+{contact}+{friction}")
}

/// Continues from a checkpoint.
///
/// # Errors
/// [`SimError::Checkpoint`] when the bytes are damaged or belong to another scene.
pub fn restore(scene: &ReducedPlastic, options: &Options, bytes: &[u8]) -> Result<PlasticDiscs, SimError> {
    let mut simulation = PlasticDiscs::new(scene, options)?;
    checkpoint::load(&mut simulation, bytes)?;
    simulation.solver = Solver::new(scene, &simulation.world);
    Ok(simulation)
}
