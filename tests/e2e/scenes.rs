//! Small sweeps.

use serde_json::{Value, json};

/// Spheres of the test scenes: small enough for a run in a blink.
const N: u64 = 40;

/// Steps of a run that is long enough to be stopped in the middle: some seconds, ten times the wait for its first
/// checkpoint, on a fast machine too.
pub const LONG: u64 = 2_000_000;

/// A sweep over cohesion; each run takes some hundredths of a second.
pub fn quick(name: &str, sigma_c: &[f64]) -> Value {
    json!({
        "name": name,
        "model": "cohesive_spheres",
        "base": { "n": N, "p": 1e5, "sigma_e": 1e9, "stop": "steps", "max_steps": 2000 },
        "blocks": [ { "grid": { "sigma_c": sigma_c } } ]
    })
}

/// One scene that takes `steps` steps.
pub fn scene_of(steps: u64) -> Value {
    json!({
        "model": "cohesive_spheres", "n": N, "p": 1e5, "sigma_e": 1e9, "sigma_c": 1e6,
        "stop": "steps", "max_steps": steps
    })
}

/// A sweep of the one scene [`scene_of`].
pub fn sweep_of_one(name: &str, steps: u64) -> Value {
    let Value::Object(mut base) = scene_of(steps) else { unreachable!("written as an object") };
    let model = base.remove("model");
    json!({ "name": name, "model": model, "base": base, "blocks": [ { "list": [ {} ] } ] })
}
