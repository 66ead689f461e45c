//! One run has one key, however it is written.

use proptest::prelude::*;
use scene::{Reduced, Scene};
use serde_json::{Map, Value, json};

fn spheres(p: f64, sigma_c: f64, sigma_e: f64) -> Value {
    json!({"model": "cohesive_spheres", "n": 500, "p": p, "sigma_c": sigma_c, "sigma_e": sigma_e, "agitation": 0})
}

#[test]
fn defaults_written_out_are_the_same_run() {
    let short = Scene::from_json(&spheres(1e5, 3e6, 1e10)).unwrap();
    let long = Scene::from_json(&short.to_json()).unwrap();
    assert_eq!(short, long);
    assert_eq!(short.key(), long.key());
}

#[test]
fn representations_of_one_number_are_one_run() {
    let integer: Value = serde_json::from_str(
        r#"{"model":"cohesive_spheres","n":500,"p":100000,"sigma_c":3000000,"sigma_e":10000000000,"agitation":-0.0}"#,
    )
    .unwrap();
    let real: Value = serde_json::from_str(
        r#"{"agitation":0,"sigma_e":1e10,"sigma_c":3e6,"p":1e5,"n":5e2,"model":"cohesive_spheres","stop":"evidence"}"#,
    )
    .unwrap();
    assert_eq!(Scene::from_json(&integer).unwrap().key(), Scene::from_json(&real).unwrap().key());
}

#[test]
fn what_changes_the_run_changes_the_key() {
    let base = spheres(1e5, 3e6, 1e10);
    let key = Scene::from_json(&base).unwrap().key();
    for (name, value) in [
        ("n", json!(501)),
        ("seed", json!(2)),
        ("p", json!(2e5)),
        ("alpha_n", json!(0.1)),
        ("mu_wall", json!(0.0)),
        ("scale_wall_mass", json!(false)),
        ("agitation", json!(1)),
        ("dt", json!(0.05)),
        ("stop", json!("settled")),
        ("approach", json!("rolling_kicks")),
    ] {
        let mut changed = base.clone();
        changed[name] = value;
        assert_ne!(Scene::from_json(&changed).unwrap().key(), key, "{name}");
    }
}

#[test]
fn a_reduced_scene_survives_the_wire() {
    let reduced = Scene::from_json(&spheres(1e5, 3e6, 1e10)).unwrap().reduce();
    let text = serde_json::to_string(&reduced.to_json()).unwrap();
    let read = Reduced::from_json(&serde_json::from_str(&text).unwrap()).unwrap();
    assert_eq!(read, reduced);
    assert_eq!(read.key(), reduced.key());
    let mut foreign = reduced.to_json();
    foreign["colour"] = json!("red");
    assert!(Reduced::from_json(&foreign).unwrap_err().0[0].problem.contains("colour"));
}

/// The same object with its fields in another order.
fn rotated(object: &Value, by: usize) -> String {
    let mut fields: Vec<(String, Value)> =
        object.as_object().expect("an object").clone().into_iter().collect();
    let places = by % fields.len();
    fields.rotate_left(places);
    let inside: Vec<String> = fields.iter().map(|(name, value)| format!("{name:?}:{value}")).collect();
    format!("{{{}}}", inside.join(","))
}

proptest! {
    #[test]
    fn the_key_ignores_units_and_field_order(
        adhesion in 1e-8..0.9_f64, pressure in 1e-9..0.1_f64, stress in 1e3..1e12_f64, by in 0_usize..9,
        decade in -3_i32..4,
    ) {
        // With agitation 0 the groups are all there is: the scale of stress is a label.
        let one = spheres(pressure * stress, adhesion * stress, stress);
        let scale = 10_f64.powi(decade);
        let other = spheres(pressure * (stress * scale), adhesion * (stress * scale), stress * scale);
        let key = Scene::from_json(&one).unwrap().reduce();
        let rounded = Scene::from_json(&other).unwrap().reduce();
        // Groups on a rounding boundary may fall to either side: two ways differ by one unit of the 12th digit.
        let (Reduced::CohesiveSpheres(left), Reduced::CohesiveSpheres(right)) = (&key, &rounded) else {
            panic!("spheres");
        };
        prop_assert!((left.pressure - right.pressure).abs() <= 1.1e-11 * left.pressure);
        if left.pressure == right.pressure && left.adhesion == right.adhesion {
            prop_assert_eq!(key.key(), rounded.key());
        }
        prop_assert_eq!(Scene::from_text(&rotated(&one, by)).unwrap().key(), key.key());
    }

    #[test]
    fn short_decimal_numbers_meet_in_any_unit(
        p in 1_u32..1000, sigma_c in 1_u32..1000, decade in -6_i32..7,
    ) {
        let unit: f64 = format!("1e{decade}").parse().unwrap();
        let one = spheres(f64::from(p) * 1e3, f64::from(sigma_c) * 1e3, 1e10);
        let other = spheres(f64::from(p) * 1e3 * unit, f64::from(sigma_c) * 1e3 * unit, 1e10 * unit);
        prop_assert_eq!(Scene::from_json(&one).unwrap().key(), Scene::from_json(&other).unwrap().key());
    }

    #[test]
    fn scenes_survive_json(
        p in 1e3..1e6_f64, sigma_c in 0.0..1e9_f64, n in 1_u64..10_000_000, seed in 0_u64..9_007_199_254_740_991,
        alpha_n in 0.0..1.0_f64, dt in prop::option::of(1e-3..0.5_f64), walls in prop::bool::ANY,
    ) {
        let mut scene = spheres(p, sigma_c, 1e10);
        scene["n"] = json!(n);
        scene["seed"] = json!(seed);
        scene["alpha_n"] = json!(alpha_n);
        scene["moving_walls"] = json!(if walls { 3 } else { 6 });
        if let Some(dt) = dt {
            scene["dt"] = json!(dt);
        }
        let read = Scene::from_json(&scene).unwrap();
        prop_assert_eq!(&Scene::from_text(&read.to_json().to_string()).unwrap(), &read);
        let reduced = read.reduce();
        prop_assert_eq!(&Reduced::from_json(&reduced.to_json()).unwrap(), &reduced);
    }

    #[test]
    fn any_json_gives_a_scene_or_problems(noise in "\\PC{0,40}", number in prop::num::f64::ANY) {
        let mut object = Map::new();
        object.insert("model".to_owned(), json!("cohesive_spheres"));
        for key in scene::Model::CohesiveSpheres.keys() {
            object.insert(key.name.to_owned(), json!(number));
        }
        object.insert(noise.clone(), json!(noise));
        let _ = Scene::from_json(&Value::Object(object));
        let _ = Scene::from_text(&noise);
    }
}
