//! Keys of known scenes: a change here makes every stored result unfindable, so it belongs to a raised physics version
//! and to *Numbers* in the changelog.

use scene::Scene;
use serde_json::json;

#[test]
fn keys_do_not_change_by_accident() {
    let spheres =
        json!({"model": "cohesive_spheres", "n": 2207, "p": 1e5, "sigma_e": 1e10, "sigma_c": 3e6, "seed": 1});
    assert_eq!(Scene::from_json(&spheres).unwrap().key().as_str(), "1c19712310bf3ca2336f1f7dfb13cdec");
}
