//! Times the force kernel on prepared states: `cargo run --release -p sim-core --example kernel -- SCENE.json STEPS [scalar] [avx2] [mixed]`.
//! `avx2` leaves AVX-512 aside. The scene is advanced by its `max_steps` first; the state is kept beside the scene as `.state.tmp`.

use std::error::Error;
use std::time::Instant;

use sim_core::bench::Bench;
use sim_core::{KernelChoice, Options};

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let (path, steps) = (&arguments[1], arguments[2].parse::<u64>()?);
    let mut keys: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    let asked = |word: &str| arguments[3..].iter().any(|argument| argument == word);
    let mut kept = format!("{path}.state.tmp");
    if asked("mixed") {
        keys["precision"] = "mixed".into();
        kept = format!("{path}.mixed.state.tmp");
    }
    let scene = scene::Scene::from_json(&keys).map_err(|problems| format!("{problems:?}"))?.reduce();
    let scene::Reduced::CohesiveSpheres(spheres) = &scene else { return Err("not spheres".into()) };
    let options = Options::default();
    let state = match std::fs::read(&kept) {
        Ok(bytes) => bytes,
        Err(_) => {
            let start = Instant::now();
            let state = Bench::prepare(&scene, spheres.max_steps.unwrap_or(0), &options)?.save();
            println!("prepared in {:.1} s", start.elapsed().as_secs_f64());
            std::fs::write(&kept, &state)?;
            state
        }
    };
    let fast = if asked("avx2") { KernelChoice::Avx2 } else { KernelChoice::Auto };
    for (kernel, threads) in [(fast, 1), (fast, 2), (fast, 1), (KernelChoice::Scalar, 1)] {
        if kernel == KernelChoice::Scalar && !asked("scalar") {
            continue;
        }
        let mut bench = Bench::load(&scene, &state, &Options { threads, kernel })?;
        let before = bench.counters();
        let mut best = f64::INFINITY;
        for _ in 0..5 {
            let start = Instant::now();
            bench.run(steps)?;
            best = best.min(start.elapsed().as_secs_f64());
        }
        let after = bench.counters();
        let n = after.particles as f64;
        println!(
            "{} threads {}: {:.1} ns per particle-step; per particle {:.3} contacts {:.3} listed {:.3} near {:.3} wall; \
             {} refreshes {} rebuilds in {} steps",
            bench.kernel(),
            after.threads,
            best * 1e9 / (n * steps as f64),
            after.contacts as f64 / n,
            after.listed_pairs as f64 / n,
            after.near_pairs as f64 / n,
            after.wall_contacts as f64 / n,
            after.refreshes - before.refreshes,
            after.rebuilds - before.rebuilds,
            5 * steps
        );
    }
    compare_threads(&scene, &state, steps, fast)
}

/// One and two threads in turn, fifteen times: what else happens on the machine meets both.
#[expect(clippy::print_stdout, reason = "an example that prints")]
fn compare_threads(
    scene: &scene::Reduced,
    state: &[u8],
    steps: u64,
    kernel: KernelChoice,
) -> Result<(), Box<dyn Error>> {
    let load = |threads| Bench::load(scene, state, &Options { threads, kernel });
    let mut benches = [load(1)?, load(2)?];
    if benches[1].counters().threads < 2 {
        return Ok(());
    }
    let mut times = [const { Vec::new() }; 2];
    for _ in 0..15 {
        for (bench, times) in benches.iter_mut().zip(&mut times) {
            let start = Instant::now();
            bench.run(steps / 4)?;
            times.push(start.elapsed().as_secs_f64());
        }
    }
    let least = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
    let mut ratios: Vec<f64> = times[0].iter().zip(&times[1]).map(|(one, two)| one / two).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    println!(
        "two threads: {:.2} times one (smallest of fifteen in turn), {:.2} times (median of neighbours)",
        least(&times[0]) / least(&times[1]),
        ratios[ratios.len() / 2]
    );
    Ok(())
}
