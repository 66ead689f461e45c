//! A running simulation as its driver sees it.

use record::{Outcome, Row};

use crate::SimError;

/// A compiled scene. Object-safe and coarse: called per slice of steps, never per particle.
pub trait Simulation: Send {
    /// Advances by at most `steps` steps; returns early when the run is finished. Slicing never changes results:
    /// any partition of the same steps gives the same bits.
    ///
    /// # Errors
    /// [`SimError`] when the state cannot be continued.
    fn advance(&mut self, steps: u64) -> Result<Progress, SimError>;

    /// How far the run is.
    fn progress(&self) -> Progress;

    /// The result so far: record, states, series, packing. Final when `progress().finished`.
    ///
    /// # Errors
    /// [`SimError`] when an observable cannot be computed.
    fn outcome(&self) -> Result<Outcome, SimError>;

    /// The complete state; [`restore`](crate::restore) continues from it to the same bits.
    fn save(&self) -> Vec<u8>;

    /// Name of the compiled kernel, for example `dem3d+hooke+viscous+constant_adhesion+coulomb;avx2`.
    fn kernel(&self) -> String;
}

/// How far a run is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Steps done.
    pub steps: u64,
    /// Present estimate of the steps the whole run takes.
    pub expected_steps: u64,
    /// Share of the expected work that is done, 0 … 1.
    pub fraction: f64,
    /// Whether the run is finished.
    pub finished: bool,
    /// Particles (or material points), to turn wall time into ns per particle-step.
    pub particles: u64,
    /// A few live numbers: `e`, `z`, `ke_over_eel`, … .
    pub live: Row,
}

/// How to run, never what: none of these changes a bit of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Threads used inside the scene.
    pub threads: usize,
    /// Which code path computes the forces.
    pub kernel: KernelChoice,
}

impl Default for Options {
    fn default() -> Self {
        Self { threads: 1, kernel: KernelChoice::Auto }
    }
}

/// Code path of the force pass; all give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KernelChoice {
    /// The fastest this machine has.
    Auto,
    /// As `Auto`, but without AVX-512.
    Avx2,
    /// The plain path, lane for lane the same arithmetic.
    Scalar,
}
