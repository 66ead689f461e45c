//! The particle system of a scene: the one place that calls the constructors of the core.

use crate::dem::{Dynamics, InitialState, SphereParameters};
use crate::{Options, SimError};

/// A system at its initial state.
pub(super) fn new(
    _p: &SphereParameters,
    _s: &InitialState,
    _dt: f64,
    _o: &Options,
) -> Result<Box<dyn Dynamics>, SimError> {
    Err(SimError::Internal("under construction".to_owned()))
}

/// A system from its saved bytes.
pub(super) fn restore(
    _p: &SphereParameters,
    _bytes: &[u8],
    _o: &Options,
) -> Result<Box<dyn Dynamics>, SimError> {
    Err(SimError::Internal("under construction".to_owned()))
}
