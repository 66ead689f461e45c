//! When a run may end, and on what evidence: pure functions of what was sampled.

pub(crate) mod deformation;
pub(crate) mod estimate;
pub(crate) mod evidence;
pub(crate) mod guard;
pub(crate) mod plan;
pub(crate) mod sample;
