//! What must be conserved, and how well.

use sim_core::contact::attraction::NoAttraction;
use sim_core::contact::damping::NoDamping;
use sim_core::contact::normal::Hooke;
use sim_core::contact::rolling::NoRolling;
use sim_core::contact::tangential::CoulombSpring;
use sim_core::contact::{ContactLaw, Law, PairGeometry, PairMotion};
use sim_core::dem::{SphereParameters, View};
use sim_core::lane::Number;
use sim_core::space::{Spatial, V3, Vector};

use crate::support::{at, build, gas, order, quiet};

fn momentum(view: &View) -> [f64; 3] {
    std::array::from_fn(|k| view.velocities.iter().map(|v| v[k]).sum())
}

/// Σ x × v + I ω about the origin.
fn angular_momentum(view: &View) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        (0..view.positions.len())
            .map(|i| {
                let (x, v) = (&view.positions[i], &view.velocities[i]);
                x[a] * v[b] - x[b] * v[a] + 0.1 * view.spins[i][k]
            })
            .sum()
    })
}

#[test]
fn linear_and_angular_momentum_are_kept_to_round_off() {
    // A cluster of cohesive, frictional, damped spheres far from the walls.
    let parameters = SphereParameters { adhesion: 1e-3, alpha_n: 0.25, mu: 0.4, ..quiet() };
    let mut initial = gas(3, 1.05, 0.02, 5);
    initial.walls = [-50.0, 50.0, -50.0, 50.0, -50.0, 50.0];
    for (x, v) in initial.positions.iter().zip(&mut initial.velocities) {
        // Inwards, so that they meet.
        *v = std::array::from_fn(|k| v[k] - 0.01 * (x[k] - 1.6));
    }
    let mut dem = build(&parameters, &initial, 0.05);
    let start = dem.view();
    let contacts = |view: &View| view.contacts.iter().filter(|contact| contact.sliding).count();
    let mut met = 0;
    let mut slid = 0;
    for _ in 0..40 {
        dem.run(50).unwrap();
        let view = dem.view();
        met = met.max(view.contacts.len());
        slid = slid.max(contacts(&view));
        let (p, l) = (momentum(&view), angular_momentum(&view));
        let (p0, l0) = (momentum(&start), angular_momentum(&start));
        for k in 0..3 {
            // 27 particles, 2000 steps, terms of at most 0.02 (p) and 0.06 (L) in size.
            assert!((p[k] - p0[k]).abs() < 1e-13, "momentum {k}: {:e}", p[k] - p0[k]);
            // The couple of a contact acts at one point for both bodies, so L is exact as well; positions are those
            // of t, velocities are advanced to t by half a kick, whose torque about the origin is the same force's.
            assert!((l[k] - l0[k]).abs() < 1e-11, "angular momentum {k}: {:e}", l[k] - l0[k]);
        }
    }
    assert!(met > 10 && slid > 0, "the test needs contacts ({met}) and sliding ({slid})");
}

#[test]
fn energy_error_of_elastic_motion_falls_with_order_two() {
    for adhesion in [0.0, 2e-4] {
        let parameters = SphereParameters { adhesion, ..quiet() };
        let errors: Vec<f64> = [0.1, 0.05, 0.025, 0.0125]
            .into_iter()
            .map(|dt| {
                // Mean over systems: single ones scatter with the phases of their collisions.
                (0..6)
                    .map(|seed| {
                        let mut dem = build(&parameters, &gas(3, 1.1, 0.02, seed), dt);
                        let start = dem.view().energies.total();
                        let mut sum = 0.0;
                        for _ in 0..20 {
                            dem.run((1.0 / dt).round() as u64).unwrap();
                            let error = (dem.view().energies.total() - start) / start;
                            sum += error * error;
                        }
                        sum
                    })
                    .sum::<f64>()
                    .sqrt()
            })
            .collect();
        let slope = order(&errors);
        assert!(slope > 1.7, "adhesion {adhesion}: slope {slope:.2} errors {errors:?}");
    }
}

