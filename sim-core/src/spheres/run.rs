//! The run: steps between events, and what happens at each event.

use record::Row;
use scene::spheres::{Approach, ReducedSpheres, Stop};
use serde::{Deserialize, Serialize};

use super::memory::{Mark, Memory, Phase, Status};
use super::{kicks, outcome, start, system};
use crate::dem::{Drag, Dynamics, View};
use crate::equilibrium::evidence::{Evidence, evidence, judge};
use crate::equilibrium::guard::{self, Guard};
use crate::equilibrium::plan::Plan;
use crate::equilibrium::sample::Sample;
use crate::{Options, Progress, SimError, Simulation};

/// Version of the checkpoint of a run.
const CHECKPOINT_VERSION: u32 = 4;
/// Steps between looks where the scene gives a daring time step.
const DARING_EVERY: u64 = 10;
/// Given time step beyond which a run is looked at that often [τ]. Jammed networks have critical steps of 0.2 to 0.3 τ,
/// so such a step has no room for a network that grows between two samples.
const DARING_DT: f64 = 0.2;
/// Growth of Z after which the stability bound of the time step is asked for again [1].
const NETWORK_GROWTH: f64 = 0.5;

/// What limits the time step when it is no wall.
const NETWORK: &str = "the network";

/// A running scene of cohesive spheres.
pub(crate) struct Run {
    scene: ReducedSpheres,
    key: String,
    options: Options,
    dynamics: Box<dyn Dynamics>,
    memory: Memory,
}

/// A checkpoint: the memory of the run and the state of its particles.
#[derive(Serialize, Deserialize)]
struct Checkpoint {
    version: u32,
    scene_key: String,
    memory: Memory,
    dynamics: Vec<u8>,
}

impl Run {
    /// A run at its initial state.
    ///
    /// # Errors
    /// [`SimError::Scene`] when there is no initial state.
    pub(crate) fn new(scene: &ReducedSpheres, key: String, options: &Options) -> Result<Self, SimError> {
        let (dt_cap, dt_reason) = start::largest_dt(scene);
        let initial = start::initial_state(scene)?;
        let dynamics = system::new(&start::parameters(scene), &initial, dt_cap, options);
        let memory = first_memory(scene, dt_cap, dt_reason);
        let mut run = Self { scene: scene.clone(), key, options: *options, dynamics, memory };
        run.begin()?;
        Ok(run)
    }

    /// Continues from the bytes of [`Simulation::save`].
    ///
    /// # Errors
    /// [`SimError::Checkpoint`] when they are damaged or of another scene or version.
    pub(crate) fn restore(
        scene: &ReducedSpheres,
        key: String,
        options: &Options,
        bytes: &[u8],
    ) -> Result<Self, SimError> {
        let (digest, body) = bytes
            .split_at_checked(blake3::OUT_LEN)
            .ok_or_else(|| SimError::Checkpoint("shorter than its digest".to_owned()))?;
        if blake3::hash(body).as_bytes() != digest {
            return Err(SimError::Checkpoint("the digest does not fit: the bytes are damaged".to_owned()));
        }
        let saved: Checkpoint =
            postcard::from_bytes(body).map_err(|error| SimError::Checkpoint(error.to_string()))?;
        if saved.version != CHECKPOINT_VERSION {
            return Err(SimError::Checkpoint(format!(
                "version {}, this program reads {CHECKPOINT_VERSION}",
                saved.version
            )));
        }
        if saved.scene_key != key {
            return Err(SimError::Checkpoint(format!("of scene {}, not {key}", saved.scene_key)));
        }
        let dynamics = system::restore(&start::parameters(scene), &saved.dynamics, options)?;
        Ok(Self { scene: scene.clone(), key, options: *options, dynamics, memory: saved.memory })
    }

    /// Samples the initial state.
    fn begin(&mut self) -> Result<(), SimError> {
        let view = self.dynamics.view();
        if let Err(what) = self.look(&view) {
            return Err(SimError::Internal(format!("the initial state is not sane: {what}")));
        }
        self.memory.samples.push(Sample::of(&view, self.dynamics.dt()));
        Ok(())
    }

    fn finished(&self) -> Option<Status> {
        match self.memory.phase {
            Phase::Finished(status) => Some(status),
            _ => None,
        }
    }

    /// The next step at which something is looked at or done.
    fn next_event(&self) -> u64 {
        let step = self.dynamics.steps();
        let mut next = self.memory.next_sample.min(self.memory.step_limit);
        let looks = if self.daring() { DARING_EVERY } else { guard::EVERY };
        next = next.min((step / looks + 1) * looks);
        if let Phase::Rolling { from, until } = self.memory.phase {
            next = next.min(from + ((step - from) / kicks::EVERY + 1) * kicks::EVERY).min(until);
        }
        next
    }

