//! Rest, pull-off, Coulomb limit, servo walls.

use sim_core::dem::{Drag, Motion, SphereParameters};

use crate::support::{at, build, quiet};

#[test]
fn pair_rests_at_the_equilibrium_overlap() {
    for fc in [1e-5, 1e-3, 1e-2] {
        let parameters = SphereParameters { adhesion: fc, alpha_n: 0.25, ..quiet() };
        let ov = fc;
        let initial = at(&[[-0.5 + 0.5 * ov, 0.0, 0.0], [0.5 - 0.5 * ov, 0.0, 0.0]], &[[0.0; 3]; 2], 5.0);
        let mut dem = build(&parameters, &initial, 0.1);
        dem.run(1000).unwrap();
        let view = dem.view();
        assert_eq!(view.contacts.len(), 1);
        // δ_c = −f_c/k_n, to the round-off of positions.
        assert!((view.contacts[0].overlap - fc).abs() < 1e-14, "{:e}", view.contacts[0].overlap);
        assert!(view.contacts[0].normal_force.abs() < 1e-14);
    }
}

#[test]
fn contact_breaks_at_a_pull_of_exactly_the_adhesion() {
    // Low wall, sphere, sphere, high wall, glued more strongly to the walls than to each other; the high wall is so
    // heavy that it moves away at constant speed. The largest tension seen is f_c to the travel of a few steps.
    let fc = 1e-3;
    let speed = 4e-6;
    let dt = 0.1;
    let parameters = SphereParameters {
        adhesion: fc,
        wall_adhesion: 2.0 * fc,
        alpha_n: 0.25,
        wall_mass: 1e12,
        moving: [true; 6],
        ..quiet()
    };
    // Every contact starts at its rest overlap.
    let mut initial = at(&[[0.0; 3], [0.0; 3]], &[[0.0; 3]; 2], 1.5);
    let wall_ov = 2.0 * fc;
    let low = -1.0 + 0.5 * fc + wall_ov;
    initial.walls[0] = low;
    initial.positions[0] = [low + 0.5 - wall_ov, 0.0, 0.0];
    initial.positions[1] = [initial.positions[0][0] + 1.0 - fc, 0.0, 0.0];
    initial.walls[1] = initial.positions[1][0] + 0.5 - wall_ov;
    initial.wall_velocities[1] = speed;
    let mut dem = build(&parameters, &initial, dt);
    let mut strongest = 0.0_f64;
    let mut broken = false;
    for _ in 0..20_000 {
        dem.run(1).unwrap();
        let view = dem.view();
        let Some(contact) = view.contacts.first() else {
            broken = true;
            break;
        };
        strongest = strongest.max(-contact.normal_force);
    }
    assert!(broken, "the contact did not break");
    // The overlap of the pair shrinks by at most speed·dt a step.
    assert!(strongest <= fc && strongest > fc - 4.0 * speed * dt, "{strongest:e} of {fc:e}");
}

#[test]
fn tangential_force_is_limited_by_friction_times_the_elastic_force_alone() {
    // A sphere pressed by its own adhesion on a fixed wall, dragged along it: |f_t| = μ k_n ov while sliding although
    // the total normal force is about zero.
    let (fc, mu) = (1e-3, 0.4);
    let parameters = SphereParameters { wall_adhesion: fc, mu_wall: mu, mu, alpha_n: 0.25, ..quiet() };
    let initial = at(&[[0.0, 0.0, -5.0 + 0.5 - fc]], &[[2e-2, 0.0, 0.0]], 5.0);
    let mut dem = build(&parameters, &initial, 0.05);
    let mut slid = 0;
    for _ in 0..400 {
        dem.run(1).unwrap();
        let view = dem.view();
        let contact = view.wall_contacts[0];
        let tangential = contact.tangential.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((contact.elastic - contact.overlap).abs() < 1e-15);
        assert!(tangential <= mu * contact.elastic * (1.0 + 1e-12));
        if contact.sliding {
            slid += 1;
            assert!((tangential - mu * contact.elastic).abs() < 1e-12 * mu * contact.elastic);
            assert!(contact.normal_force.abs() < 0.1 * fc, "the total normal force is nearly zero");
        }
    }
    assert!(slid > 50, "slid in {slid} steps only");
    // Friction turns sliding into rolling: v = ω R, 5/7 of the initial speed for a solid sphere with arm R − ov/2.
    dem.set_drag(Drag::None);
    dem.run(4000).unwrap();
    let view = dem.view();
    let arm = 0.5 - 0.5 * view.wall_contacts[0].overlap;
    let rolling = 2e-2 / (1.0 + 0.1 / (arm * arm));
    assert!((view.velocities[0][0] - rolling).abs() < 0.02 * rolling, "{}", view.velocities[0][0]);
    assert!((view.spins[0][1] * arm - rolling).abs() < 0.05 * rolling, "{}", view.spins[0][1]);
}

