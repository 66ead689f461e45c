//! The run: phases, equilibrium search, recorded states.

use record::Row;
use scene::discs::{Assembly, ReducedDiscs};
use serde::{Deserialize, Serialize};

use super::assemble::{assembly_mass, initial_state, parameters, pressure_control};
use super::measure::{Measured, ZERO_FORCE, load_rules, measure};
use super::scales::Scales;
use crate::boundary::CellControl;
use crate::dem::{CellDynamics, CellResiduals, Counters, Drag, Fault, discs, restore_discs};
use crate::loading::{Equilibrium, Leg, LoadingPath, PathState, Residuals, Stage, Tolerances, Verdict};
use crate::observables::disc_contacts::{DiscContact, clusters, load_carrying};
use crate::{Options, Progress, SimError, Simulation};

/// Steps between two looks at the state. Part of the definition of the result: phases change at multiples of it.
const CHECK_EVERY: u64 = 250;

/// Checks between two points of the time series.
const CHECKS_PER_POINT: u64 = 8;

/// Normal force beyond which the state makes no sense: overlaps of 5 % of the largest diameter [K_N a].
const LARGEST_FORCE: f64 = 0.05;

/// The drag acts when the final stage has lasted so long [T0]: the equilibration time of slow steps in the paper
/// (section II D 2).
const DRAG_AFTER: f64 = 100.0;

/// What the run is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Type 2: discs fly and stick in a fixed cell.
    Aggregation,
    /// Type 2: equilibrium at P = 0.
    Rest,
    /// Equilibrium at a pressure of the path.
    Path(usize),
    /// The whole path is done.
    Done,
    /// A state did not come to rest in time.
    NotConverged,
}

impl Phase {
    /// Whether the run is over.
    #[must_use]
    pub fn is_over(self) -> bool {
        matches!(self, Self::Done | Self::NotConverged)
    }
}

/// A recorded state.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Columns.
    pub row: Row,
    /// |k| and I(k) [1/a, a²].
    pub scattering: Vec<[f64; 2]>,
    /// Normal forces: middle of bin and density.
    pub histogram: Vec<[f64; 2]>,
}

/// What the driver keeps beside the discs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// What the run is doing.
    pub phase: Phase,
    /// Step at which the phase began.
    pub phase_start: u64,
    /// Whether local damping acts.
    pub final_stage: bool,
    /// Checks of this phase with damping on.
    pub damped_checks: u64,
    /// Interacting pairs of the last recorded state.
    pub pairs: Option<Vec<(u32, u32)>>,
    /// Time series: t, P, Φ, z, kinetic energy per disc.
    pub series: Vec<[f64; 5]>,
    /// Time at the start of the phase [τ].
    pub phase_time: f64,
    /// Whether the time step was halved after a fault.
    pub rescued: bool,
}

/// A running consolidation.
pub struct Consolidation {
    pub(super) scene: ReducedDiscs,
    pub(super) key: String,
    pub(super) options: Options,
    pub(super) radii: Vec<f64>,
    pub(super) path: Vec<PathState>,
    pub(super) dem: Box<dyn CellDynamics>,
    pub(super) search: Equilibrium,
    pub(super) course: Course,
    pub(super) states: Vec<State>,
    /// Particles at the start of the phase, to try again from with a smaller step.
    pub(super) fallback: Vec<u8>,
}