    /// Whether the scene gives a step beyond [`DARING_DT`].
    fn daring(&self) -> bool {
        self.scene.dt.is_some_and(|dt| dt > DARING_DT)
    }

    /// Everything that is due at the present step.
    fn event(&mut self) -> Result<(), String> {
        let step = self.dynamics.steps();
        let view = self.dynamics.view();
        self.look(&view)?;
        if self.daring() {
            self.adapt_dt(self.dynamics.critical_dt(), NETWORK);
        }
        if step == self.memory.next_sample || step == self.memory.step_limit {
            self.sample(&view);
        }
        if let Phase::Rolling { from, until } = self.memory.phase {
            if step >= until {
                self.end_kicks(&view);
            } else if step > from && (step - from).is_multiple_of(kicks::EVERY) {
                self.kick(&view);
            }
        }
        Ok(())
    }

    fn look(&mut self, view: &View) -> Result<(), String> {
        let adhesion = self.scene.adhesion;
        self.memory.guard.look(view, adhesion, adhesion * self.scene.wall_adhesion)
    }

    fn sample(&mut self, view: &View) {
        let step = view.step;
        let sample = Sample::of(view, self.dynamics.dt());
        // the bound costs some forty steps, so it is asked for only when the network has grown
        if sample.z >= self.memory.dt_bound_z + NETWORK_GROWTH {
            self.memory.dt_bound_z = sample.z;
            self.adapt_dt(self.dynamics.critical_dt(), NETWORK);
        }
        self.adapt_dt(start::walls_limit(&self.scene, view), "a wall on its contacts");
        self.memory.samples.push(sample);
        self.memory.next_sample = self.memory.plan.after(step);
        let found = self.evidence();
        let (verdict, fired) = judge(&self.scene.stop, &found);
        match (self.scene.approach, self.memory.phase) {
            (Approach::Natural, Phase::Natural) if verdict.stop => self.finish(&found),
            (Approach::RollingKicks, Phase::Natural) if verdict.settled && self.scene.adhesion > 0.0 => {
                self.begin_kicks(view);
            }
            (Approach::RollingKicks, Phase::Natural) if verdict.settled => self.begin_drag(),
            (_, Phase::Drag) if fired.ke && self.scene.stop != Stop::Steps => self.finish(&found),
            _ => {}
        }
        if step >= self.memory.step_limit && self.finished().is_none() {
            self.finish(&found);
        }
    }

    /// Lowers the time step when the network has become stiffer; never raises it. A step that the scene gives is
    /// kept up to the critical one: beyond it friction turns the unstable modes into noise that no look at the energy
    /// finds, and the packing comes out far too dense.
    fn adapt_dt(&mut self, critical: f64, of: &str) {
        let before = self.dynamics.dt();
        if self.scene.dt.is_some() && before <= critical {
            return;
        }
        let safe = start::safe_dt(self.memory.dt_cap, critical);
        if safe < before {
            self.dynamics.set_dt(safe);
            self.memory.dt_reason = format!("stiffest mode of {of}: critical time step {critical:.4} τ");
            self.memory.stretch(self.dynamics.steps(), before / safe, self.scene.max_steps.is_some());
        }
    }

    fn begin_kicks(&mut self, view: &View) {
        let step = view.step;
        self.memory.kicks_began = self.memory.samples.last().map(Mark::from);
        self.memory.phase = Phase::Rolling { from: step, until: 2 * step };
        self.kick(view);
    }

    fn kick(&mut self, view: &View) {
        let (motions, contacts) = kicks::kicks(view, self.scene.adhesion, self.scene.seed, self.memory.kicks);
        let energy = kicks::added_energy(view, &motions);
        self.memory.guard.inject(energy);
        self.memory.kick_energy += energy;
        self.memory.kicks += 1;
        self.dynamics.set_motion(&motions);
        self.dynamics.set_drag(Drag::Each(kicks::drag_rates(&contacts)));
    }

    fn end_kicks(&mut self, view: &View) {
        self.memory.kicks_ended = Some(Mark::from(&Sample::of(view, self.dynamics.dt())));
        self.begin_drag();
    }

    fn begin_drag(&mut self) {
        self.memory.phase = Phase::Drag;
        self.dynamics.set_drag(Drag::All(kicks::DRAG));
    }

    fn evidence(&self) -> Evidence {
        evidence(&self.memory.samples, start::driven(&self.scene))
    }

