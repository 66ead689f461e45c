//! Runs one scene and prints its record: for trying things out without worker or server.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use std::time::Instant;

use scene::Scene;
use sim_core::{Options, compile};

fn main() {
    let text = std::env::args().nth(1).expect("usage: sphere_scene '{\"model\": …}'");
    let scene = Scene::from_json(&serde_json::from_str(&text).expect("JSON")).expect("a valid scene");
    let begun = Instant::now();
    let mut run = compile(&scene.reduce(), &Options::default()).expect("compiles");
    let made = begun.elapsed().as_secs_f64();
    loop {
        let progress = run.advance(10_000).expect("runs");
        if progress.finished {
            break;
        }
    }
    let seconds = begun.elapsed().as_secs_f64() - made;
    let progress = run.progress();
    let outcome = run.outcome().expect("an outcome");
    let ns = seconds * 1e9 / progress.steps as f64 / progress.particles as f64;
    println!("{}", serde_json::to_string_pretty(&outcome.record).expect("plain"));
    println!(
        "initial state {made:.2} s, run {seconds:.2} s, {ns:.1} ns per particle-step, {} samples",
        outcome.series.rows()
    );
}