#[test]
fn energy_of_a_sticking_frictional_pair_is_kept_with_order_two() {
    // Two spheres that touch and roll, twist and swing about each other; friction without bound, no damping: the
    // tangential spring must give back what it takes.
    let parameters = SphereParameters { adhesion: 1e-2, mu: 1e6, ..quiet() };
    let errors: Vec<f64> = [0.1, 0.05, 0.025]
        .into_iter()
        .map(|dt| {
            let mut initial =
                at(&[[-0.495, 0.0, 0.0], [0.495, 0.0, 0.0]], &[[0.0, -2e-3, 1e-3], [0.0, 3e-3, 0.0]], 9.0);
            initial.spins = vec![[4e-3, 6e-3, 0.0], [-2e-3, 1e-3, 8e-3]];
            let mut dem = build(&parameters, &initial, dt);
            let start = dem.view().energies;
            let mut worst = 0.0_f64;
            for _ in 0..(60.0 / dt) as u64 {
                dem.run(1).unwrap();
                let now = dem.view().energies;
                worst = worst.max((now.total() - start.total()).abs() / start.kinetic());
            }
            worst
        })
        .collect();
    let slope = order(&errors);
    assert!(slope > 1.7, "slope {slope:.2} errors {errors:?}");
}

/// A point turned about a unit axis by an angle (Rodrigues).
fn turn(x: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    let along: f64 = (0..3).map(|k| axis[k] * x[k]).sum();
    std::array::from_fn(|k| {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        c * x[k] + s * (axis[a] * x[b] - axis[b] * x[a]) + (1.0 - c) * along * axis[k]
    })
}

#[test]
fn tangential_spring_turns_with_a_rigidly_rotating_pair() {
    // The law is fed the kinematics of a rigid rotation by 2 rad about axes across the contact, along it and oblique,
    // as the scheme sees them: positions of t_n, chord velocities, spins. The spring must turn with the bodies.
    let law = Law {
        normal: Hooke { kn: 1.0 },
        damping: NoDamping,
        attraction: NoAttraction,
        tangential: CoulombSpring { kt: 1.5, mu: 1e9 },
        rolling: NoRolling,
    };
    let radius = 0.5;
    let separation = [0.98, 0.0, 0.0];
    // Large, so that what is measured is its turning and not the slip of chords (second order as well).
    let spring = [0.0, 0.3, -0.2];
    for axis in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.6, 0.0, 0.8], [0.0, 0.8, 0.6]] {
        let errors: Vec<f64> = [0.1, 0.05, 0.025]
            .into_iter()
            .map(|dt| {
                let (angle, time) = (2.0, 10.0);
                let steps = (time / dt) as usize;
                let omega = angle / time;
                let mut memory = [0.0; 3 * f64::GROUP];
                for k in 0..3 {
                    memory[k * f64::GROUP] = 1.5 * spring[k];
                }
                let mut force = [0.0; 3];
                for n in 1..=steps {
                    let now = turn(separation, axis, omega * dt * n as f64);
                    let before = turn(separation, axis, omega * dt * (n - 1) as f64);
                    let spin = V3(axis.map(|x| x * omega));
                    let geometry = PairGeometry::<Spatial<f64>, f64> {
                        normal: V3(now.map(|x| x / 0.98)),
                        overlap: 0.02,
                        inverse_distance: 1.0 / 0.98,
                        radius_a: radius,
                        radius_b: radius,
                        root_mass: 1.0,
                    };
                    let motion = PairMotion::<Spatial<f64>, f64> {
                        velocity: V3(std::array::from_fn(|k| (now[k] - before[k]) / dt)),
                        rim: None,
                        spin_sum: spin.scale(2.0),
                        spin_difference: V3([0.0; 3]),
                    };
                    let encounter = law.encounter::<f64>(&geometry, &motion, dt);
                    // Along its normal the pair does not move; with the chord of an angle θ for the velocity the
                    // rate is at most d (1 − cos θ)²/2dt, where −v·n alone is d (1 − cos θ)/dt.
                    let versine = 1.0 - libm::cos(omega * dt);
                    let rate = encounter.approach.abs();
                    assert!(rate < 0.98 * versine * versine / (2.0 * dt) + 1e-13, "axis {axis:?}: {rate}");
                    let still = motion.spin_difference;
                    // SAFETY: three slots for one lane.
                    let response =
                        unsafe { law.forces::<f64>(&geometry, &encounter, still, dt, memory.as_mut_ptr()) };
                    force = response.tangential.0;
                }
                let exact = turn(spring, axis, angle).map(|x| 1.5 * x);
                let size = 1.5 * 0.36;
                (0..3).map(|k| (force[k] - exact[k]).abs()).fold(0.0, f64::max) / size
            })
            .collect();
        let slope = order(&errors);
        assert!(slope > 1.9 || errors[2] < 1e-10, "axis {axis:?}: slope {slope:.2} errors {errors:?}");
        // A spring that were only projected would lose ω² dt t/2 of its size: 2e-2 at the largest step here.
        assert!(errors[0] < 2e-3, "axis {axis:?}: {errors:?}");
    }
}
