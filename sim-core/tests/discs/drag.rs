//! Drag of a late final stage: v' = −γ v for what moves freely, and the runs that use it.

use scene::{Reduced, Scene};
use serde_json::json;
use sim_core::dem::{CellControl, CellDynamics, Drag, InitialDiscs, discs};
use sim_core::{KernelChoice, Options, compile, restore};

use crate::support::{FAST, TABLE_1};

const RADII: [f64; 2] = [0.5, 0.3];
const RATE: f64 = 1e-3;

/// Two discs that stick and turn about their centre of mass as one body, an arm without a stiffness.
fn arm(dt: f64) -> Box<dyn CellDynamics> {
    const TURN: f64 = 1e-6;
    let apart = RADII[0] + RADII[1] - 1e-5;
    let masses = RADII.map(|r| 4.0 * r * r);
    let whole = masses[0] + masses[1];
    let from_centre = [-apart * masses[1] / whole, apart * masses[0] / whole];
    let initial = InitialDiscs {
        positions: from_centre.map(|x| [5.0 + x, 5.0]).to_vec(),
        radii: RADII.to_vec(),
        velocities: from_centre.map(|x| [0.0, TURN * x]).to_vec(),
        spins: vec![TURN; 2],
        edges: [10.0, 10.0],
        control: CellControl::Fixed,
    };
    discs(&TABLE_1, &initial, dt, &FAST)
}

/// Angular momentum about the centre of mass, positions of t_n, velocities of half a step before.
fn angular_momentum(dem: &dyn CellDynamics) -> f64 {
    let picture = dem.picture();
    let masses = RADII.map(|r| 4.0 * r * r);
    let whole = masses[0] + masses[1];
    let mean = |values: &[[f64; 2]], axis: usize| {
        (masses[0] * values[0][axis] + masses[1] * values[1][axis]) / whole
    };
    let centre = [mean(&picture.positions, 0), mean(&picture.positions, 1)];
    (0..2)
        .map(|k| {
            let ([x, y], [u, v]) = (picture.positions[k], picture.velocities[k]);
            masses[k] * ((x - centre[0]) * v - (y - centre[1]) * u)
                + 0.5 * masses[k] * RADII[k] * RADII[k] * picture.spins[k]
        })
        .sum()
}

#[test]
fn an_arm_that_swings_freely_slows_down_at_the_rate_of_the_drag() {
    // Contact forces change no angular momentum: dL/dt = −γ L, so over 2000 τ it falls to exp(−2). The scheme has
    // (1 − γ dt/2)/(1 + γ dt/2) = exp(−γ dt − (γ dt)³/12 − …): a relative error of 2 (γ dt)²/12 = 1.7e-7 at dt = 1.
    // 0.1 as in runs: 1.7e-9 and what the 1e-5 a of overlap leave of it (the arm is 1e-6 of a turn around).
    let mut dem = arm(0.1);
    dem.run(10).unwrap();
    let free = angular_momentum(dem.as_ref());
    dem.run(1000).unwrap();
    assert!((angular_momentum(dem.as_ref()) / free - 1.0).abs() < 1e-9, "without drag it turns on");
    dem.set_drag(Drag::All(RATE));
    dem.run(20_000).unwrap();
    let slowed = angular_momentum(dem.as_ref()) / free;
    assert!((slowed / (-2.0_f64).exp() - 1.0).abs() < 1e-8, "{slowed}");
    dem.set_drag(Drag::None);
    dem.run(1000).unwrap();
    assert!((angular_momentum(dem.as_ref()) / free / slowed - 1.0).abs() < 1e-9, "and again without");
}

#[test]
fn discs_in_flight_lose_energy_at_twice_the_rate_to_second_order() {
    let error = |dt: f64| {
        let initial = InitialDiscs {
            positions: vec![[2.0, 2.0], [6.0, 6.0]],
            radii: RADII.to_vec(),
            velocities: vec![[1e-6, -2e-6], [3e-6, 1e-6]],
            spins: vec![1e-6, -1e-6],
            edges: [10.0, 10.0],
            control: CellControl::Fixed,
        };
        let mut dem = discs(&TABLE_1, &initial, dt, &FAST);
        let energy = |dem: &dyn CellDynamics| dem.residuals().kinetic.iter().sum::<f64>();
        dem.set_drag(Drag::All(0.5));
        dem.run((1.0 / dt) as u64).unwrap();
        let before = energy(dem.as_ref());
        dem.run((4.0 / dt) as u64).unwrap();
        (energy(dem.as_ref()) / before / (-4.0_f64).exp() - 1.0).abs()
    };
    let errors = [0.1, 0.05, 0.025].map(error);
    let order = (errors[0] / errors[2]).log2() / 2.0;
    assert!(errors[0] < 1e-3 && (order - 2.0).abs() < 0.02, "{errors:?}");
}

#[test]
fn a_run_with_drag_resumes_to_the_same_bits() {
    // Almost no local damping: the state is still not in equilibrium when the drag begins, at 100 T0.
    let scene = |drag: f64| -> Reduced {
        Scene::from_json(&json!({
            "model": "cohesive_discs", "n": 40, "assembly": "type1", "phi_i": 0.4, "assembly_cell_mass": 10,
            "p0": 0.1, "path": [], "final_damping": 1e-6, "final_drag": drag, "max_time": 200, "tolerance": 0.1,
        }))
        .unwrap()
        .reduce()
    };
    let whole = |drag: f64| {
        let mut run = compile(&scene(drag), &Options::default()).unwrap();
        while !run.advance(1_000_000).unwrap().finished {}
        run.outcome().unwrap()
    };
    let [without, with] = [0.0, 1.0].map(whole);
    let time = |outcome: &record::Outcome| outcome.states[0].real("time").unwrap();
    assert!(time(&without) > 150.0 && time(&with) > 100.0, "{} {}", time(&without), time(&with));
    assert_eq!(without.record.text("status"), Some("not_converged"));
    assert_eq!(with.record.text("status"), Some("equilibrium"), "the drag brings it to rest");
    let scalar = Options { threads: 1, kernel: KernelChoice::Scalar };
    let mut parts = compile(&scene(1.0), &scalar).unwrap();
    while !parts.advance(7_777).unwrap().finished {
        parts = restore(&scene(1.0), &scalar, &parts.save()).unwrap();
    }
    assert_eq!(with, parts.outcome().unwrap());
}
