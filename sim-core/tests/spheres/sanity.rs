//! What a small compaction must look like.

use serde_json::json;
use sim_core::{Options, compile};

use crate::support::{run, scene};

#[test]
fn a_small_compaction_settles_where_it_should() {
    let keys = json!({ "n": 500, "p": 1e6, "sigma_e": 1e9, "sigma_c": 1e6 });
    let outcome = run(&scene(&keys), &Options::default()).unwrap();
    let record = &outcome.record;
    let real = |name: &str| record.real(name).unwrap_or_else(|| panic!("{name}"));
    assert!(["equilibrium", "e_converged"].contains(&record.text("status").unwrap()));
    // between random close packing and the initial state; walls raise e at this size
    assert!(real("e") > 0.75 && real("e") < 1.2, "e = {}", real("e"));
    assert!((real("phi") * (1.0 + real("e")) - 1.0).abs() < 1e-12);
    // isostatic for frictional spheres: 4, walls counted, without rattlers
    assert!((3.9..5.0).contains(&real("z_backbone")), "z = {}", real("z_backbone"));
    assert!((real("z_plus") + real("z_minus") - real("z")).abs() < 1e-12);
    assert!(real("wall_imbalance") < 0.02);
    assert!(real("e_se") > 0.0 && real("z_se") > 0.0);
    assert!(real("beta_plus") > 0.0);
    let series = &outcome.series;
    let e = series.column("e").unwrap();
    assert!((e[0] - 1.704).abs() < 1e-3 && (e[e.len() - 1] - real("e")).abs() < 1e-12);
    for table in ["particles", "contacts", "walls", "wall_contacts", "profile", "force_histogram"] {
        assert!(outcome.packing.0[table].rows() > 0, "{table}");
    }
    assert_eq!(outcome.packing.0["contacts"].rows() as f64, real("contacts"));
}

/// What the stop rule takes the balance of the walls from: m_w Δv is the sum of the net forces of all steps, by the
/// trapezium rule of the integrator.
#[test]
fn the_momentum_of_a_wall_is_the_sum_of_its_forces() {
    let mut simulation =
        compile(&scene(&json!({ "stop": { "rule": "steps" } })), &Options::default()).unwrap();
    simulation.advance(2500).unwrap();
    let states: Vec<_> = (0..=200)
        .map(|_| {
            let outcome = simulation.outcome().unwrap();
            simulation.advance(1).unwrap();
            outcome
        })
        .collect();
    let real = |k: usize, name: &str| states[k].record.real(name).unwrap();
    let wall = |k: usize, name: &str| states[k].packing.0["walls"].column(name).unwrap();
    let (mass, dt) = (real(0, "wall_mass"), real(0, "dt"));
    for side in 0..6 {
        let net = |k: usize| wall(k, "force")[side] - wall(k, "load")[side];
        let steps: Vec<f64> = (0..200).map(|k| 0.5 * (net(k) + net(k + 1)) * dt).collect();
        let outwards = if side % 2 == 0 { -1.0 } else { 1.0 };
        let gained = outwards * mass * (wall(200, "velocity")[side] - wall(0, "velocity")[side]);
        let size: f64 = steps.iter().map(|step| step.abs()).sum();
        assert!((gained - steps.iter().sum::<f64>()).abs() < 1e-11 * size, "wall {side}");
    }
}

#[test]
fn cohesion_makes_packings_looser() {
    let e = |sigma_c: f64| {
        let keys = json!({ "n": 300, "p": 1e5, "sigma_e": 1e9, "sigma_c": sigma_c });
        run(&scene(&keys), &Options::default()).unwrap().record.real("e").unwrap()
    };
    let (weak, middle, strong) = (e(1e4), e(1e6), e(3e7));
    // the plateau is reached between the last two; single runs of this size scatter by several 0.01
    assert!(weak + 0.2 < middle && weak + 0.2 < strong, "{weak} {middle} {strong}");
}
