//! A prepared state to time: what `tamp bench` runs. No clock in here; the caller measures.

use scene::Reduced;

use crate::dem::{Counters, Dynamics, Fault, View};
use crate::{Options, SimError, spheres};

/// A particle system at the state that is to be timed.
pub struct Bench {
    dynamics: Box<dyn Dynamics>,
}

impl Bench {
    /// The initial state of a scene advanced by `steps` steps of its automatic (or given) time step.
    ///
    /// # Errors
    /// [`SimError::Scene`] when the scene has no initial state, [`SimError::Unstable`] when it blows up on the way.
    pub fn prepare(scene: &Reduced, steps: u64, options: &Options) -> Result<Self, SimError> {
        let mut bench = Self { dynamics: spheres::bench_system(scene, None, options)? };
        bench.run(steps)?;
        Ok(bench)
    }

    /// The state that [`Bench::save`] wrote for the same scene.
    ///
    /// # Errors
    /// [`SimError::Checkpoint`] when the bytes are damaged or of other laws.
    pub fn load(scene: &Reduced, bytes: &[u8], options: &Options) -> Result<Self, SimError> {
        Ok(Self { dynamics: spheres::bench_system(scene, Some(bytes), options)? })
    }

    /// The state as bytes, to keep a prepared one.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        self.dynamics.save()
    }

    /// Does `steps` steps, nothing else.
    ///
    /// # Errors
    /// [`SimError::Unstable`] when the state stops making sense.
    pub fn run(&mut self, steps: u64) -> Result<(), SimError> {
        let dt = self.dynamics.dt();
        self.dynamics.run(steps).map_err(|Fault { step, what }| SimError::Unstable {
            step,
            what,
            retried_dt: dt,
        })
    }

    /// Sizes of the present state: contacts, listed and near pairs, threads.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.dynamics.counters()
    }

    /// The state at this instant.
    #[must_use]
    pub fn view(&self) -> View {
        self.dynamics.view()
    }

    /// Name of the compiled kernel.
    #[must_use]
    pub fn kernel(&self) -> String {
        self.dynamics.kernel()
    }
}
