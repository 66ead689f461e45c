//! Fast against plain, null laws against full laws, one thread against several, resumed against uninterrupted.

use sim_core::dem::{Drag, Laws, Motion, SphereParameters, View, restore_spheres, spheres};
use sim_core::{KernelChoice, Options};

use crate::support::{at, bits, fast, gas, paths_agree, quiet, scalar, violent};

#[test]
fn vector_path_gives_the_bits_of_the_scalar_path() {
    let (parameters, initial) = violent(7);
    assert!(paths_agree(&parameters, &initial) > 700);
}

#[test]
fn machine_with_vectors_runs_the_vector_kernel() {
    let (parameters, initial) = violent(2);
    let kernel_of =
        |kernel| spheres(&parameters, &initial, 0.1, Laws::Needed, &Options { threads: 1, kernel }).kernel();
    let (mut auto, mut avx2) = (";scalar", ";scalar");
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        (auto, avx2) = (";avx2", ";avx2");
        // Machines that have these four have what else the kernel uses.
        let parts = [
            std::arch::is_x86_feature_detected!("avx512f"),
            std::arch::is_x86_feature_detected!("avx512vl"),
            std::arch::is_x86_feature_detected!("avx512dq"),
            std::arch::is_x86_feature_detected!("avx512bw"),
        ];
        if parts == [true; 4] {
            auto = ";avx512";
        }
    }
    for (choice, name) in
        [(KernelChoice::Auto, auto), (KernelChoice::Avx2, avx2), (KernelChoice::Scalar, ";scalar")]
    {
        assert!(kernel_of(choice).ends_with(name), "{choice:?}: {}", kernel_of(choice));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    // 21³ particles make four chunks.
    let (parameters, initial) = violent(21);
    let mut views = [1, 2, 3, 4].map(|threads| {
        let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(threads));
        dem.run(90).unwrap();
        dem.run(30).unwrap();
        dem.view()
    });
    assert!(views[0].contacts.len() > 2000, "{} contacts", views[0].contacts.len());
    let first = bits(&views[0]);
    for view in &mut views[1..] {
        assert_eq!(bits(view), first);
    }
}

#[test]
fn resumed_run_gives_the_same_bits_at_every_later_step() {
    let (parameters, initial) = violent(6);
    let mut whole = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    whole.run(150).unwrap();
    whole.set_drag(Drag::Each((0..216).map(|i| 1e-3 * f64::from(i % 3)).collect()));
    whole.run(137).unwrap();
    let saved = whole.save();
    let mut resumed = restore_spheres(&parameters, &saved, &scalar()).unwrap();
    assert_eq!(resumed.save(), saved, "a restored state saves to the same bytes");
    for _ in 0..200 {
        whole.run(1).unwrap();
        resumed.run(1).unwrap();
        assert_eq!(whole.view(), resumed.view(), "step {}", whole.steps());
    }
    // Across a sort of the particles.
    let to_sort = 8192 - whole.steps() % 8192 + 10;
    whole.run(to_sort).unwrap();
    resumed.run(to_sort).unwrap();
    assert_eq!(bits(&whole.view()), bits(&resumed.view()));
    assert_eq!(whole.save(), resumed.save());
}

#[test]
fn slicing_of_steps_changes_nothing() {
    let (parameters, initial) = violent(4);
    let mut whole = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    let mut sliced = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    whole.run(300).unwrap();
    for steps in [1, 7, 0, 92, 200] {
        sliced.run(steps).unwrap();
        let _ = sliced.view();
    }
    assert_eq!(whole.view(), sliced.view());
}

#[test]
fn state_of_other_parameters_or_damaged_bytes_are_refused() {
    let (parameters, initial) = violent(2);
    let dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    let saved = dem.save();
    let other = SphereParameters { mu: 0.0, mu_wall: 0.0, ..parameters.clone() };
    let message = restore_spheres(&other, &saved, &fast(1)).err().unwrap().to_string();
    assert!(message.contains("kernel"), "{message}");
    for cut in [0, 1, saved.len() / 2, saved.len() - 1] {
        assert!(restore_spheres(&parameters, &saved[..cut], &fast(1)).is_err(), "cut at {cut}");
    }
}

#[test]
fn null_laws_give_the_trajectory_of_full_laws_with_zero_coefficients() {
    for (alpha_n, adhesion, mu) in
        [(0.0, 0.0, 0.0), (0.25, 0.0, 0.0), (0.0, 1e-3, 0.0), (0.0, 0.0, 0.4), (0.25, 1e-3, 0.0)]
    {
        let parameters = SphereParameters {
            pressure: 2e-3,
            adhesion,
            alpha_n,
            mu,
            mu_wall: mu,
            wall_mass: 20.0,
            moving: [true; 6],
            ..quiet()
        };
        let initial = gas(4, 1.08, 0.02, 3);
        let mut null = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
        let mut full = spheres(&parameters, &initial, 0.1, Laws::All, &fast(1));
        assert_ne!(null.kernel(), full.kernel());
        null.run(600).unwrap();
        full.run(600).unwrap();
        let (a, b) = (null.view(), full.view());
        assert!(a.contacts.len() > 20);
        // Without friction there are no spins at all; without dashpot or adhesion no share of a step is computed, and
        // force × 1 is the force. So positions are equal to the last bit.
        let skip_spin = mu == 0.0;
        assert_eq!(a.positions, b.positions, "{alpha_n} {adhesion} {mu}");
        assert_eq!(a.velocities, b.velocities);
        if !skip_spin {
            assert_eq!(a.spins, b.spins);
        }
    }
}

