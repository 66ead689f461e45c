//! What the tolerances of the solvers of plastic discs cost and change: the tables of
//! `docs/validation/plastic-discs/README.md` (24 discs at 8 cells; minutes).
//!
//! `cargo run --release -p sim-core --example plastic_tolerance`
#![expect(clippy::print_stdout, reason = "an example for the command line")]
#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts stay small"
)]

use std::time::Instant;

use scene::{Reduced, Scene};
use serde_json::json;
use sim_core::mpm::explicit::Explicit;
use sim_core::mpm::implicit::Implicit;
use sim_core::mpm::setup::{Scenery, build};

fn scenery(method: &str) -> (Scenery, f64) {
    let scene = json!({
        "model": "plastic_discs", "n": 24, "cells": 8, "phi_i": 0.72, "strain_end": 0.22, "method": method,
    });
    let scene = Scene::from_json(&scene).expect("the scene has no mistakes");
    let Reduced::PlasticDiscs(scene) = scene.reduce() else { unreachable!("the model is named above") };
    (build(&scene).expect("0.72 can be packed"), scene.time_step())
}

/// Wall work, and bottom-wall stress over the last third, at the end.
fn result(scenery: &Scenery, impulse_before: f64, time_before: f64) -> (f64, f64) {
    let world = &scenery.world;
    let force = (world.wall_impulse[0] - impulse_before) / (world.time - time_before);
    (world.energies.work, force / scenery.width)
}

fn newtons_residual() {
    println!("residual | Newton/step | sweeps/step | CPU s | work | stress");
    for residual in [1e-8, 1e-6, 1e-5, 1e-4, 1e-3] {
        let (mut scenery, dt) = scenery("implicit");
        scenery.world.numerics.residual = residual;
        scenery.world.numerics.impulse = (0.1 * residual).min(1e-5);
        let steps = (0.22 * scenery.height / 0.02 / dt).round() as usize;
        let mut solver = Implicit::new(&scenery.world);
        let begun = Instant::now();
        let mut before = (0.0, 0.0);
        for step in 0..steps {
            if step == 2 * steps / 3 {
                before = (scenery.world.wall_impulse[0], scenery.world.time);
            }
            if let Err(failure) = solver.step(&mut scenery.world, dt) {
                println!("{residual:.0e}: step {step}: {failure}");
                break;
            }
        }
        let (work, stress) = result(&scenery, before.0, before.1);
        let effort = scenery.world.effort;
        let per_step = |count: u64| count as f64 / effort.substeps as f64;
        let seconds = begun.elapsed().as_secs_f64();
        println!(
            "{residual:.0e} | {:.2} | {:.0} | {seconds:.1} | {work:.6} | {stress:.6} | halved {}",
            per_step(effort.newton),
            per_step(effort.sweeps),
            effort.halved
        );
    }
}

fn contact_sweeps_of_the_explicit_method() {
    println!("most sweeps | sweeps/step | s | work | stress");
    for most in [5, 10, 20, 50, 200] {
        let (mut scenery, _) = scenery("explicit");
        scenery.world.numerics.explicit_sweeps = most;
        scenery.world.numerics.explicit_impulse = if most > 100 { 1e-5 } else { 1e-3 };
        let mut solver = Explicit::new(&scenery.world);
        let end = 0.22 * scenery.height / 0.02;
        let begun = Instant::now();
        let mut before = None;
        while scenery.world.time < end {
            let dt = solver.time_step(&scenery.world).min(end - scenery.world.time);
            if scenery.world.time > 2.0 / 3.0 * end && before.is_none() {
                before = Some((scenery.world.wall_impulse[0], scenery.world.time));
            }
            if let Err(failure) = solver.step(&mut scenery.world, dt) {
                println!("{most}: {failure}");
                break;
            }
        }
        let (impulse, time) = before.unwrap_or_default();
        let (work, stress) = result(&scenery, impulse, time);
        let sweeps = scenery.world.effort.sweeps as f64 / scenery.world.effort.substeps as f64;
        println!("{most} | {sweeps:.1} | {:.1} | {work:.6} | {stress:.6}", begun.elapsed().as_secs_f64());
    }
}

fn main() {
    newtons_residual();
    contact_sweeps_of_the_explicit_method();
}