impl Consolidation {
    /// Starts from the hard-disc fluid; `key` is the scene key.
    ///
    /// # Errors
    /// [`SimError::Scene`] when the fluid cannot be made.
    pub fn new(scene: &ReducedDiscs, key: String, options: &Options) -> Result<Self, SimError> {
        let initial = initial_state(scene)?;
        let phase = if scene.assembly == Assembly::Type2 { Phase::Aggregation } else { Phase::Path(0) };
        let dem = discs(&parameters(scene), &initial, scene.dt, options);
        let course = Course {
            phase,
            phase_start: 0,
            final_stage: false,
            damped_checks: 0,
            pairs: None,
            series: Vec::new(),
            phase_time: 0.0,
            rescued: false,
        };
        Ok(Self::assemble(scene, key, options, initial.radii, dem, course, Vec::new(), None))
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of a run, each of its own type")]
    pub(super) fn assemble(
        scene: &ReducedDiscs,
        key: String,
        options: &Options,
        radii: Vec<f64>,
        dem: Box<dyn CellDynamics>,
        course: Course,
        states: Vec<State>,
        fallback: Option<Vec<u8>>,
    ) -> Self {
        let legs: Vec<Leg> =
            scene.path.iter().map(|leg| Leg { target: leg.to, per_decade: leg.per_decade }).collect();
        let stage = if course.final_stage { Stage::Final } else { Stage::Natural };
        let fallback = fallback.unwrap_or_else(|| dem.save());
        Self {
            scene: scene.clone(),
            key,
            options: *options,
            radii,
            path: LoadingPath::new(scene.p0, &legs).states().to_vec(),
            dem,
            search: Equilibrium::resume(Tolerances::default().scaled(scene.tolerance), stage),
            course,
            states,
            fallback,
        }
    }

    /// Imposed pressure of the present phase, P* (P/K_N without cohesion).
    pub(super) fn pressure(&self) -> f64 {
        match self.course.phase {
            Phase::Aggregation | Phase::Rest => 0.0,
            Phase::Path(index) => self.path[index].pressure,
            Phase::Done | Phase::NotConverged => self.last_pressure(),
        }
    }

    fn last_pressure(&self) -> f64 {
        let last = self.states.last().and_then(|state| state.row.real("p"));
        last.unwrap_or(self.scene.p0)
    }

    fn scales(&self) -> Scales {
        // At P = 0 the cohesive scales hold; without cohesion that phase does not exist.
        Scales::of(&self.scene, self.pressure())
    }

    /// Looks at the state and takes the next decision.
    fn check(&mut self) -> Result<(), SimError> {
        let measured = self.dem.residuals();
        if let Some(&(i, j, force)) = measured.pairs.iter().find(|pair| !(..LARGEST_FORCE).contains(&pair.2))
        {
            return self.rescue(format!("normal force {force:.3e} K_N a between discs {i} and {j}"));
        }
        if self.dem.steps().is_multiple_of(CHECK_EVERY * CHECKS_PER_POINT) {
            self.note(&measured);
        }
        match self.course.phase {
            Phase::Aggregation => {
                let pairs = measured.pairs.iter().map(|&(i, j, _)| (i, j));
                if clusters(self.radii.len(), pairs) == 1 {
                    self.begin(Phase::Rest);
                    return Ok(());
                }
            }
            Phase::Rest | Phase::Path(_) => {
                let residuals = self.residuals(&measured);
                match self.search.check(&residuals) {
                    Verdict::Reached => {
                        self.record(&residuals, true)?;
                        self.begin_next();
                        return Ok(());
                    }
                    Verdict::Continue(stage) => self.set_stage(stage),
                }
            }
            Phase::Done | Phase::NotConverged => return Ok(()),
        }
        let waited = (self.dem.time() - self.course.phase_time) / self.scales().time;
        if waited > self.scene.max_time {
            let residuals = self.residuals(&measured);
            self.record(&residuals, false)?;
            self.course.phase = Phase::NotConverged;
        }
        Ok(())
    }

    fn set_stage(&mut self, stage: Stage) {
        let damped = stage == Stage::Final && self.scene.final_damping > 0.0;
        if damped != self.course.final_stage {
            self.dem.set_local_damping(if damped { self.scene.final_damping } else { 0.0 });
            self.course.final_stage = damped;
        }
        self.course.damped_checks += u64::from(damped);
        let (lasted, unit) =
            ((self.course.damped_checks * CHECK_EVERY) as f64 * self.dem.dt(), self.scales().time);
        let late = damped && self.scene.final_drag > 0.0 && lasted > DRAG_AFTER * unit;
        self.dem.set_drag(if late { Drag::All(self.scene.final_drag / unit) } else { Drag::None });
    }

    fn begin_next(&mut self) {
        let next = match self.course.phase {
            Phase::Rest => Phase::Path(0),
            Phase::Path(index) if index + 1 < self.path.len() => Phase::Path(index + 1),
            _ => Phase::Done,
        };
        self.begin(next);
    }

    fn begin(&mut self, phase: Phase) {
        self.course.phase = phase;
        self.course.phase_start = self.dem.steps();
        self.course.phase_time = self.dem.time();
        self.course.damped_checks = 0;
        self.course.final_stage = false;
        self.search = Equilibrium::new(Tolerances::default().scaled(self.scene.tolerance));
        self.dem.set_local_damping(0.0);
        self.dem.set_drag(Drag::None);
        let control = match phase {
            Phase::Aggregation => CellControl::Fixed,
            Phase::Rest => pressure_control(&self.scene, 0.0, self.scene.cell_mass),
            Phase::Path(0) => {
                pressure_control(&self.scene, self.path[0].pressure, assembly_mass(&self.scene, &self.radii))
            }
            Phase::Path(index) => {
                pressure_control(&self.scene, self.path[index].pressure, self.scene.cell_mass)
            }
            Phase::Done | Phase::NotConverged => return,
        };
        self.dem.set_control(control);
        self.fallback = self.dem.save();
    }

    /// Residuals in units of F1 and a.
    fn residuals(&self, measured: &CellResiduals) -> Residuals {
        let scales = self.scales();
        let largest = |values: &[f64]| {
            values.iter().copied().fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a })
        };
        let deviation = |stress: f64| (stress - scales.pressure).abs();
        Residuals {
            force: largest(&measured.forces) / scales.f1,
            moment: largest(&measured.moments) / scales.f1,
            stress: deviation(measured.stress[0]).max(deviation(measured.stress[1])) / scales.f1,
            kinetic: self.kinetic(measured, &scales) / scales.f1,
            sliding: measured.sliding,
        }
    }

    /// Kinetic energy per disc; rattlers of cohesionless packings drift on for ever and are left out.
    fn kinetic(&self, measured: &CellResiduals, scales: &Scales) -> f64 {
        let count = measured.kinetic.len() as f64;
        if self.scene.f0 > 0.0 {
            return measured.kinetic.iter().sum::<f64>() / count;
        }
        let contacts: Vec<DiscContact> = measured
            .pairs
            .iter()
            .map(|&(i, j, normal)| DiscContact {
                i,
                j,
                gap: 0.0,
                branch: [0.0; 2],
                normal,
                tangential: 0.0,
                rolling: 0.0,
            })
            .collect();
        let holds = |contact: &DiscContact| contact.normal > ZERO_FORCE * scales.f1;
        let carries = load_carrying(measured.kinetic.len(), &contacts, load_rules(&self.scene).needed, holds);
        let energies = measured.kinetic.iter().zip(&carries);
        let sum: f64 = energies.filter(|&(_, &carried)| carried).map(|(energy, _)| energy).sum();
        // Before anything carries load everything that moves counts.
        if carries.contains(&true) { sum / count } else { measured.kinetic.iter().sum::<f64>() / count }
    }

    fn record(&mut self, residuals: &Residuals, converged: bool) -> Result<(), SimError> {
        let scales = self.scales();
        let picture = self.dem.picture();
        let internal =
            |error: record::NotFinite| SimError::Internal(format!("observable of a state: {error}"));
        let Measured { mut row, shells, histogram, pairs } =
            measure(&self.scene, &scales, &picture, self.course.pairs.as_deref()).map_err(internal)?;
        let (name, leg) = match self.course.phase {
            Phase::Path(0) => ("assembly", 0),
            Phase::Path(index) => (self.path[index].branch.name(), self.path[index].leg),
            Phase::Aggregation => ("aggregation", 0),
            _ => ("rest", 0),
        };
        let whole = |number: u64| i64::try_from(number).unwrap_or(i64::MAX);
        row.put("state", whole(self.states.len() as u64))
            .put("branch", name)
            .put("leg", whole(leg as u64))
            .put("converged", converged)
            .put("steps", whole(self.dem.steps() - self.course.phase_start))
            .put("sliding", whole(residuals.sliding as u64))
            .put("damped_share_steps", whole(self.course.damped_checks * CHECK_EVERY));
        let time = (self.dem.time() - self.course.phase_time) / scales.time;
        let critical = self.dem.critical_dt();
        row.number("p", self.pressure())
            .and_then(|row| row.number("time", time))
            .and_then(|row| row.number("residual_force", residuals.force))
            .and_then(|row| row.number("residual_moment", residuals.moment))
            .and_then(|row| row.number("residual_stress", residuals.stress))
            .and_then(|row| row.number("residual_kinetic", residuals.kinetic))
            .map_err(internal)?;
        if critical.is_finite() {
            row.number("dt_over_critical", self.dem.dt() / critical).map_err(internal)?;
        }
        let scattering = shells.iter().map(|shell| [shell.wavenumber, shell.intensity]).collect();
        self.states.push(State { row, scattering, histogram });
        self.course.pairs = Some(pairs);
        Ok(())
    }

    fn note(&mut self, measured: &CellResiduals) {
        let area = self.dem.cell().area();
        let solid: f64 = self.radii.iter().map(|r| core::f64::consts::PI * r * r).sum();
        let count = self.radii.len() as f64;
        let scales = self.scales();
        self.course.series.push([
            self.dem.time() / scales.time,
            self.pressure(),
            solid / area,
            2.0 * measured.pairs.len() as f64 / count,
            measured.kinetic.iter().sum::<f64>() / count / scales.f1,
        ]);
    }

    /// Goes back to the start of the phase with half the time step, once.
    fn rescue(&mut self, what: String) -> Result<(), SimError> {
        let dt = 0.5 * self.scene.dt;
        if self.course.rescued {
            return Err(SimError::Unstable { step: self.dem.steps(), what, retried_dt: dt });
        }
        let mut dem = restore_discs(&parameters(&self.scene), &self.radii, &self.fallback, &self.options)?;
        dem.set_dt(dt);
        self.dem = dem;
        self.course.rescued = true;
        self.course.final_stage = false;
        self.dem.set_local_damping(0.0);
        self.search = Equilibrium::new(Tolerances::default().scaled(self.scene.tolerance));
        Ok(())
    }

    /// Live numbers.
    fn live(&self) -> Row {
        let mut row = Row::new();
        let solid: f64 = self.radii.iter().map(|r| core::f64::consts::PI * r * r).sum();
        // A number that is not finite is left out.
        let _ = row.number("phi", solid / self.dem.cell().area());
        let _ = row.number("p", self.pressure());
        row.put("states", i64::try_from(self.states.len()).unwrap_or(i64::MAX));
        row
    }

    /// Rows of the states recorded so far.
    #[must_use]
    pub fn state_rows(&self) -> Vec<Row> {
        self.states.iter().map(|state| state.row.clone()).collect()
    }

    /// Sizes of the present state: contacts, listed and near pairs.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.dem.counters()
    }

    fn expected_states(&self) -> usize {
        self.path.len() + usize::from(self.scene.assembly == Assembly::Type2)
    }
}

