//! The particle system of a scene: the one place that calls the constructors of the core.

use crate::dem::{self, Dynamics, InitialState, Laws, SphereParameters};
use crate::{Options, SimError};

/// A system at its initial state, with null laws for what the parameters do not need.
pub(super) fn new(
    parameters: &SphereParameters,
    initial: &InitialState,
    dt: f64,
    options: &Options,
) -> Box<dyn Dynamics> {
    dem::spheres(parameters, initial, dt, Laws::Needed, options)
}

/// A system from its saved bytes.
///
/// # Errors
/// [`SimError::Checkpoint`] when the bytes are damaged or belong to other parameters.
pub(super) fn restore(
    parameters: &SphereParameters,
    bytes: &[u8],
    options: &Options,
) -> Result<Box<dyn Dynamics>, SimError> {
    dem::restore_spheres(parameters, bytes, options)
}
