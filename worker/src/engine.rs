//! The physics as the worker sees it: a seam, so that leases, checkpoints and shutdown are tested with an engine
//! of a few lines.

use scene::{Model, Reduced};
use sim_core::{Options, SimError, Simulation};

/// Turns reduced scenes into simulations.
pub trait Engine: Send + Sync {
    /// Models and physics versions it runs.
    fn models(&self) -> Vec<(String, u32)>;

    /// A simulation in its initial state.
    ///
    /// # Errors
    /// [`SimError::Scene`] when the combination is not legal.
    fn compile(&self, scene: &Reduced, options: &Options) -> Result<Box<dyn Simulation>, SimError>;

    /// A simulation that goes on from a saved state.
    ///
    /// # Errors
    /// [`SimError::Checkpoint`] when the bytes are damaged or belong to something else.
    fn restore(
        &self,
        scene: &Reduced,
        options: &Options,
        state: &[u8],
    ) -> Result<Box<dyn Simulation>, SimError>;
}

/// The engines of `sim-core`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SimCore;

impl Engine for SimCore {
    fn models(&self) -> Vec<(String, u32)> {
        Model::ALL.iter().map(|model| (model.name().to_owned(), model.physics_version())).collect()
    }

    fn compile(&self, scene: &Reduced, options: &Options) -> Result<Box<dyn Simulation>, SimError> {
        sim_core::compile(scene, options)
    }

    fn restore(
        &self,
        scene: &Reduced,
        options: &Options,
        state: &[u8],
    ) -> Result<Box<dyn Simulation>, SimError> {
        sim_core::restore(scene, options, state)
    }
}
