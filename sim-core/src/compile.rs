//! Scene to simulation: the one place that names combinations.

use scene::Reduced;

use crate::{Options, SimError, Simulation};

/// Builds the simulation of a reduced scene from its initial state.
///
/// # Errors
/// [`SimError::Scene`] when the combination is not legal.
pub fn compile(scene: &Reduced, options: &Options) -> Result<Box<dyn Simulation>, SimError> {
    let _ = (scene, options);
    Err(SimError::Internal("under construction".to_owned()))
}

/// Continues from a checkpoint made by [`Simulation::save`] for the same scene.
///
/// # Errors
/// [`SimError::Checkpoint`] when the bytes are damaged or belong to another scene or physics version.
pub fn restore(
    scene: &Reduced,
    options: &Options,
    checkpoint: &[u8],
) -> Result<Box<dyn Simulation>, SimError> {
    let _ = (scene, options, checkpoint);
    Err(SimError::Internal("under construction".to_owned()))
}