impl Simulation for Consolidation {
    fn advance(&mut self, steps: u64) -> Result<Progress, SimError> {
        let mut left = steps;
        while left > 0 && !self.course.phase.is_over() {
            let due = CHECK_EVERY - self.dem.steps() % CHECK_EVERY;
            let slice = left.min(due);
            if let Err(Fault { what, .. }) = self.dem.run(slice) {
                self.rescue(what)?;
                left -= slice;
                continue;
            }
            left -= slice;
            if self.dem.steps().is_multiple_of(CHECK_EVERY) {
                self.check()?;
            }
        }
        Ok(self.progress())
    }

    fn progress(&self) -> Progress {
        let steps = self.dem.steps();
        let finished = self.course.phase.is_over();
        let done = self.states.len() as f64 / self.expected_states() as f64;
        let expected = self.scene.expected_steps();
        // States are unequal: the better of "states done" and "steps of the estimate".
        let fraction = if finished { 1.0 } else { done.max(steps as f64 / expected as f64 * 0.5).min(0.99) };
        Progress {
            steps,
            expected_steps: if finished { steps } else { expected.max(steps) },
            fraction,
            finished,
            particles: self.radii.len() as u64,
            live: self.live(),
        }
    }

    fn outcome(&self) -> Result<record::Outcome, SimError> {
        self.outcome_now()
    }

    fn save(&self) -> Vec<u8> {
        self.to_checkpoint()
    }

    fn kernel(&self) -> String {
        self.dem.kernel()
    }
}
