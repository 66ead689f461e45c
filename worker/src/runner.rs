//! One job on one thread: begin or resume, advance slice by slice, save on time, end.
//!
//! No HTTP and no async in here: what happens is told through [`Control`] and the `tell` callback, so the command
//! line runs a scene through the same code.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use bytes::Bytes;
use record::{Outcome, Row};
use scene::{Reduced, SceneKey};
use sim_core::{Options, Progress, SimError, Simulation};

use crate::checkpoint::{self, Label, Sealed};
use crate::control::{Command, Control, Report};
use crate::engine::Engine;
use crate::execution::Execution;
use crate::failure::Failed;
use crate::host;
use crate::slice::Slice;

/// A slice of steps takes about this long.
const SLICE: Duration = Duration::from_millis(400);
/// Calls of `advance` without a step after which the engine counts as stuck.
const STUCK: u32 = 100;

/// What to run.
#[derive(Debug)]
pub struct Task {
    /// The scene.
    pub scene: Reduced,
    /// Its key.
    pub key: SceneKey,
    /// How to run.
    pub options: Options,
    /// Checkpoints to go on from, best first; damaged ones are skipped, none left means from the beginning.
    pub starts: Vec<Bytes>,
    /// Time between checkpoints; `None`: only when told to yield.
    pub checkpoint_every: Option<Duration>,
}

/// How a run ended.
#[derive(Debug)]
pub enum End {
    /// The result is there.
    Finished {
        /// The physics' result.
        outcome: Box<Outcome>,
        /// What belongs to this execution alone.
        execution: Row,
    },
    /// Stopped as told; the state, unless nothing had begun.
    Yielded(Option<Sealed>),
    /// Stopped as told, nothing saved.
    Dropped,
    /// It cannot go on.
    Failed(Failed),
}

/// Runs `task` to its end on the calling thread. `tell` gets every checkpoint as it is made. A panic of the
/// physics is a failure of the job, not of the worker.
pub fn run(engine: &dyn Engine, task: &Task, control: &Control, tell: &mut dyn FnMut(Sealed)) -> End {
    let guarded = catch_unwind(AssertUnwindSafe(|| run_to_end(engine, task, control, tell)));
    match guarded {
        Ok(Ok(end)) => end,
        Ok(Err(failed)) => End::Failed(failed),
        Err(payload) => End::Failed(Failed::panic(payload.as_ref())),
    }
}

fn run_to_end(
    engine: &dyn Engine,
    task: &Task,
    control: &Control,
    tell: &mut dyn FnMut(Sealed),
) -> Result<End, Failed> {
    match control.next() {
        Command::Run => {}
        Command::Yield => return Ok(End::Yielded(None)),
        Command::Drop => return Ok(End::Dropped),
    }
    let mut run = Run::begin(engine, task)?;
    let mut slice = Slice::new(SLICE);
    let mut saved = Instant::now();
    let mut calls_without_a_step = 0;
    loop {
        control.report(Report { progress: Some(run.progress.clone()), wall: run.wall });
        if run.progress.finished {
            return run.finish(task);
        }
        match control.next() {
            Command::Run => {}
            Command::Yield => return Ok(End::Yielded(Some(run.save(task)?))),
            Command::Drop => return Ok(End::Dropped),
        }
        let (done, elapsed) = run.advance(slice.steps())?;
        slice.observe(done, elapsed);
        calls_without_a_step = if done == 0 { calls_without_a_step + 1 } else { 0 };
        if calls_without_a_step > STUCK {
            let what = format!("no step in {STUCK} calls at step {}, yet not finished", run.progress.steps);
            return Err(SimError::Internal(what).into());
        }
        if task.checkpoint_every.is_some_and(|every| saved.elapsed() >= every) && !run.progress.finished {
            tell(run.save(task)?);
            saved = Instant::now();
        }
    }
}

/// A run in progress.
struct Run {
    simulation: Box<dyn Simulation>,
    progress: Progress,
    wall: Duration,
    earlier_wall_s: f64,
    resumed_at: u64,
}

impl Run {
    fn begin(engine: &dyn Engine, task: &Task) -> Result<Self, Failed> {
        let begun = Instant::now();
        for bytes in &task.starts {
            match resume(engine, task, bytes) {
                Ok((label, simulation)) => {
                    let progress = simulation.progress();
                    let wall = begun.elapsed();
                    return Ok(Self {
                        simulation,
                        progress,
                        wall,
                        earlier_wall_s: label.wall_s,
                        resumed_at: label.steps,
                    });
                }
                Err(why) => tracing::warn!(scene = %task.key, %why, "a checkpoint cannot be used"),
            }
        }
        let simulation = engine.compile(&task.scene, &task.options)?;
        let progress = simulation.progress();
        Ok(Self { simulation, progress, wall: begun.elapsed(), earlier_wall_s: 0.0, resumed_at: 0 })
    }

    fn advance(&mut self, steps: u64) -> Result<(u64, Duration), Failed> {
        let before = self.progress.steps;
        let begun = Instant::now();
        self.progress = self.simulation.advance(steps)?;
        let elapsed = begun.elapsed();
        self.wall += elapsed;
        Ok((self.progress.steps.saturating_sub(before), elapsed))
    }

    fn save(&self, task: &Task) -> Result<Sealed, Failed> {
        let label = Label {
            scene_key: task.key.clone(),
            steps: self.progress.steps,
            wall_s: self.earlier_wall_s + self.wall.as_secs_f64(),
        };
        Sealed::new(label, &self.simulation.save())
            .map_err(|error| Failed::retryable("checkpoint", format!("cannot pack a checkpoint: {error}")))
    }

    fn finish(self, task: &Task) -> Result<End, Failed> {
        let outcome = self.simulation.outcome()?;
        let execution = Execution {
            kernel: self.simulation.kernel(),
            physics_version: task.scene.model().physics_version(),
            host: host::name(),
            hardware: host::hardware(),
            threads: task.options.threads,
            particles: self.progress.particles,
            steps: self.progress.steps.saturating_sub(self.resumed_at),
            wall: self.wall,
            earlier_wall_s: self.earlier_wall_s,
            resumed_at: self.resumed_at,
        };
        Ok(End::Finished { outcome: Box::new(outcome), execution: execution.row() })
    }
}

/// Goes on from a checkpoint. A restore that panics counts as a damaged checkpoint: the next start may be good.
fn resume(engine: &dyn Engine, task: &Task, bytes: &[u8]) -> Result<(Label, Box<dyn Simulation>), SimError> {
    let (label, state) =
        checkpoint::open(bytes, &task.key).map_err(|damaged| SimError::Checkpoint(damaged.to_string()))?;
    let restored = catch_unwind(AssertUnwindSafe(|| engine.restore(&task.scene, &task.options, &state)));
    match restored {
        Ok(Ok(simulation)) => Ok((label, simulation)),
        Ok(Err(error)) => Err(error),
        Err(payload) => Err(SimError::Checkpoint(Failed::panic(payload.as_ref()).message)),
    }
}

#[cfg(test)]
mod tests;