#[test]
fn wall_without_particles_follows_pressure_times_area_over_mass() {
    // Only x high moves: S is constant, the motion is x = x0 − p S t²/2m_w, which leapfrog gives exactly.
    let parameters = SphereParameters {
        pressure: 1e-3,
        wall_mass: 7.0,
        moving: [false, true, false, false, false, false],
        ..quiet()
    };
    let mut initial = at(&[[0.0, 0.0, 0.0]], &[[0.0; 3]], 6.0);
    initial.walls = [-6.0, 6.0, -4.0, 4.0, -3.0, 3.0];
    let mut dem = build(&parameters, &initial, 0.1);
    dem.run(300).unwrap();
    let t = dem.time();
    let exact = 6.0 - 0.5 * 1e-3 * (8.0 * 6.0) * t * t / 7.0;
    let wall = dem.view().walls[1];
    assert!(
        (wall.position - exact).abs() < 1e-12 * exact.abs().max(6.0) * 300.0,
        "{} {exact}",
        wall.position
    );
    assert!((wall.velocity + 1e-3 * 48.0 * t / 7.0).abs() < 1e-13, "{}", wall.velocity);
}

#[test]
fn six_walls_without_particles_converge_with_order_two() {
    // Cube under pressure, all walls: gap L obeys L̈ = −2 p L²/m_w; reference by tiny classical Runge-Kutta steps.
    let (p, mw, t_end) = (2e-3, 5.0, 12.8);
    let (mut gap, mut rate) = (10.0_f64, 0.0_f64);
    let steps = 20_000;
    let h = t_end / f64::from(steps);
    let f = |gap: f64| -2.0 * p * gap * gap / mw;
    for _ in 0..steps {
        let (k1, l1) = (rate, f(gap));
        let (k2, l2) = (rate + 0.5 * h * l1, f(gap + 0.5 * h * k1));
        let (k3, l3) = (rate + 0.5 * h * l2, f(gap + 0.5 * h * k2));
        let (k4, l4) = (rate + h * l3, f(gap + h * k3));
        gap += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        rate += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
    }
    let parameters = SphereParameters { pressure: p, wall_mass: mw, moving: [true; 6], ..quiet() };
    let errors: Vec<f64> = [0.1, 0.05, 0.025]
        .into_iter()
        .map(|dt| {
            let mut dem = build(&parameters, &at(&[[0.0; 3]], &[[0.0; 3]], 5.0), dt);
            dem.run((t_end / dt).round() as u64).unwrap();
            let walls = dem.view().walls;
            ((walls[1].position - walls[0].position) - gap).abs()
        })
        .collect();
    let slope = crate::support::order(&errors);
    assert!((slope - 2.0).abs() < 0.1, "slope {slope} errors {errors:?}");
}

#[test]
fn drag_slows_a_free_particle_exponentially_with_order_two() {
    let rate = 0.3;
    let errors: Vec<f64> = [0.2, 0.1, 0.05]
        .into_iter()
        .map(|dt| {
            let mut dem = build(
                &SphereParameters { mu: 0.4, ..quiet() },
                &at(&[[0.0; 3]], &[[0.01, 0.0, 0.0]], 5.0),
                dt,
            );
            dem.set_drag(Drag::All(rate));
            dem.set_motion(&[Motion { particle: 0, velocity: [0.01, 0.0, 0.0], spin: [0.0, 0.02, 0.0] }]);
            dem.run((4.0 / dt).round() as u64).unwrap();
            let view = dem.view();
            // Kicks act on the velocity of t − dt/2.
            let exact = (-rate * (4.0 + 0.5 * dt)).exp();
            (view.velocities[0][0] / 0.01 - exact).abs().max((view.spins[0][1] / 0.02 - exact).abs())
        })
        .collect();
    let slope = crate::support::order(&errors);
    assert!((slope - 2.0).abs() < 0.1, "slope {slope} errors {errors:?}");
}
