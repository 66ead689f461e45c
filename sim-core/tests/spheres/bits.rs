//! The same scene gives the same bits, however it is described, sliced, resumed or computed.

use serde_json::json;
use sim_core::{KernelChoice, Options, SimError, compile, restore};

use crate::support::{fingerprint, run, scene};

fn kicked() -> scene::Reduced {
    // every phase of a run: natural, kicks, drag
    scene(&json!({ "n": 120, "approach": "rolling_kicks", "max_steps": 20_000 }))
}

#[test]
fn slicing_changes_nothing() {
    let scene = kicked();
    let options = Options::default();
    let mut whole = compile(&scene, &options).unwrap();
    whole.advance(20_000).unwrap();
    let mut sliced = compile(&scene, &options).unwrap();
    let mut slice = 1;
    while !sliced.advance(slice).unwrap().finished {
        slice = slice % 997 + 13;
    }
    assert_eq!(fingerprint(whole.as_ref()), fingerprint(sliced.as_ref()));
    assert!(whole.outcome().unwrap().record.real("kicks").unwrap() > 0.0, "the kicks were exercised");
}

#[test]
fn a_resumed_run_gives_the_same_bits_at_every_later_step() {
    let scene = kicked();
    let options = Options::default();
    let mut original = compile(&scene, &options).unwrap();
    original.advance(2777).unwrap();
    let saved = original.save();
    let mut resumed = restore(&scene, &options, &saved).unwrap();
    assert_eq!(resumed.save(), saved);
    for stride in [1, 1, 7, 300, 1000, 3000, 20_000] {
        let progress = original.advance(stride).unwrap();
        assert_eq!(resumed.advance(stride).unwrap(), progress);
        assert_eq!(resumed.save(), original.save(), "after {} steps", progress.steps);
    }
    assert!(original.progress().finished);
    assert_eq!(fingerprint(original.as_ref()), fingerprint(resumed.as_ref()));
}

#[test]
fn threads_and_code_path_change_nothing() {
    let scene = scene(&json!({ "n": 300, "max_steps": 3000 }));
    let with = |threads, kernel| {
        let mut outcome = run(&scene, &Options { threads, kernel }).unwrap();
        outcome.record.put("kernel", "any");
        serde_json::to_string(&outcome).unwrap()
    };
    let one = with(1, KernelChoice::Auto);
    assert_eq!(with(2, KernelChoice::Auto), one);
    assert_eq!(with(1, KernelChoice::Avx2), one);
    assert_eq!(with(1, KernelChoice::Scalar), one);
}

#[test]
fn units_change_nothing() {
    // all stresses and the agitation pressure scaled together: the same groups
    let small = scene(&json!({ "p": 1e5, "sigma_e": 1e10, "sigma_c": 3e6, "max_steps": 2000 }));
    let large = scene(&json!({
        "p": 2e5, "sigma_e": 2e10, "sigma_c": 6e6, "agitation": std::f64::consts::SQRT_2, "max_steps": 2000
    }));
    assert_eq!(small.key(), large.key());
    let options = Options::default();
    assert_eq!(
        serde_json::to_string(&run(&small, &options).unwrap()).unwrap(),
        serde_json::to_string(&run(&large, &options).unwrap()).unwrap()
    );
}

#[test]
fn damaged_and_foreign_checkpoints_are_refused() {
    let options = Options::default();
    let (mine, other) = (scene(&json!({})), scene(&json!({ "seed": 2 })));
    let mut simulation = compile(&mine, &options).unwrap();
    simulation.advance(100).unwrap();
    let saved = simulation.save();
    assert!(matches!(restore(&other, &options, &saved), Err(SimError::Checkpoint(_))));
    for at in [0, 40, saved.len() / 2, saved.len() - 1] {
        let mut damaged = saved.clone();
        damaged[at] ^= 1;
        assert!(matches!(restore(&mine, &options, &damaged), Err(SimError::Checkpoint(_))), "byte {at}");
    }
    assert!(matches!(restore(&mine, &options, &saved[..10]), Err(SimError::Checkpoint(_))));
}
