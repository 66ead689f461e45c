//! The quick part of the stress suite (`docs/stability.md`): what breaks is caught, what does not break stays put.

use sim_core::dem::{Laws, SphereParameters, restore_spheres, spheres};
use sim_core::{KernelChoice, Options};

use crate::support::{bits, compaction, gas, quiet};

fn options() -> Options {
    Options { threads: 1, kernel: KernelChoice::Auto }
}

#[test]
fn the_estimated_limit_of_the_time_step_is_safe_and_near_the_true_one() {
    let parameters = SphereParameters { pressure: 1e-3, alpha_n: 0.05, ..compaction() };
    let mut settled = spheres(&parameters, &gas(5, 1.06, 0.01, 5), 0.1, Laws::Needed, &options());
    settled.run(8000).unwrap();
    let limit = settled.critical_dt();
    let saved = settled.save();
    let kinetic = |share: f64| {
        let mut dem = restore_spheres(&parameters, &saved, &options()).unwrap();
        dem.set_dt(share * limit);
        dem.run(4000).map(|()| dem.view().energies.kinetic())
    };
    let before = settled.view().energies.kinetic();
    assert!(kinetic(0.7).unwrap() < before);
    assert!(kinetic(1.0).unwrap() < before, "the limit is a bound, so it is stable itself");
    // Beyond twice the bound the stiffest modes grow until they are as strong as friction lets them.
    assert!(kinetic(2.0).map_or(f64::INFINITY, |energy| energy) > 10.0 * before);
}

#[test]
fn energy_of_a_conservative_packing_does_not_run_away() {
    let parameters = SphereParameters { pressure: 1e-3, wall_mass: 20.0, moving: [true; 6], ..quiet() };
    let mut dem = spheres(&parameters, &gas(2, 1.02, 0.01, 3), 0.05, Laws::Needed, &options());
    let start = dem.view().energies.total();
    let mut worst = 0.0_f64;
    for _ in 0..200 {
        dem.run(1000).unwrap();
        worst = worst.max((dem.view().energies.total() / start - 1.0).abs());
    }
    // (ω dt)²/24 of the vibration energy is the amplitude of the scheme's own oscillation; what opening and closing
    // contacts add performs a random walk that stays below ten times that here.
    assert!(worst < 10.0 * 0.05_f64.powi(2) / 24.0 * 2.0, "{worst:e}");
}

#[test]
fn spheres_in_one_place_are_reported_and_deep_overlaps_relax() {
    let parameters = SphereParameters { pressure: 1e-3, ..compaction() };
    for (distance, survives) in [(0.0, false), (1e-3, true), (0.5, true)] {
        let mut initial = gas(3, 1.3, 0.0, 1);
        initial.positions[13] = initial.positions[0];
        initial.positions[13][0] += distance;
        let mut dem = spheres(&parameters, &initial, 0.1, Laws::Needed, &options());
        match dem.run(3000) {
            Ok(()) => {
                assert!(survives, "{distance}");
                assert!(dem.max_speed() < 0.1);
            }
            Err(fault) => {
                assert!(!survives, "{distance}: {fault:?}");
                assert!(fault.step <= 64 && fault.what.contains("not finite"), "{fault:?}");
            }
        }
    }
}

#[test]
fn a_restart_every_few_steps_changes_nothing() {
    let parameters = SphereParameters { pressure: 1e-3, ..compaction() };
    let initial = gas(5, 1.1, 0.02, 7);
    let mut whole = spheres(&parameters, &initial, 0.1, Laws::Needed, &options());
    let mut broken = spheres(&parameters, &initial, 0.1, Laws::Needed, &options());
    for _ in 0..40 {
        whole.run(53).unwrap();
        broken.run(53).unwrap();
        broken = restore_spheres(&parameters, &broken.save(), &options()).unwrap();
        assert_eq!(bits(&whole.view()), bits(&broken.view()), "step {}", whole.steps());
    }
}

#[test]
fn frictions_at_both_ends_and_light_walls_stay_finite() {
    for (mu, wall_mass) in [(0.0, 20.0), (10.0, 20.0), (0.4, 0.5)] {
        let parameters = SphereParameters { pressure: 1e-3, mu, mu_wall: mu, wall_mass, ..compaction() };
        let mut dem = spheres(&parameters, &gas(4, 1.1, 0.02, 2), 0.02, Laws::Needed, &options());
        dem.run(6000).unwrap();
        let view = dem.view();
        assert!(!view.contacts.is_empty(), "{mu} {wall_mass}");
        assert!(view.energies.kinetic() < view.energies.load);
    }
}
