//! Whole runs through the interface of the program.

use scene::{Reduced, Scene};
use serde_json::json;
use sim_core::{KernelChoice, Options, Simulation, compile, restore};

fn small(keys: &serde_json::Value) -> Reduced {
    let mut scene = json!({
        "model": "cohesive_discs", "n": 60, "assembly": "type1", "phi_i": 0.4, "assembly_cell_mass": 10,
        "p0": 0.1, "path": [{"to": 1.0, "per_decade": 2}, {"to": 0.1, "per_decade": 1}],
    });
    scene.as_object_mut().unwrap().extend(keys.as_object().unwrap().clone());
    Scene::from_json(&scene).unwrap().reduce()
}

fn finish(run: &mut dyn Simulation, slice: u64) {
    while !run.advance(slice).unwrap().finished {}
}

#[test]
fn a_loading_path_gives_one_row_per_equilibrium_state() {
    let mut run = compile(&small(&json!({})), &Options::default()).unwrap();
    finish(run.as_mut(), 100_000);
    let outcome = run.outcome().unwrap();
    assert_eq!(outcome.record.text("status"), Some("equilibrium"));
    let pressures: Vec<f64> = outcome.states.iter().map(|row| row.real("p").unwrap()).collect();
    assert_eq!(pressures.len(), 4);
    assert!((pressures[1] - 0.1 * 10_f64.sqrt()).abs() < 1e-9 && pressures[2] == 1.0 && pressures[3] == 0.1);
    for row in &outcome.states {
        assert_eq!(row.get("converged"), Some(&record::Cell::Flag(true)));
        // The stresses are those imposed, within the tolerance; the mean force obeys eq. (11) within its approximation.
        let (p, f1) = (row.real("p").unwrap(), row.real("p").unwrap().max(1.0));
        for stress in ["sigma_1", "sigma_2"] {
            assert!((row.real(stress).unwrap() - p).abs() < 1.2e-5 * f1, "{row:?}");
        }
        assert!(row.real("residual_force").unwrap() < 1e-5);
        let z = row.real("z").unwrap();
        let parts = ["z_plus", "z_minus", "z_zero"].map(|name| row.real(name).unwrap()).iter().sum::<f64>();
        assert!((z - parts).abs() < 1e-12);
        assert_eq!(row.real("stiffness_sign"), Some(1.0), "{row:?}");
        let (voigt, bulk) = (row.real("bulk_voigt").unwrap(), row.real("bulk").unwrap());
        assert!(bulk > 0.0 && bulk < voigt);
    }
    // Compression is plastic, unloading is not.
    let phi: Vec<f64> = outcome.states.iter().map(|row| row.real("phi").unwrap()).collect();
    assert!(phi[2] >= phi[0] && (phi[3] - phi[2]).abs() < 0.01, "{phi:?}");
    assert!(outcome.states[1].get("contacts_kept").is_some());
    for table in ["cell", "particles", "contacts", "scattering", "normal_forces"] {
        assert!(!outcome.packing.0[table].columns().is_empty(), "{table}");
    }
}

#[test]
fn type_2_aggregates_to_one_cluster_first() {
    let scene = small(&json!({"assembly": "type2", "n": 40, "path": []}));
    let mut run = compile(&scene, &Options::default()).unwrap();
    finish(run.as_mut(), 100_000);
    let outcome = run.outcome().unwrap();
    assert_eq!(outcome.states.len(), 2);
    assert_eq!(outcome.states[0].text("branch"), Some("rest"));
    assert_eq!(outcome.states[0].real("p"), Some(0.0));
    assert!(outcome.states[0].real("z").unwrap() > 1.9);
    assert_eq!(outcome.states[1].text("branch"), Some("assembly"));
}

#[test]
fn slices_resume_and_path_change_no_bit() {
    let scene = small(&json!({"n": 40}));
    let mut whole = compile(&scene, &Options::default()).unwrap();
    finish(whole.as_mut(), 1_000_000);
    let scalar = Options { threads: 1, kernel: KernelChoice::Scalar };
    let mut parts = compile(&scene, &scalar).unwrap();
    let mut slices = 0;
    while !parts.advance(7_777).unwrap().finished {
        slices += 1;
        if slices % 3 == 0 {
            parts = restore(&scene, &Options::default(), &parts.save()).unwrap();
        }
    }
    assert_eq!(whole.outcome().unwrap(), parts.outcome().unwrap());
    let other = small(&json!({"n": 40, "seed": 2}));
    assert!(restore(&other, &Options::default(), &whole.save()).is_err());
}

#[test]
fn a_state_that_does_not_come_to_rest_ends_the_run() {
    let mut run = compile(&small(&json!({"max_time": 2.0})), &Options::default()).unwrap();
    finish(run.as_mut(), 100_000);
    let outcome = run.outcome().unwrap();
    assert_eq!(outcome.record.text("status"), Some("not_converged"));
    assert_eq!(outcome.states.len(), 1);
    assert_eq!(outcome.states[0].get("converged"), Some(&record::Cell::Flag(false)));
}
