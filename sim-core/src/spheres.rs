//! The engine of cohesive spheres: initial state, dynamics, stop criteria, guard and record put together.

mod kicks;
mod memory;
mod outcome;
mod run;
mod start;
mod system;

pub(crate) use run::Run;
pub(crate) use start::explain;

use crate::dem::Dynamics;
use crate::{Options, SimError};

/// The bare particle system of a scene for [`crate::bench`]: at its initial state, or at a saved one.
///
/// # Errors
/// [`SimError::Scene`] without an engine or an initial state, [`SimError::Checkpoint`] for foreign bytes.
pub(crate) fn bench_system(
    scene: &scene::Reduced,
    saved: Option<&[u8]>,
    options: &Options,
) -> Result<Box<dyn Dynamics>, SimError> {
    let scene::Reduced::CohesiveSpheres(spheres) = scene else {
        return Err(SimError::Scene {
            field: "model".to_owned(),
            problem: format!("prepared states of {} cannot be timed", scene.model().name()),
            remedy: "use model cohesive_spheres".to_owned(),
        });
    };
    let parameters = start::parameters(spheres);
    match saved {
        Some(bytes) => system::restore(&parameters, bytes, options),
        None => {
            let initial = start::initial_state(spheres)?;
            Ok(system::new(&parameters, &initial, start::largest_dt(spheres).0, options))
        }
    }
}
