//! An engine of a few lines for tests: counts to a number, slowly if asked, and fails where told.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use record::{Outcome, Row};
use scene::Reduced;
use sim_core::{Options, Progress, SimError, Simulation};

use crate::engine::Engine;

/// Where the count goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trap {
    /// Never.
    None,
    /// Panics at this step.
    Panic(u64),
    /// Is unstable at this step.
    Unstable(u64),
    /// Stands still at this step.
    Stuck(u64),
}

/// Counts to `length`.
#[derive(Debug)]
pub struct Counting {
    pub length: u64,
    pub per_step: Duration,
    pub trap: Trap,
    /// Starts from the beginning so far.
    pub compiled: AtomicU64,
}

impl Counting {
    pub fn to(length: u64) -> Self {
        Self { length, per_step: Duration::ZERO, trap: Trap::None, compiled: AtomicU64::new(0) }
    }
}

#[derive(Debug)]
struct Count {
    steps: u64,
    /// Depends on every step, so that a lost or repeated step shows.
    digest: u64,
    length: u64,
    per_step: Duration,
    trap: Trap,
}

impl Engine for Counting {
    fn models(&self) -> Vec<(String, u32)> {
        vec![("cohesive_spheres".to_owned(), 1)]
    }

    fn compile(&self, scene: &Reduced, _: &Options) -> Result<Box<dyn Simulation>, SimError> {
        self.compiled.fetch_add(1, Ordering::SeqCst);
        let Reduced::CohesiveSpheres(spheres) = scene else {
            return Err(SimError::Internal("counts spheres only".to_owned()));
        };
        Ok(Box::new(self.count(0, spheres.seed)))
    }

    fn restore(&self, _: &Reduced, _: &Options, state: &[u8]) -> Result<Box<dyn Simulation>, SimError> {
        let words: [u8; 16] =
            state.try_into().map_err(|_| SimError::Checkpoint("wrong length".to_owned()))?;
        let steps = u64::from_le_bytes(words[..8].try_into().unwrap());
        assert!(steps != u64::MAX, "a state that cannot be");
        Ok(Box::new(self.count(steps, u64::from_le_bytes(words[8..].try_into().unwrap()))))
    }
}

impl Counting {
    fn count(&self, steps: u64, digest: u64) -> Count {
        Count { steps, digest, length: self.length, per_step: self.per_step, trap: self.trap }
    }
}

impl Simulation for Count {
    fn advance(&mut self, steps: u64) -> Result<Progress, SimError> {
        for _ in 0..steps.min(self.length - self.steps) {
            match self.trap {
                Trap::Panic(at) if at == self.steps => panic!("trap at {at}"),
                Trap::Unstable(at) if at == self.steps => {
                    return Err(SimError::Unstable { step: at, what: "trap".to_owned(), retried_dt: 0.5 });
                }
                Trap::Stuck(at) if at == self.steps => break,
                _ => {}
            }
            std::thread::sleep(self.per_step);
            self.steps += 1;
            self.digest = self.digest.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(self.steps);
        }
        Ok(self.progress())
    }

    fn progress(&self) -> Progress {
        let mut live = Row::new();
        live.number("e", 1.0).unwrap();
        Progress {
            steps: self.steps,
            expected_steps: self.length,
            fraction: 0.5,
            finished: self.steps == self.length,
            particles: 1,
            live,
        }
    }

    fn outcome(&self) -> Result<Outcome, SimError> {
        let mut outcome = Outcome::default();
        outcome.record.put("status", "equilibrium").put("digest", format!("{:016x}", self.digest));
        Ok(outcome)
    }

    fn save(&self) -> Vec<u8> {
        [self.steps.to_le_bytes(), self.digest.to_le_bytes()].concat()
    }

    fn kernel(&self) -> String {
        "counting".to_owned()
    }
}
