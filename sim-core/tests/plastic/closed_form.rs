//! Whole bodies against closed forms: line contact, impact of a bar, rigid motion.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use sim_core::mpm::body::{Body, Points};
use sim_core::mpm::element::{advance_points, internal_force};
use sim_core::mpm::explicit::Explicit;
use sim_core::mpm::template::{block, disc};
use sim_core::mpm::world::World;

use super::reference::rows;
use super::scenes::{D, law, press, run, upright};

/// Force over diameter of an elastic disc between rigid walls at the strain 1 − h/D: two line contacts of half-width
/// a² = 4 F R (1 − ν²)/(π E), each with the approach F (1 − ν²)/(π E) (2 ln(4 R/a) − 1) (Johnson, Contact Mechanics, 5.6).
fn johnson(strain: f64) -> f64 {
    let (young, poisson, radius) = (10.0, 0.45, 0.5);
    let soft = (1.0 - poisson * poisson) / (PI * young);
    let approach = |force: f64| {
        let a = (4.0 * force * radius * soft).sqrt();
        2.0 * force * soft * (2.0 * libm::log(4.0 * radius / a) - 1.0)
    };
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if approach(middle) < strain { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Work of the walls up to a strain of 0.03, over that of the line contact.
fn line_contact(across: usize) -> f64 {
    for row in rows("diam_johnson_formula", "F_over_D_MPa") {
        assert!((johnson(row.x) / row.y - 1.0).abs() < 1e-5, "the formula of the reference: {}", row.x);
    }
    // 0.1 m/s: inertia is a fifth of the 0.8 % that 0.5 m/s costs at a strain of 0.02
    let mut world = press(across, "el", 0.1);
    run(&mut world, 0.3, 60, |_, _| {});
    let samples = 3000;
    let exact: f64 = (0..samples).map(|k| johnson((f64::from(k) + 0.5) * 1e-5) * 1e-5).sum();
    world.energies.work / (D * D) / exact
}

#[test]
fn a_disc_between_walls_is_a_line_contact() {
    let (coarse, fine) = (line_contact(12) - 1.0, line_contact(24) - 1.0);
    // the contact zone is 0.15 D wide at the end: two cells of twelve, four of twenty-four
    assert!(fine.abs() < 0.02, "24 cells: {fine}");
    assert!(coarse.abs() > 1.8 * fine.abs(), "12 and 24 cells: {coarse} {fine}");
}

#[test]
fn a_bar_strikes_a_wall_and_comes_back() {
    for row in rows("wave_impact", "wall_stress_MPa") {
        let (speed, law) = (row.x, law("el"));
        let mut body = Body::new(Arc::new(block(60.0, 1.0, 120, 2)), 1.0, [0.0; 2], &law.material);
        body.fixed = (0..body.template.nodes.len() as u32).map(|node| 2 * node + 1).collect();
        body.velocity.iter_mut().step_by(2).for_each(|v| *v = -speed);
        let mut world = World::new(vec![body], vec![upright(0.0, 1.0)], law);
        world.damping = 0.0;
        let momentum = world.momentum()[0];
        let mut solver = Explicit::new(&world);
        let dt = solver.time_step(&world);
        // exact: constant stress ρ c v until the release wave is back after 2 L/c
        let time = rows("wave_impact", "contact_time_us")[0].y;
        let (mut half, mut last_touch) = (0.0, 0.0);
        while world.time < 1.3 * time {
            let before = world.wall_impulse[0];
            solver.step(&mut world, dt).unwrap();
            if world.time <= 0.5 * time {
                half = world.wall_impulse[0] / world.time;
            }
            if world.wall_impulse[0] > before + 1e-3 * row.y * dt {
                last_touch = world.time;
            }
        }
        assert!((half / row.y - 1.0).abs() < 0.01, "{speed} m/s: mean stress {half}, exact {}", row.y);
        assert!((last_touch / time - 1.0).abs() < 0.03, "{speed} m/s: {last_touch} µs, exact {time}");
        let rebound = -world.momentum()[0] / momentum;
        // the layer of nodes at the wall stops dead: half a cell of 120 loses its energy
        assert!((rebound - 1.0).abs() < 0.01, "{speed} m/s: comes back with {rebound}");
    }
}

#[test]
fn rigid_motion_leaves_the_stress_of_a_body_alone() {
    for hardening in ["el", "1"] {
        let law = law(hardening);
        let mut body = Body::new(Arc::new(disc(8)), 2.0, [3.0, 4.0], &law.material);
        let n = body.displacement.len();
        let mut force = vec![0.0; n];
        // pressed flat, beyond yield
        for node in 0..n / 2 {
            body.displacement[2 * node + 1] = -0.1 * (body.reference(node)[1] - 4.0);
        }
        advance_points(&mut body, &law, &mut force).unwrap();
        let still = body.clone();
        let invariants = |body: &Body| -> Vec<[f64; 2]> {
            body.points.stress.iter().map(|s| [s.von_mises(), s.mean()]).collect()
        };
        let place = |node: usize| {
            let (x, u) = (still.reference(node), &still.displacement[2 * node..2 * node + 2]);
            [x[0] + u[0], x[1] + u[1]]
        };
        for step in 1..=100 {
            let (sin, cos) = libm::sincos(FRAC_PI_2 * f64::from(step) / 100.0);
            for node in 0..n / 2 {
                let (x, home) = (place(node), still.reference(node));
                body.displacement[2 * node] = cos * x[0] - sin * x[1] + 0.1 * f64::from(step) - home[0];
                body.displacement[2 * node + 1] = sin * x[0] + cos * x[1] - home[1];
            }
            advance_points(&mut body, &law, &mut force).unwrap();
        }
        // the midpoint rule turns exactly: what is left is round-off of a hundred steps
        for (before, after) in invariants(&still).into_iter().zip(invariants(&body)) {
            for k in 0..2 {
                let change = (after[k] - before[k]).abs();
                assert!(change < 1e-11, "H = {hardening}: {change} MPa in a quarter turn");
            }
        }
        let flow =
            still.points.plastic.iter().zip(&body.points.plastic).map(|(a, b)| b - a).fold(0.0, f64::max);
        assert!(flow < 1e-12, "H = {hardening}: turning flows by {flow}");
        // and one step of translation alone moves no stress at all
        let moved: Vec<f64> = still.displacement.iter().map(|u| u + 0.125).collect();
        let mut trial = Points::virgin(still.template.point_count());
        internal_force(&still, &moved, &law, &mut trial, &mut force).unwrap();
        for (a, b) in trial.stress.iter().zip(&still.points.stress) {
            assert!((a.yy - b.yy).abs() < 1e-12 && (a.xy - b.xy).abs() < 1e-12);
        }
    }
}
