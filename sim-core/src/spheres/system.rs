//! The particle system of a scene: the one place that calls the constructors of the core.

use crate::dem::{Dynamics, InitialState, Laws, SphereParameters, restore_spheres, spheres};
use crate::{Options, SimError};

/// A system at its initial state.
#[expect(clippy::unnecessary_wraps, reason = "a constructor may refuse a combination of laws")]
pub(super) fn new(
    parameters: &SphereParameters,
    initial: &InitialState,
    dt: f64,
    options: &Options,
) -> Result<Box<dyn Dynamics>, SimError> {
    Ok(spheres(parameters, initial, dt, Laws::Needed, options))
}

/// A system from its saved bytes.
pub(super) fn restore(
    parameters: &SphereParameters,
    bytes: &[u8],
    options: &Options,
) -> Result<Box<dyn Dynamics>, SimError> {
    restore_spheres(parameters, bytes, options)
}
