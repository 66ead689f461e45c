//! The hostile corners of the grid end with a status or a typed error.

use serde_json::json;
use sim_core::{Options, SimError};

use crate::support::{run, scene};

const STATUSES: [&str; 4] = ["equilibrium", "e_converged", "kinetic_energy", "step_limit"];

#[test]
fn every_corner_ends() {
    let options = Options::default();
    let mut ended = 0;
    let mut unstable = 0;
    for (p, sigma_e) in [(1e4, 2e11), (1e6, 5e8), (1e5, 1e10)] {
        for cohesion in [0.0, 1e-3, 0.8] {
            for alpha_n in [0.0, 0.25, 1.0] {
                for (mw, mu) in [(1.0, 0.0), (1e6, 10.0), (96.0, 0.4)] {
                    let keys = json!({
                        "n": 40, "ei": 2.5, "p": p, "sigma_e": sigma_e, "sigma_c": cohesion * sigma_e,
                        "alpha_n": alpha_n, "mw": mw, "mu": mu, "max_steps": 2500,
                    });
                    match run(&scene(&keys), &options) {
                        Ok(outcome) => {
                            let status = outcome.record.text("status").unwrap().to_owned();
                            assert!(STATUSES.contains(&status.as_str()), "{keys}: {status}");
                            ended += 1;
                        }
                        Err(SimError::Unstable { .. }) => unstable += 1,
                        Err(other) => panic!("{keys}: {other}"),
                    }
                }
            }
        }
    }
    assert_eq!(ended + unstable, 81);
    assert_eq!(unstable, 0, "a typed error would be allowed, but none of these needs it");
}

#[test]
fn very_few_spheres_run_or_name_ei() {
    let options = Options::default();
    for n in [1, 2, 3] {
        let dense = run(&scene(&json!({ "n": n, "max_steps": 2000 })), &options);
        assert!(matches!(dense, Err(SimError::Scene { ref field, .. }) if field == "ei"), "n = {n}");
        let loose = run(&scene(&json!({ "n": n, "ei": 9.0, "max_steps": 2000 })), &options).unwrap();
        assert!(loose.record.real("e").unwrap().is_finite());
    }
}

#[test]
fn a_time_step_far_too_large_is_caught_retried_once_and_reported() {
    let error = run(&scene(&json!({ "dt": 3.0, "max_steps": 5000 })), &Options::default()).unwrap_err();
    let SimError::Unstable { step, retried_dt, .. } = error else { panic!("{error}") };
    assert!(step <= 5000);
    assert!((retried_dt - 1.5).abs() < 1e-12);
}

#[test]
fn a_time_step_above_the_limit_of_the_network_is_lowered_and_says_why() {
    let run = |keys| run(&scene(&keys), &Options::default()).unwrap();
    let expected = run(json!({ "max_steps": 20000 })).record.real("e").unwrap();
    for dt in [0.4, 0.6] {
        let outcome = run(json!({ "dt": dt, "max_steps": 20000 }));
        let reason = outcome.record.text("dt_reason").unwrap();
        assert!(reason.contains("stiffest mode"), "{reason}");
        assert!(outcome.record.real("dt").unwrap() < 0.3);
        // Scatter of 200 spheres between steps and seeds is 0.01; unnoticed, the step of 0.4 τ gave e = 0.88 for 1.35.
        let e = outcome.record.real("e").unwrap();
        assert!((e - expected).abs() < 0.04, "dt {dt}: {e} for {expected}");
    }
}

#[test]
fn a_gas_between_light_walls_is_not_settled() {
    // walls of 0.01 particle masses allow a time step of 2e-5 τ: e cannot have moved, and the walls carry p at once
    for stop in ["evidence", "settled"] {
        let keys = json!({
            "n": 200, "seed": 1, "p": 1e6, "sigma_e": 1e9, "sigma_c": 3e6, "mw": 0.01, "max_steps": 3000, "stop": stop,
        });
        let outcome = run(&scene(&keys), &Options::default()).unwrap();
        assert_eq!(
            outcome.record.text("status"),
            Some("step_limit"),
            "{stop}: {:?}",
            outcome.record.text("criteria")
        );
        assert!(outcome.record.real("z").unwrap() < 0.1, "still a gas");
    }
}
