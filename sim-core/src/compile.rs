//! Scene to simulation: the one place that names combinations.

use scene::Reduced;

use crate::consolidation::Consolidation;
use crate::mpm::simulation::PlasticDiscs;
use crate::spheres::Run;
use crate::{Options, SimError, Simulation};

/// Builds the simulation of a reduced scene from its initial state.
///
/// # Errors
/// [`SimError::Scene`] when the combination is not legal.
pub fn compile(scene: &Reduced, options: &Options) -> Result<Box<dyn Simulation>, SimError> {
    let key = scene.key().as_str().to_owned();
    match scene {
        Reduced::CohesiveSpheres(spheres) => Ok(Box::new(Run::new(spheres, key, options)?)),
        Reduced::PlasticDiscs(discs) => Ok(Box::new(PlasticDiscs::new(discs, options)?)),
        Reduced::CohesiveDiscs(discs) => Ok(Box::new(Consolidation::new(discs, key, options)?)),
    }
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
    let key = scene.key().as_str().to_owned();
    match scene {
        Reduced::CohesiveSpheres(spheres) => Ok(Box::new(Run::restore(spheres, key, options, checkpoint)?)),
        Reduced::PlasticDiscs(discs) => {
            Ok(Box::new(crate::mpm::simulation::restore(discs, options, checkpoint)?))
        }
        Reduced::CohesiveDiscs(discs) => {
            Ok(Box::new(Consolidation::from_checkpoint(discs, key, options, checkpoint)?))
        }
    }
}
