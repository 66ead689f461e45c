//! What a run remembers beside the state of its particles: everything a checkpoint has to bring back.

use serde::{Deserialize, Serialize};

use crate::equilibrium::guard::Guard;
use crate::equilibrium::plan::Plan;
use crate::equilibrium::sample::Sample;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Status {
    /// Settled, and the energy and Z± stand still.
    Equilibrium,
    /// e stands still and the walls balance their load, the rest not yet.
    EConverged,
    /// The paper's ratio KE/E_el was met while e still drifts.
    KineticEnergy,
    /// The step limit came first.
    StepLimit,
}

impl Status {
    /// The word in the record.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Equilibrium => "equilibrium",
            Self::EConverged => "e_converged",
            Self::KineticEnergy => "kinetic_energy",
            Self::StepLimit => "step_limit",
        }
    }
}

/// Where a run is between start and end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// Undisturbed.
    Natural,
    /// Rolling kicks since `from`, until `until`.
    Rolling {
        /// Step at which e had settled.
        from: u64,
        /// Step at which the kicks end.
        until: u64,
    },
    /// Drag on all particles.
    Drag,
    /// Over.
    Finished(Status),
}

/// The state at the start or the end of the intervention, for the record.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Mark {
    /// Step.
    pub(crate) step: u64,
    /// Void ratio [1].
    pub(crate) e: f64,
    /// 2 N_pp/N [1].
    pub(crate) z: f64,
    /// Particles with exactly two contacts.
    pub(crate) with_two: u64,
}

impl From<&Sample> for Mark {
    fn from(sample: &Sample) -> Self {
        Self { step: sample.step, e: sample.e, z: sample.z, with_two: sample.with_two }
    }
}

/// Everything but the particles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    /// When the state is sampled.
    pub(crate) plan: Plan,
    /// Next sampled step.
    pub(crate) next_sample: u64,
    /// The series so far.
    pub(crate) samples: Vec<Sample>,
    /// Blow-up guard.
    pub(crate) guard: Guard,
    /// Phase of the run.
    pub(crate) phase: Phase,
    /// Expected steps and step limit.
    pub(crate) expected_steps: u64,
    /// See `expected_steps`.
    pub(crate) step_limit: u64,
    /// Largest time step allowed [τ]: halved by a retry.
    pub(crate) dt_cap: f64,
    /// Why the present time step is what it is.
    pub(crate) dt_reason: String,
    /// Z when the stability bound was last asked for [1].
    pub(crate) dt_bound_z: f64,
    /// Restarts with a smaller time step.
    pub(crate) retries: u32,
    /// Steps thrown away by restarts.
    pub(crate) abandoned: u64,
    /// What made a restart necessary.
    pub(crate) fault: Option<String>,
    /// Rolling kicks given.
    pub(crate) kicks: u64,
    /// Energy they put in [k_n d²].
    pub(crate) kick_energy: f64,
    /// State when the kicks began.
    pub(crate) kicks_began: Option<Mark>,
    /// State when the kicks ended.
    pub(crate) kicks_ended: Option<Mark>,
}

impl Memory {
    /// The time step was divided by `factor` at `step`: what was to be run in the rest of the time takes more steps.
    /// A step limit that the scene gives stays.
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "steps stay far below 2^53"
    )]
    pub(crate) fn stretch(&mut self, step: u64, factor: f64, limited: bool) {
        let stretched = |limit: u64| step + (limit.saturating_sub(step) as f64 * factor).ceil() as u64;
        self.expected_steps = stretched(self.expected_steps);
        if limited {
            self.expected_steps = self.expected_steps.min(self.step_limit);
        } else {
            self.step_limit = stretched(self.step_limit);
        }
    }
}
