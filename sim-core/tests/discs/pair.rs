//! One contact.

use sim_core::dem::{CellControl, DiscParameters, InitialDiscs, discs};

use crate::support::{ELASTIC, FAST, TABLE_1, pair};

const RADII: [f64; 2] = [0.5, 0.3];

fn gap(dem: &dyn sim_core::dem::CellDynamics) -> f64 {
    let picture = dem.picture();
    let (a, b) = (picture.positions[0], picture.positions[1]);
    (b[0] - a[0]).hypot(b[1] - a[1]) - picture.radii[0] - picture.radii[1]
}

#[test]
fn a_pair_rests_at_its_equilibrium_distance() {
    // h0 = −F0/K_N.
    let mut dem = pair(&TABLE_1, RADII, 2e-4, 0.0, 0.1);
    dem.run(60_000).unwrap();
    assert!((gap(dem.as_ref()) + 1e-5).abs() < 1e-12, "{}", gap(dem.as_ref()));
}

#[test]
fn restitution_without_adhesion_is_that_asked_for() {
    // The step error goes away with dt: extrapolated to zero, the discs separate with e_N of the approach.
    let parameters = DiscParameters { f0: 0.0, kt: 0.0, ..TABLE_1 };
    let restitution = |dt: f64| {
        let mut dem = pair(&parameters, RADII, 1e-6, -1e-4, dt);
        dem.run((60.0 / dt) as u64).unwrap();
        let velocities = dem.picture().velocities;
        (velocities[1][0] - velocities[0][0]) / 1e-4
    };
    // The dashpot ends with the overlap, so a real collision is over when h = 0: exact for e_N defined that way.
    let errors = [0.02, 0.01, 0.005, 0.0025].map(|dt| (restitution(dt) - 0.015).abs());
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!(errors[3] < 1e-3 && order > 0.8, "{errors:?}");
}

#[test]
fn the_attraction_of_finite_range_is_conservative() {
    // A disc falls into the attraction of another one, bounces on its elastic part and leaves with the speed it had;
    // the energy error in between is of second order in the step; also when the step is halved amid the collision.
    let parameters = DiscParameters { f0: 1e-4, d0: 0.02, ..ELASTIC };
    let worst = |dt: f64, halved: bool| {
        let mut dem = pair(&parameters, RADII, 0.025, -2e-3, dt);
        let energy = |dem: &dyn sim_core::dem::CellDynamics| {
            // Velocities of t_n: those of half a step before, half a step on.
            let view = dem.view();
            let kinetic: f64 = (0..2)
                .map(|i| {
                    let v = view.velocities[i];
                    0.5 * 4.0 * RADII[i] * RADII[i] * (v[0] * v[0] + v[1] * v[1])
                })
                .sum();
            kinetic + dem.picture().potential.iter().sum::<f64>()
        };
        let start = energy(dem.as_ref());
        let mut worst = 0.0_f64;
        while dem.view().time < 60.0 {
            if halved && dem.dt() == dt && gap(dem.as_ref()) < 0.015 {
                dem.set_dt(0.5 * dt);
            }
            dem.run(1).unwrap();
            worst = worst.max((energy(dem.as_ref()) / start - 1.0).abs());
        }
        assert!(gap(dem.as_ref()) > 0.02, "the disc leaves again");
        worst
    };
    for halved in [false, true] {
        let errors = [0.2, 0.1, 0.05].map(|dt| worst(dt, halved));
        let order = (errors[0] / errors[2]).log2() / 2.0;
        assert!(order > 1.8, "{halved} {errors:?}");
    }
}

#[test]
fn opposite_spins_swing_on_the_rolling_spring() {
    // Two equal discs turning against each other do not slip: φ'' = −2 K_R φ/I. The contact exists from the first step
    // on and has then turned for one step: w(t) = w (cos Ω t − Ω dt sin Ω t).
    let parameters = DiscParameters { restitution: 1.0, mu_r: 1e3, kr: 0.01, ..TABLE_1 };
    let w = 1e-6;
    let swing = |dt: f64| {
        let initial = InitialDiscs {
            positions: vec![[3.0, 3.0], [4.0 - 1e-5, 3.0]],
            radii: vec![0.5; 2],
            velocities: vec![[0.0; 2]; 2],
            spins: vec![w, -w],
            edges: [8.0; 2],
            control: CellControl::Fixed,
        };
        let mut dem = discs(&parameters, &initial, dt, &FAST);
        dem.run((20.0 / dt).round() as u64).unwrap();
        let rate = (2.0 * 0.01 * 8.0_f64).sqrt();
        let exact = (rate * 20.0).cos() - rate * dt * (rate * 20.0).sin();
        (dem.view().spins[0][2] / w - exact).abs()
    };
    let errors = [0.2, 0.1, 0.05].map(swing);
    let order = (errors[0] / errors[2]).log2() / 2.0;
    assert!(errors[2] < 2e-4 && order > 1.8, "{errors:?}");
}

#[test]
fn a_disc_too_fast_for_the_step_is_reported() {
    // No walls to be outside of; flying past each other at 0.26 and 0.24 d a step.
    let fly = |velocity: f64| {
        let initial = InitialDiscs {
            positions: vec![[2.0, 5.0], [7.0, 5.0]],
            radii: RADII.to_vec(),
            velocities: vec![[0.0; 2], [0.0, velocity]],
            spins: vec![0.0; 2],
            edges: [10.0; 2],
            control: CellControl::Fixed,
        };
        discs(&TABLE_1, &initial, 0.1, &FAST).run(100)
    };
    let fault = fly(2.6).unwrap_err();
    assert!(fault.what.contains("moves") && fault.step == 64, "{fault:?}");
    assert!(fly(2.4).is_ok());
}

#[test]
fn images_are_as_good_as_discs() {
    // The same collision across the border of the cell.
    let collide = |shift: f64| {
        let initial = InitialDiscs {
            positions: vec![[(4.0 + shift) % 10.0, 5.0], [(4.805 + shift) % 10.0, 5.1]],
            radii: RADII.to_vec(),
            velocities: vec![[0.0; 2], [-1e-3, 0.0]],
            spins: vec![0.0; 2],
            edges: [10.0; 2],
            control: CellControl::Fixed,
        };
        let mut dem = discs(&TABLE_1, &initial, 0.1, &FAST);
        dem.run(400).unwrap();
        let picture = dem.picture();
        (picture.velocities[1], picture.spins[0])
    };
    let (here, there) = (collide(0.0), collide(5.7));
    assert!((here.0[0] - there.0[0]).abs() < 1e-13 && (here.0[1] - there.0[1]).abs() < 1e-13);
    assert!((here.1 - there.1).abs() < 1e-13 && here.1.abs() > 1e-6, "{here:?}");
}
