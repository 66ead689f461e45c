//! Every kind of bad scene gets its problems, all at once, each with field, value and remedy.

use scene::{Problem, Problems, Scene};
use serde_json::{Value, json};

fn problems(scene: &Value) -> Vec<Problem> {
    let Err(Problems(found)) = Scene::from_json(scene) else { panic!("{scene} is accepted") };
    for problem in &found {
        assert!(!problem.problem.is_empty() && !problem.remedy.is_empty(), "{problem:?}");
        assert!(!problem.problem.ends_with('.') && !problem.remedy.ends_with('.'), "{problem:?}");
    }
    found
}

fn fields(scene: &Value) -> Vec<String> {
    problems(scene).into_iter().map(|problem| problem.field).collect()
}

/// The one problem of a good scene with one key changed.
fn problem_with(key: &str, value: Value) -> Problem {
    let mut scene = json!({"model": "cohesive_spheres", "p": 1e5, "sigma_c": 3e6, "sigma_e": 1e10});
    scene[key] = value;
    let mut found = problems(&scene);
    assert_eq!(found.len(), 1, "{found:?}");
    found.remove(0)
}

#[test]
fn all_problems_come_at_once() {
    let scene = json!({
        "model": "cohesive_spheres", "n": "many", "p": -1, "sigma_e": "NaN", "mw": -96, "sigmac": 3e6,
        "stop": {"rule": "settled", "e_drft": 1e-3, "wall_imbalance": 0},
        "damping_mass": "efective", "clamp_viscous": "yes"
    });
    let mut found = fields(&scene);
    found.sort();
    let expected = [
        "clamp_viscous",
        "damping_mass",
        "mw",
        "n",
        "p",
        "sigma_c",
        "sigma_e",
        "sigmac",
        "stop.e_drft",
        "stop.wall_imbalance",
    ];
    assert_eq!(found, expected);
}

#[test]
fn unknown_keys_get_the_nearest_name() {
    assert!(problem_with("sigmac", json!(1)).remedy.contains("did you mean \"sigma_c\""));
    assert!(problem_with("colour", json!(1)).remedy.starts_with("known: "));
    assert!(problem_with("stop", json!("setled")).remedy.contains("did you mean \"settled\""));
    assert!(problem_with("damping_mass", json!("efective")).problem.contains("did you mean \"effective\""));
}

#[test]
fn numbers_that_are_none() {
    for text in ["NaN", "nan", "inf", "-Infinity"] {
        assert_eq!(problem_with("p", json!(text)).problem, "is not a finite number");
    }
    let quoted = problem_with("p", json!("1e5"));
    assert!(quoted.remedy.ends_with("without quotes"), "{quoted:?}");
    assert_eq!(problem_with("p", Value::Null).problem, "is null, not a number");
    assert_eq!(problem_with("p", json!([1e5])).value, "[100000.0]");
    let Err(Problems(huge)) = Scene::from_text(r#"{"model": "cohesive_spheres", "p": 1e999}"#) else {
        panic!()
    };
    assert_eq!(huge[0].field, "p");
    let Err(Problems(twice)) = Scene::from_text(r#"{"p": 1, "p": 2}"#) else { panic!() };
    assert!(twice[0].problem.contains("twice"));
}

#[test]
fn domains_are_kept() {
    for (key, value) in [
        ("n", json!(0)),
        ("n", json!(-5)),
        ("n", json!(1e300)),
        ("seed", json!(9_007_199_254_740_992_u64)),
        ("p", json!(0)),
        ("sigma_c", json!(-1e-300)),
        ("alpha_n", json!(1.01)),
        ("mu", json!(-0.1)),
        ("mw", json!(-96)),
        ("moving_walls", json!(4)),
        ("dt", json!(0)),
        ("max_steps", json!(0)),
    ] {
        assert_eq!(problem_with(key, value).field, key);
    }
    assert_eq!(problem_with("n", json!(1000.5)).problem, "is not a whole number");
    assert!(problem_with("mw", json!(-96)).remedy.contains("number in [0.001"));
}

#[test]
fn combinations_no_run_can_make_sense_of() {
    assert!(problem_with("p", json!(1e300)).problem.starts_with("p/sigma_e"));
    assert!(problem_with("sigma_c", json!(2e10)).problem.contains("is not below 1"));
    assert_eq!(
        fields(&json!({"model": "cohesive_spheres", "p": 1e300, "sigma_c": 1e300, "sigma_e": 1e-300})).len(),
        2
    );
}

#[test]
fn the_model_is_named() {
    assert_eq!(fields(&json!({"p": 1})), ["model"]);
    assert_eq!(fields(&json!(3)), [""]);
    assert_eq!(fields(&json!({"model": 3})), ["model"]);
    let near = problems(&json!({"model": "cohesive_sphere"})).remove(0);
    assert!(near.remedy.contains("did you mean \"cohesive_spheres\""), "{near:?}");
}

#[test]
fn variants_of_plastic_discs_that_do_not_go_together_are_refused() {
    let one = |scene: Value| {
        let mut found = problems(&scene);
        assert_eq!(found.len(), 1, "{found:?}");
        found.remove(0)
    };
    let explicit = one(json!({"model": "plastic_discs", "method": "explicit", "variant": "updated_cubic"}));
    assert_eq!((explicit.field.as_str(), explicit.value.as_str()), ("variant", "\"updated_cubic\""));
    assert!(explicit.remedy.contains("total_bilinear"));
    let mesh = one(json!({"model": "plastic_discs", "contact": "common_mesh", "variant": "total_cubic"}));
    assert_eq!(mesh.field, "contact");
    let points = one(json!({"model": "plastic_discs", "points_across": 3}));
    assert_eq!(points.field, "points_across");
    assert!(mesh.remedy.contains("updated_cubic"));
    let word = one(json!({"model": "plastic_discs", "variant": "updated_bilinear"}));
    assert!(word.field == "variant" && word.remedy.contains("updated_cubic"), "{word:?}");
}
