//! `tamp bench`: the cost of a step, from a given state, as JSON.

use std::path::{Path, PathBuf};
use std::time::Instant;

use scene::Reduced;
use serde::Serialize;
use sim_core::bench::Bench;
use sim_core::{KernelChoice, Options};

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
    #[arg(long, default_value_t = 200)]
    steps: u64,
    /// Repetitions; the fastest counts
    #[arg(long, default_value_t = 5)]
    repeats: u32,
    /// Steps from the initial state to the one that is timed [default: max_steps of the scene]
    #[arg(long, value_name = "STEPS")]
    prepare: Option<u64>,
    /// Keep the prepared state here and begin from it next time
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
    /// Touching pairs.
    contacts: u64,
    /// Pairs evaluated each step, touching ones included.
    listed_pairs: u64,
    /// Pairs in the neighbour list.
    near_pairs: u64,
    /// Touching particle-wall pairs.
    wall_contacts: u64,
    /// Neighbour list rebuilds during all repetitions.
    rebuilds: u64,
    /// Bytes of the state and its lists.
    bytes: u64,
    /// Steps per repetition.
    steps: u64,
    /// Threads inside the scene.
    threads: u64,
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
    let reduced = scene.reduce();
    let mut bench = prepared(arguments, &reduced)?;
    let before = bench.counters();
    let mut repeats = Vec::new();
    for _ in 0..arguments.repeats {
        let begun = Instant::now();
        bench.run(arguments.steps)?;
        let elapsed = begun.elapsed();
        #[expect(clippy::cast_precision_loss, reason = "a rate")]
        let work = arguments.steps as f64 * before.particles as f64;
        repeats.push(elapsed.as_secs_f64() * 1e9 / work);
    }
    let after = bench.counters();
    output::json(&Measured {
        ns_per_particle_step: repeats.iter().copied().fold(f64::INFINITY, f64::min),
        repeats,
        particles: after.particles,
        contacts: after.contacts,
        listed_pairs: after.listed_pairs,
        near_pairs: after.near_pairs,
        wall_contacts: after.wall_contacts,
        rebuilds: after.rebuilds - before.rebuilds,
        bytes: after.bytes,
        steps: arguments.steps,
        threads: after.threads,
        kernel: bench.kernel(),
        hardware: worker::host::hardware(),
        scene_key: scene.key().to_string(),
        code_version: worker::CODE_VERSION,
    })
}

/// The state to be timed: kept from the last time, or made now.
fn prepared(arguments: &Arguments, reduced: &Reduced) -> Result<Bench, Failure> {
    let kernel = if arguments.scalar { KernelChoice::Scalar } else { KernelChoice::Auto };
    let options = Options { threads: arguments.threads.max(1), kernel };
    if let Some(path) = arguments.state.as_deref().filter(|path| path.exists()) {
        return load(path, reduced, &options);
    }
    let steps = arguments.prepare.or_else(|| max_steps(reduced)).unwrap_or(0);
    let bench = Bench::prepare(reduced, steps, &options)?;
    if let Some(path) = &arguments.state {
        worker::write_durably(path, &bench.save()).map_err(|error| Failure::file(path, &error))?;
    }
    Ok(bench)
}

fn load(path: &Path, reduced: &Reduced, options: &Options) -> Result<Bench, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::file(path, &error))?;
    Bench::load(reduced, &bytes, options).map_err(|error| {
        let remedy = "remove the file to prepare the state anew";
        Failure::input("state", path.display().to_string(), error.to_string(), remedy)
    })
}

/// The step limit that the scene itself gives.
fn max_steps(reduced: &Reduced) -> Option<u64> {
    reduced.to_json().get("max_steps")?.as_u64()
}