    fn finish(&mut self, found: &Evidence) {
        let (verdict, fired) = judge(&self.scene.stop, found);
        // kicks drive Z±, so that their drift says nothing after an intervention: the end of the drag does
        let still = verdict.equilibrium || (self.memory.phase == Phase::Drag && verdict.settled && fired.ke);
        let status = if still {
            Status::Equilibrium
        } else if verdict.settled {
            Status::EConverged
        } else if verdict.stop {
            Status::KineticEnergy
        } else {
            Status::StepLimit
        };
        self.memory.phase = Phase::Finished(status);
    }

    /// Starts again from the initial state with half the time step, once.
    fn retry(&mut self, step: u64, what: String) -> Result<(), SimError> {
        let halved = 0.5 * self.memory.dt_cap;
        if self.memory.retries > 0 {
            return Err(SimError::Unstable { step, what, retried_dt: self.memory.dt_cap });
        }
        let initial = start::initial_state(&self.scene)?;
        self.dynamics = system::new(&start::parameters(&self.scene), &initial, halved, &self.options);
        let reason = format!("half of the time step that failed: {what}");
        let mut memory = first_memory(&self.scene, halved, reason);
        memory.retries = 1;
        memory.abandoned = step;
        memory.fault = Some(format!("step {step}: {what}"));
        self.memory = memory;
        self.begin()
    }
}

fn first_memory(scene: &ReducedSpheres, dt_cap: f64, dt_reason: String) -> Memory {
    let (expected_steps, step_limit) = scene.steps(dt_cap);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive count, saturating"
    )]
    let plan = Plan::new((scene.settling_time() / dt_cap) as u64);
    Memory {
        plan,
        next_sample: plan.after(0),
        samples: Vec::new(),
        guard: Guard::default(),
        phase: Phase::Natural,
        expected_steps,
        step_limit,
        dt_cap,
        dt_reason,
        dt_bound_z: 0.0,
        retries: 0,
        abandoned: 0,
        fault: None,
        kicks: 0,
        kick_energy: 0.0,
        kicks_began: None,
        kicks_ended: None,
    }
}

impl Simulation for Run {
    fn advance(&mut self, steps: u64) -> Result<Progress, SimError> {
        let mut left = steps;
        while left > 0 && self.finished().is_none() {
            let event = self.next_event();
            let begun = self.dynamics.steps();
            let slice = left.min(event - begun);
            let outcome = self.dynamics.run(slice);
            left -= slice;
            let outcome = match outcome {
                Ok(()) if self.dynamics.steps() == event => self.event().map_err(|what| (event, what)),
                Ok(()) => Ok(()),
                Err(fault) => Err((fault.step, fault.what)),
            };
            if let Err((step, what)) = outcome {
                self.retry(step, what)?;
            }
        }
        Ok(self.progress())
    }

    #[expect(clippy::cast_precision_loss, reason = "steps stay far below 2^53")]
    fn progress(&self) -> Progress {
        let finished = self.finished().is_some();
        let step = self.dynamics.steps();
        let steps = self.memory.abandoned + step;
        let expected = if finished { steps } else { self.memory.expected_steps.max(step + step / 10) };
        let mut live = Row::new();
        if let Some(sample) = self.memory.samples.last() {
            let ratio = if sample.elastic > 0.0 { sample.kinetic / sample.elastic } else { 0.0 };
            for (name, value) in [("e", sample.e), ("z", sample.z), ("ke_over_eel", ratio), ("dt", sample.dt)]
            {
                // a live number that is not finite is left out; the guard speaks up at its next look
                let _ = live.number(name, value);
            }
        }
        Progress {
            steps,
            expected_steps: expected,
            fraction: if finished { 1.0 } else { (steps as f64 / expected.max(1) as f64).min(0.99) },
            finished,
            particles: self.scene.n,
            live,
        }
    }

    fn outcome(&self) -> Result<record::Outcome, SimError> {
        outcome::outcome(&self.scene, &self.key, self.dynamics.as_ref(), &self.memory)
    }

    fn save(&self) -> Vec<u8> {
        let checkpoint = Checkpoint {
            version: CHECKPOINT_VERSION,
            scene_key: self.key.clone(),
            memory: self.memory.clone(),
            dynamics: self.dynamics.save(),
        };
        let body = postcard::to_stdvec(&checkpoint).expect("a checkpoint is plain data");
        let mut bytes = blake3::hash(&body).as_bytes().to_vec();
        bytes.extend(body);
        bytes
    }

    fn kernel(&self) -> String {
        self.dynamics.kernel()
    }
}
