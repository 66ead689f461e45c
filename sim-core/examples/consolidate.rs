//! Runs a scene of cohesive discs from standard input; the scene and its states as JSON lines on standard output.
//!
//! `consolidate [STEPS [CHECKPOINT [TABLES]]]`: at most so many steps; from the checkpoint where there is one, else from
//! the start and then written there. For timings of one state: write it once, then go on from it as often as needed.
//! TABLES gets cell, discs and contacts of the end, force histograms and I(k) of every state, as JSON; a CHECKPOINT of
//! `-` is not written.
//! With `rest` for STEPS it stops just before the first equilibrium state: one aggregation then serves scenes that
//! differ in what comes after it (`assembly_cell_mass`, `p0`, `ia`, `path`); with `beforeK`, K a number, just
//! before the K-th one.

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
    let word = std::env::args().nth(1);
    let until: Option<usize> = match word.as_deref() {
        Some("rest") => Some(1),
        Some(word) => word.strip_prefix("before").map(|count| count.parse().expect("the number of a state")),
        None => None,
    };
    let limit: u64 = match word {
        Some(word) if until.is_none() => word.parse().expect("a number of steps"),
        _ => u64::MAX,
    };
    let kept = std::env::args().nth(2).filter(|path| path != "-");
    let tables = std::env::args().nth(3);
    let known_state = kept.as_ref().and_then(|path| std::fs::read(path).ok());
    let options = Options::default();
    let mut run = match &known_state {
        Some(bytes) => Consolidation::from_checkpoint(&reduced, String::new(), &options, bytes),
        None => Consolidation::new(&reduced, String::new(), &options),
    }
    .expect("a run");
    let before = run.progress().steps;
    let started = Instant::now();
    let mut out = std::io::stdout();
    let scene: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    writeln!(out, "{{\"scene\":{scene},\"reduced\":{}}}", serde_json::to_string(&reduced).expect("JSON"))
        .expect("standard output");
    let mut known = run.state_rows().len();
    let mut before_state = Vec::new();
    loop {
        if until.is_some_and(|count| known + 1 == count) {
            before_state = run.save();
        }
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
        let steps = progress.steps - before;
        if progress.finished || steps >= limit || until.is_some_and(|count| known >= count) {
            let wall = started.elapsed().as_secs_f64();
            let per = wall * 1e9 / (steps as f64 * progress.particles as f64);
            let counters = run.counters();
            writeln!(
                out,
                "{{\"done\":{},\"steps\":{steps},\"wall_s\":{wall:.2},\"ns\":{per:.2},\"contacts\":{},\"listed\":{},\
                 \"near\":{},\"refreshes\":{},\"rebuilds\":{},\"kernel\":\"{}\"}}",
                progress.finished,
                counters.contacts,
                counters.listed_pairs,
                counters.near_pairs,
                counters.refreshes,
                counters.rebuilds,
                run.kernel()
            )
            .expect("standard output");
            if let (Some(path), None) = (&kept, &known_state) {
                let state = if until.is_some() { before_state } else { run.save() };
                std::fs::write(path, state).expect("a writable checkpoint");
            }
            if let Some(path) = &tables {
                let packing = run.outcome().expect("an outcome").packing;
                let text = serde_json::to_string(&packing).expect("JSON");
                std::fs::write(path, text).expect("a writable file for the tables");
            }
            break;
        }
    }
}
