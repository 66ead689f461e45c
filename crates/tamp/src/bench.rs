//! `tamp bench`: the cost of a step, from a given state, as JSON.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde::Serialize;
use sim_core::{KernelChoice, Options, Simulation};
use worker::checkpoint;

use crate::failure::Failure;
use crate::{input, output};

/// Arguments of `tamp bench`.
#[derive(clap::Args)]
pub struct Arguments {
    /// Scene as JSON; - reads it from standard input
    file: String,
    /// Keys to replace, for example n=1000
    #[arg(value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Steps per repetition
    #[arg(long, default_value_t = 1000)]
    steps: u64,
    /// Repetitions; the fastest counts
    #[arg(long, default_value_t = 5)]
    repeats: u32,
    /// Steps before the first repetition, to reach the state of interest
    #[arg(long, default_value_t = 0)]
    warmup: u64,
    /// Begin from this checkpoint, as written by tamp run --checkpoint
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Threads inside the scene
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Use the plain code path instead of the fastest
    #[arg(long)]
    scalar: bool,
}

/// What was measured.
#[derive(Serialize)]
struct Measured {
    /// Wall time of a step over the number of particles, of the fastest repetition [ns].
    ns_per_particle_step: f64,
    /// The same for every repetition [ns].
    repeats: Vec<f64>,
    /// Particles.
    particles: u64,
    /// Contacts and other live numbers at the end.
    live: record::Row,
    /// Steps per repetition.
    steps: u64,
    /// Steps before the first repetition.
    begun_at_step: u64,
    /// Threads inside the scene.
    threads: usize,
    /// Compiled kernel.
    kernel: String,
    /// Hardware class.
    hardware: String,
    /// Scene measured.
    scene_key: String,
    /// Version of the code.
    code_version: &'static str,
}

/// Measures and prints.
pub fn bench(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.steps == 0 || arguments.repeats == 0 {
        return Err(Failure::input("steps", "0", "is out of range", "give 1 or more steps and repeats"));
    }
    let scene = input::scene(&arguments.file, &arguments.overrides)?;
    let mut simulation = begin(arguments, &scene)?;
    advance(simulation.as_mut(), arguments.warmup)?;
    let begun_at_step = simulation.progress().steps;
    let mut repeats = Vec::new();
    for _ in 0..arguments.repeats {
        let (done, elapsed) = advance(simulation.as_mut(), arguments.steps)?;
        if done < arguments.steps {
            let what = format!("the run ended after {done} steps of a repetition");
            let remedy = "use fewer steps, a state further from the end, or stop=steps";
            return Err(Failure::input("steps", arguments.steps.to_string(), what, remedy));
        }
        #[expect(clippy::cast_precision_loss, reason = "a rate")]
        let work = done as f64 * simulation.progress().particles as f64;
        repeats.push(elapsed.as_secs_f64() * 1e9 / work);
    }
    let progress = simulation.progress();
    output::json(&Measured {
        ns_per_particle_step: repeats.iter().copied().fold(f64::INFINITY, f64::min),
        repeats,
        particles: progress.particles,
        live: progress.live,
        steps: arguments.steps,
        begun_at_step,
        threads: arguments.threads,
        kernel: simulation.kernel(),
        hardware: worker::host::hardware(),
        scene_key: scene.key().to_string(),
        code_version: worker::CODE_VERSION,
    })
}

fn begin(arguments: &Arguments, scene: &scene::Scene) -> Result<Box<dyn Simulation>, Failure> {
    let kernel = if arguments.scalar { KernelChoice::Scalar } else { KernelChoice::Auto };
    let options = Options { threads: arguments.threads.max(1), kernel };
    let reduced = scene.reduce();
    let Some(path) = &arguments.state else { return Ok(sim_core::compile(&reduced, &options)?) };
    let bytes = std::fs::read(path).map_err(|error| Failure::file(path, &error))?;
    let (_, state) = checkpoint::open(&bytes, &scene.key()).map_err(|damaged| {
        let remedy = "make it with tamp run --checkpoint from the same scene";
        Failure::input("state", path.display().to_string(), format!("is {damaged}"), remedy)
    })?;
    Ok(sim_core::restore(&reduced, &options, &state)?)
}

/// Advances by `steps`, or to the end of the run; answers steps done and wall time.
fn advance(simulation: &mut dyn Simulation, steps: u64) -> Result<(u64, Duration), Failure> {
    let first = simulation.progress().steps;
    let begun = Instant::now();
    let mut done = 0;
    while done < steps {
        let progress = simulation.advance(steps - done)?;
        let now = progress.steps - first;
        if progress.finished || now == done {
            return Ok((now, begun.elapsed()));
        }
        done = now;
    }
    Ok((done, begun.elapsed()))
}
