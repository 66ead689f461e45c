//! Runs a scene of cohesive discs from standard input; states as JSON lines on standard output. An argument limits the
//! number of steps.

use std::io::{Read, Write};
use std::time::Instant;

use sim_core::consolidation::Consolidation;
use sim_core::{Options, Simulation};

fn main() {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).expect("standard input");
    let scene::Reduced::CohesiveDiscs(reduced) = scene::Scene::from_text(&text).expect("a scene").reduce()
    else {
        panic!("a scene of cohesive discs");
    };
    let limit: u64 =
        std::env::args().nth(1).map_or(u64::MAX, |word| word.parse().expect("a number of steps"));
    let started = Instant::now();
    let mut run = Consolidation::new(&reduced, String::new(), &Options::default()).expect("a run");
    let mut out = std::io::stdout();
    let mut known = 0;
    loop {
        let progress = run.advance(2500).expect("a stable run");
        let outcome = run.state_rows();
        while known < outcome.len() {
            let line = serde_json::to_string(&outcome[known]).expect("JSON");
            let wall = started.elapsed().as_secs_f64();
            let per = wall * 1e9 / (progress.steps as f64 * progress.particles as f64);
            writeln!(
                out,
                "{{\"wall_s\":{wall:.3},\"total_steps\":{},\"ns\":{per:.2},\"row\":{line}}}",
                progress.steps
            )
            .expect("standard output");
            known += 1;
        }
        if progress.finished || progress.steps >= limit {
            let wall = started.elapsed().as_secs_f64();
            let per = wall * 1e9 / (progress.steps as f64 * progress.particles as f64);
            writeln!(
                out,
                "{{\"done\":{},\"steps\":{},\"wall_s\":{wall:.2},\"ns\":{per:.2},\"kernel\":\"{}\"}}",
                progress.finished,
                progress.steps,
                run.kernel()
            )
            .expect("standard output");
            break;
        }
    }
}
