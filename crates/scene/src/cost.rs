//! How long a run takes, before it runs: to schedule long runs first and to answer dry runs.

use crate::Reduced;

/// Estimated work of one run. Estimates are pure functions of the reduced scene: the same on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Expected steps.
    pub steps: u64,
    /// Expected steps times particles (or material points).
    pub particle_steps: f64,
    /// Expected wall time on one core of a current machine [s].
    pub seconds: f64,
}

impl Cost {
    /// Work of `steps` steps of `particles` particles at `nanoseconds` each, with `overhead` seconds for packing and
    /// observables.
    #[must_use]
    pub fn of(steps: u64, particles: u64, nanoseconds: f64, overhead: f64) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "an estimate")]
        let particle_steps = steps as f64 * particles as f64;
        Self { steps, particle_steps, seconds: particle_steps * nanoseconds * 1e-9 + overhead }
    }
}

/// The estimated work of a run.
#[must_use]
pub fn cost(reduced: &Reduced) -> Cost {
    match reduced {
        Reduced::CohesiveSpheres(spheres) => spheres.cost(),
        Reduced::CohesiveDiscs(discs) => discs.cost(),
        Reduced::PlasticDiscs(discs) => discs.cost(),
    }
}
