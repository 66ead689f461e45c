//! What a scene would run, without running it.

use scene::Reduced;
use serde::Serialize;

use crate::SimError;

/// What would run and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Kernel that would be chosen.
    pub kernel: String,
    /// What the scene lets the kernel skip.
    pub skips: Vec<Skip>,
    /// Time step [reduced units].
    pub dt: f64,
    /// Why this time step.
    pub dt_reason: String,
    /// Memory of the state [bytes].
    pub memory_bytes: u64,
    /// Estimated steps.
    pub expected_steps: u64,
    /// Estimated wall time on one core of a current machine [s].
    pub expected_seconds: f64,
}

/// One feature that is absent and what that saves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Skip {
    /// Feature of the scene that is absent.
    pub absent: String,
    /// What is therefore not stored or computed.
    pub skipped: String,
    /// What that saves, where it was measured (docs/performance.md).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saves: Option<Saving>,
}

/// What an absent feature saves, measured on a jammed packing (`--example skips`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Saving {
    /// Memory of state and lists [bytes per particle].
    pub bytes_per_particle: f64,
    /// Time of a step [ns per particle-step].
    pub ns_per_particle_step: f64,
}

/// Explains a reduced scene.
///
/// # Errors
/// [`SimError::Scene`] when the scene would not compile.
pub fn explain(scene: &Reduced) -> Result<Explanation, SimError> {
    match scene {
        Reduced::CohesiveSpheres(spheres) => crate::spheres::explain(spheres),
        Reduced::PlasticDiscs(discs) => Ok(crate::mpm::explain(discs)),
        Reduced::CohesiveDiscs(discs) => crate::consolidation::explain(discs),
    }
}
