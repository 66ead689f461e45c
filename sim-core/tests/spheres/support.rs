//! Scenes and runs for the tests.

use record::Outcome;
use scene::{Reduced, Scene};
use serde_json::{Value, json};
use sim_core::{Options, SimError, Simulation, compile};

/// A scene from the keys that differ from a small, quickly settling default.
pub fn scene(keys: &Value) -> Reduced {
    let mut all = json!({
        "model": "cohesive_spheres", "n": 200, "seed": 1,
        "p": 1e6, "sigma_e": 1e9, "sigma_c": 3e6,
        "stop": { "rule": "settled", "e_drift": 5e-4, "wall_imbalance": 0.02 },
    });
    for (key, value) in keys.as_object().expect("keys are an object") {
        all[key] = value.clone();
    }
    Scene::from_json(&all).expect("a valid scene").reduce()
}

/// Runs to the end.
pub fn run(scene: &Reduced, options: &Options) -> Result<Outcome, SimError> {
    let mut simulation = compile(scene, options)?;
    while !simulation.advance(5000)?.finished {}
    simulation.outcome()
}

/// Everything a run can tell, as text: equal text is equal bits.
pub fn fingerprint(simulation: &dyn Simulation) -> String {
    serde_json::to_string(&simulation.outcome().expect("an outcome")).expect("plain data")
}
