//! The default tolerances of both methods against far tighter ones (tables: example `plastic_tolerance`).

use scene::{Reduced, Scene};
use serde_json::json;
use sim_core::mpm::explicit::Explicit;
use sim_core::mpm::implicit::Implicit;
use sim_core::mpm::setup::build;
use sim_core::mpm::world::Numerics;

/// Work of the walls [E d²] on a small packing, and the effort of its contact solver per step.
fn work(method: &str, numerics: impl FnOnce(&mut Numerics)) -> (f64, f64) {
    let scene = json!({
        "model": "plastic_discs", "n": 6, "cells": 6, "phi_i": 0.6, "strain_end": 0.3, "method": method,
    });
    let Reduced::PlasticDiscs(scene) = Scene::from_json(&scene).unwrap().reduce() else { unreachable!() };
    let mut scenery = build(&scene).unwrap();
    let world = &mut scenery.world;
    numerics(&mut world.numerics);
    let end = scene.strain_end * scenery.height / scene.wall_speed;
    if method == "implicit" {
        let mut solver = Implicit::new(world);
        for _ in 0..(end / scene.time_step()).round() as usize {
            solver.step(world, scene.time_step()).unwrap();
        }
    } else {
        let mut solver = Explicit::new(world);
        while world.time < end {
            let dt = solver.time_step(world).min(end - world.time);
            solver.step(world, dt).unwrap();
        }
    }
    (world.energies.work, world.effort.sweeps as f64 / world.effort.substeps as f64)
}

/// 5e-3: no more than the mesh leaves in the work of a disc, 0.3 to 1.2 % at 12 and 16 cells (docs/validation/plastic-discs).
#[test]
fn default_tolerances_cost_less_than_half_a_per_cent_of_work() {
    let (default, cheap) = work("implicit", |_| {});
    let (tight, dear) = work("implicit", |numerics| (numerics.residual, numerics.impulse) = (1e-6, 1e-7));
    assert!(dear > 2.0 * cheap, "{cheap} and {dear} sweeps a step");
    assert!((default / tight - 1.0).abs() < 5e-3, "{default}, {tight}");
    let (default, cheap) = work("explicit", |_| {});
    let (tight, dear) = work("explicit", |numerics| {
        (numerics.explicit_sweeps, numerics.explicit_impulse) = (200, 1e-5);
    });
    assert!(dear > 2.0 * cheap, "{cheap} and {dear} sweeps a step");
    assert!((default / tight - 1.0).abs() < 5e-3, "{default}, {tight}");
}