/// The view reads the lists; the oracle tests every pair of its positions.
fn assert_nothing_is_missing(view: &View) {
    let mut touching = Vec::new();
    for i in 0..view.positions.len() {
        for j in i + 1..view.positions.len() {
            let square: f64 = (0..3).map(|k| (view.positions[j][k] - view.positions[i][k]).powi(2)).sum();
            if square.sqrt() < 1.0 {
                touching.push((i, j));
            }
        }
    }
    let listed: Vec<(usize, usize)> = view.contacts.iter().map(|contact| (contact.i, contact.j)).collect();
    assert_eq!(listed, touching, "step {}", view.step);
    let at_walls = (0..view.positions.len())
        .flat_map(|i| (0..6).map(move |wall| (i, wall)))
        .filter(|&(i, wall)| {
            let outward = if wall % 2 == 1 { 1.0 } else { -1.0 };
            (view.walls[wall].position - view.positions[i][wall / 2]) * outward < 0.5
        })
        .collect::<Vec<_>>();
    let listed: Vec<(usize, usize)> =
        view.wall_contacts.iter().map(|contact| (contact.particle, contact.wall)).collect();
    assert_eq!(listed, at_walls, "step {}", view.step);
}

#[test]
fn forces_of_the_lists_are_those_of_all_pairs() {
    let (parameters, initial) = violent(6);
    let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    for _ in 0..30 {
        dem.run(37).unwrap();
        assert_nothing_is_missing(&dem.view());
    }
}

#[test]
fn lists_that_live_on_miss_nothing() {
    // A packing that still rings, where few particles go far at a time.
    let (parameters, initial) = violent(7);
    let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    dem.run(1000).unwrap();
    let before = dem.counters();
    for _ in 0..300 {
        dem.run(11).unwrap();
        assert_nothing_is_missing(&dem.view());
    }
    let after = dem.counters();
    assert!(after.prolonged - before.prolonged > 20, "{} {}", after.prolonged, after.refreshes);
}

#[test]
fn a_sphere_that_flies_far_meets_what_lies_there() {
    // The others are at rest and out of reach, so nothing but the margin of the near pairs asks for new lists on its way.
    let mut positions: Vec<[f64; 3]> =
        (0..12).map(|k| [-4.0 + 2.0 * f64::from(k % 4), 3.0, 2.0 * f64::from(k / 4)]).collect();
    positions.extend([[-4.0, 0.0, 0.0], [0.0, 0.1, 0.0]]);
    let mut velocities = vec![[0.0; 3]; positions.len()];
    velocities[12] = [0.02, 0.0, 0.0];
    let mut dem = spheres(&quiet(), &at(&positions, &velocities, 6.0), 0.1, Laws::Needed, &fast(1));
    for _ in 0..200 {
        dem.run(10).unwrap();
        assert_nothing_is_missing(&dem.view());
    }
    assert!(dem.counters().prolonged > 5, "{}", dem.counters().prolonged);
    assert!(dem.view().velocities[13] != [0.0; 3], "they have met");
}

#[test]
fn changing_the_time_step_keeps_the_velocities_of_the_instant() {
    let (parameters, initial) = violent(4);
    let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    dem.run(200).unwrap();
    let before = dem.view();
    dem.set_dt(0.05);
    let after = dem.view();
    for (a, b) in before.velocities.iter().zip(&after.velocities) {
        for k in 0..3 {
            // Friction and dashpots evaluated with another step differ by their own order only.
            assert!((a[k] - b[k]).abs() < 2e-4, "{} {}", a[k], b[k]);
        }
    }
    assert_eq!(before.positions, after.positions);
}

#[test]
fn blown_up_state_is_reported_and_not_continued() {
    let (parameters, initial) = violent(3);
    let mut dem = spheres(&parameters, &initial, 5.0, Laws::Needed, &fast(1));
    let fault = dem.run(1000).unwrap_err();
    assert!(fault.step <= 1000, "{fault:?}");
    let mut hit = initial.clone();
    hit.velocities[3] = [f64::NAN, 0.0, 0.0];
    let mut dem = spheres(&parameters, &hit, 0.1, Laws::Needed, &fast(1));
    assert!(dem.run(1000).unwrap_err().what.contains("not finite"));
    let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    dem.set_motion(&[Motion { particle: 1, velocity: [1e9, 0.0, 0.0], spin: [0.0; 3] }]);
    assert!(dem.run(1000).is_err());
    // Outside the walls, with a step too short to come back.
    let outside = at(&[[0.0; 3], [3.6, 0.0, 0.0]], &[[0.0; 3]; 2], 2.5);
    let mut dem = spheres(&quiet(), &outside, 1e-4, Laws::Needed, &fast(1));
    assert!(dem.run(64).unwrap_err().what.contains("outside the walls"));
    let inside = at(&[[0.0; 3], [3.4, 0.0, 0.0]], &[[0.0; 3]; 2], 2.5);
    let mut dem = spheres(&quiet(), &inside, 1e-4, Laws::Needed, &fast(1));
    assert!(dem.run(64).is_ok());
}

#[test]
fn time_step_bound_sees_rotation_and_number_of_contacts() {
    let (parameters, initial) = violent(6);
    let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    assert_eq!(dem.critical_dt(), f64::INFINITY);
    dem.run(600).unwrap();
    let frictional = dem.critical_dt();
    assert!(frictional > 0.1 && frictional < 0.6, "{frictional}");
    let smooth = SphereParameters { mu: 0.0, mu_wall: 0.0, ..parameters };
    let mut dem = spheres(&smooth, &initial, 0.1, Laws::Needed, &fast(1));
    dem.run(600).unwrap();
    assert!(dem.critical_dt() > frictional, "{} {frictional}", dem.critical_dt());
}
