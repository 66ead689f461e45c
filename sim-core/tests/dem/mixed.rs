//! Mixed precision: the same bits on every path, and how far it is from double precision.

use sim_core::dem::{InitialState, Laws, SphereParameters, restore_spheres, spheres};

use crate::support::{self, at, bits, build, fast, paths_agree, quiet, scalar};

/// Largest relative rounding of a number in single precision.
const ROUNDING: f64 = 6e-8;

/// A violent compaction in mixed precision.
fn violent(n: usize) -> (SphereParameters, InitialState) {
    let (parameters, initial) = support::violent(n);
    (SphereParameters { mixed: true, ..parameters }, initial)
}

#[test]
fn every_path_gives_the_same_bits() {
    // All laws, no dashpot, no friction.
    for (alpha_n, mu) in [(0.25, 0.4), (0.0, 0.4), (0.25, 0.0)] {
        let (parameters, initial) = violent(7);
        let parameters = SphereParameters { alpha_n, mu, mu_wall: mu, ..parameters };
        assert!(paths_agree(&parameters, &initial) > 500);
        let name = build(&parameters, &initial, 0.1).kernel();
        assert!(name.starts_with("dem3d+mixed+"), "{name}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (parameters, initial) = violent(21);
    let views = [1, 2, 3].map(|threads| {
        let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(threads));
        dem.run(120).unwrap();
        dem.view()
    });
    assert!(views[0].contacts.len() > 2000, "{} contacts", views[0].contacts.len());
    for view in &views[1..] {
        assert_eq!(bits(view), bits(&views[0]));
    }
}

#[test]
fn a_resumed_run_gives_the_same_bits() {
    let (parameters, initial) = violent(6);
    let mut whole = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    whole.run(287).unwrap();
    let saved = whole.save();
    let mut resumed = restore_spheres(&parameters, &saved, &scalar()).unwrap();
    assert_eq!(resumed.save(), saved, "a restored state saves to the same bytes");
    // Across a sort of the particles.
    whole.run(8192).unwrap();
    resumed.run(8192).unwrap();
    assert_eq!(whole.save(), resumed.save());
    let double = SphereParameters { mixed: false, ..parameters };
    let message = restore_spheres(&double, &saved, &fast(1)).err().unwrap().to_string();
    assert!(message.contains("kernel"), "{message}");
}

#[test]
fn lists_hold_exactly_the_pairs_that_touch() {
    let (parameters, initial) = violent(6);
    let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &fast(1));
    for _ in 0..30 {
        dem.run(37).unwrap();
        let view = dem.view();
        let mut touching = Vec::new();
        for i in 0..view.positions.len() {
            for j in i + 1..view.positions.len() {
                let square: f64 = (0..3).map(|k| (view.positions[j][k] - view.positions[i][k]).powi(2)).sum();
                if square < 1.0 {
                    touching.push((i, j));
                }
            }
        }
        let listed: Vec<(usize, usize)> =
            view.contacts.iter().map(|contact| (contact.i, contact.j)).collect();
        assert_eq!(listed, touching, "step {}", view.step);
    }
}

#[test]
fn a_tiny_overlap_keeps_its_relative_accuracy() {
    // Half a box away from the origin, overlaps down to a thousandth of what single precision resolves of a distance.
    for overlap in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10_f64] {
        let (x, y) = (20.0 / 3.0, -17.0 / 7.0);
        let along = (1.0 - overlap) / 3.0_f64.sqrt();
        let places = [[x, y, 5.1], [x + along, y + along, 5.1 + along]];
        let parameters = SphereParameters { mixed: true, ..quiet() };
        let view = build(&parameters, &at(&places, &[[0.0; 3]; 2], 30.0), 0.01).view();
        // What doubles of this size can say of the overlap.
        let exact = 1.0 - (0..3).map(|k| (places[1][k] - places[0][k]).powi(2)).sum::<f64>().sqrt();
        let kept = view.contacts[0].elastic;
        assert!((kept - exact).abs() < 4.0 * ROUNDING * exact + 4e-15, "{overlap}: {kept:e} {exact:e}");
        let force = (0..3).map(|k| view.forces[0][k].powi(2)).sum::<f64>().sqrt();
        assert!((force - kept).abs() < 4.0 * ROUNDING * kept, "{force:e} {kept:e}");
    }
}

#[test]
fn a_collision_differs_from_double_precision_by_rounding() {
    // 60 steps in contact, each rounding a velocity a few times; the errors add up like a random walk at worst.
    let (v0, dt) = (1e-2, 0.05);
    for (alpha, fc) in [(0.0, 0.0), (0.25, 0.0), (0.25, 1e-3)] {
        let rebound = |mixed: bool| {
            let parameters = SphereParameters { alpha_n: alpha, adhesion: fc, mixed, ..quiet() };
            let places = [[-0.501, 0.1, 0.0], [0.501, 0.1, 0.0]];
            let speeds = [[0.5 * v0, 0.0, 0.0], [-0.5 * v0, 0.0, 0.0]];
            let mut dem = build(&parameters, &at(&places, &speeds, 9.0), dt);
            dem.run(120).unwrap();
            let view = dem.view();
            view.velocities[1][0] - view.velocities[0][0]
        };
        let (single, double) = (rebound(true), rebound(false));
        assert!(double > 0.0, "they parted: {double}");
        assert_ne!(single, double);
        assert!((single - double).abs() < 30.0 * ROUNDING * v0, "{alpha} {fc}: {single:e} {double:e}");
    }
}
