//! Every kind of bad sweep gets its problems, all at once, each with field path, value and remedy; nothing large is
//! ever allocated for a bad one.

use scene::{Problem, Problems, Sweep};
use serde_json::{Value, json};

fn problems(definition: &Value) -> Vec<Problem> {
    let Err(Problems(found)) = Sweep::from_json(definition) else { panic!("{definition} is accepted") };
    for problem in &found {
        assert!(!problem.problem.is_empty() && !problem.remedy.is_empty(), "{problem:?}");
        assert!(!problem.problem.ends_with('.') && !problem.remedy.ends_with('.'), "{problem:?}");
    }
    found
}

fn with_blocks(blocks: Value) -> Value {
    json!({
        "name": "bad", "model": "cohesive_spheres", "blocks": blocks,
        "base": {"p": 1e5, "sigma_c": 3e6, "sigma_e": 1e10}
    })
}

/// The one problem of a sweep with these blocks.
fn problem_of(blocks: Value) -> Problem {
    let mut found = problems(&with_blocks(blocks));
    assert_eq!(found.len(), 1, "{found:?}");
    found.remove(0)
}

#[test]
fn all_problems_come_at_once_with_their_paths() {
    let definition = json!({
        "nmae": "typo", "model": "cohesive_spheres", "priority": 1.5, "replicates": 0,
        "base": {"p": -1, "sigmae": 1e10, "n": "many"},
        "blocks": [
            {"grid": {"sigma_c": {"log": [0, 4e8, 11]}, "mu": []}},
            {"zip": {"alpha_n": [0.1, 0.2], "seed": [1, 2, 3]}, "lsit": []},
            {"list": [{"ei": 1.4}, {"ei": "high"}, 7]},
            {"grid": {"sigma_c": {"log": [1, 2]}, "mw": {"logs": [1, 2, 3]}, "ei": 1.4}}
        ],
        "where": [{"quantity": "etastar", "max": 1}, {"quantity": "eta"}, {"quantity": "p", "min": 2, "max": 1}]
    });
    let mut found: Vec<String> = problems(&definition).into_iter().map(|problem| problem.field).collect();
    found.sort();
    let mut expected = [
        "nmae",
        "name",
        "priority",
        "replicates",
        "base.p",
        "base.sigmae",
        "base.n",
        "blocks[0].grid.sigma_c.log[0]",
        "blocks[0].grid.mu",
        "blocks[1].zip",
        "blocks[1].lsit",
        "blocks[2].list[1].ei",
        "blocks[2].list[2]",
        "blocks[3].grid.sigma_c.log",
        "blocks[3].grid.mw.logs",
        "blocks[3].grid.ei",
        "where[0].quantity",
        "where[1]",
        "where[2]",
    ];
    expected.sort_unstable();
    assert_eq!(found, expected);
}

#[test]
fn suggestions() {
    let definition = json!({"name": "x", "model": "cohesive_spheres", "bsae": {}, "base": {"p": 1, "sigma_c": 1,
        "sigma_e": 1e5, "fricton": 1}, "where": [{"quantity": "eta_str", "max": 1}]});
    let remedies: Vec<String> = problems(&definition).into_iter().map(|problem| problem.remedy).collect();
    assert!(remedies.iter().any(|remedy| remedy.contains("did you mean \"base\"")), "{remedies:?}");
    assert!(remedies.iter().any(|remedy| remedy.contains("did you mean \"eta_star\"")), "{remedies:?}");
}

#[test]
fn empty_things() {
    assert_eq!(problem_of(json!([])).field, "blocks");
    assert_eq!(problem_of(json!([{}])).field, "blocks[0]");
    assert_eq!(problem_of(json!([{"grid": {}}])).field, "blocks[0].grid");
    assert_eq!(problem_of(json!([{"zip": {}}])).field, "blocks[0].zip");
    assert_eq!(problem_of(json!([{"list": []}])).field, "blocks[0].list");
    assert_eq!(problem_of(json!([{"grid": {"p": []}}])).field, "blocks[0].grid.p");
    assert_eq!(problem_of(json!([{"grid": {"p": {"values": []}}}])).field, "blocks[0].grid.p.values");
    assert_eq!(problem_of(json!([{"grid": {"p": {}}}])).field, "blocks[0].grid.p");
}

#[test]
fn overlapping_names() {
    let both = problem_of(json!([{"grid": {"p": [1e5]}, "zip": {"p": [1e5], "mu": [0.1]}}]));
    assert_eq!(both.field, "blocks[0].zip.p");
    assert!(both.problem.contains("`grid`"));
    let listed = problem_of(json!([{"grid": {"p": [1e5]}, "list": [{"mu": 0.3}, {"p": 1e5}]}]));
    assert_eq!(listed.field, "blocks[0].list[1].p");
    let text =
        r#"{"name": "x", "model": "cohesive_spheres", "blocks": [{"grid": {"p": [1e5], "p": [1e4]}}]}"#;
    assert_eq!(Sweep::from_text(text).unwrap_err().0[0].field, "blocks[0].grid.p");
}

#[test]
fn bad_ranges() {
    for (range, field) in [
        (json!({"log": [1e4, 1e5]}), "p.log"),
        (json!({"log": [1e4, 1e5, 3, 4]}), "p.log"),
        (json!({"log": 3}), "p.log"),
        (json!({"log": [-1, 1e5, 3]}), "p.log[0]"),
        (json!({"log": [1e4, 0, 3]}), "p.log[1]"),
        (json!({"log": [1e4, "NaN", 3]}), "p.log[1]"),
        (json!({"lin": [1e4, 1e5, 1]}), "p.lin[2]"),
        (json!({"lin": [1e4, 1e5, 2.5]}), "p.lin[2]"),
        (json!({"lin": [1e4, 1e4, 5]}), "p.lin"),
        (json!({"lin": [1e5, -1e5, 5]}), "p.lin"),
        (json!({"lin": [1e4, 1e5, 2], "log": [1e4, 1e5, 2]}), "p"),
        (json!(1e5), "p"),
        (json!([1e5, -1e5]), "p[1]"),
        (json!({"values": [1e5, null]}), "p.values[1]"),
    ] {
        assert_eq!(
            problem_of(json!([{"grid": {"p": range}}])).field,
            format!("blocks[0].grid.{field}"),
            "{range}"
        );
    }
    assert_eq!(problem_of(json!([{"grid": {"n": {"log": [10, 1000, 4]}}}])).problem, "is not a whole number");
    assert!(Sweep::from_json(&with_blocks(json!([{"grid": {"n": {"log": [10, 1000, 3]}}}]))).is_ok());
    assert_eq!(
        problem_of(json!([{"grid": {"damping_mass": {"lin": [1, 2, 3]}}}])).field,
        "blocks[0].grid.damping_mass.lin"
    );
}

#[test]
fn large_sweeps_are_refused_from_the_counts() {
    let thousand = json!({"log": [1e3, 1e6, 1000]});
    let refused = problem_of(json!([{"grid": {"p": thousand, "sigma_c": thousand, "mw": thousand}}]));
    assert_eq!((refused.field.as_str(), refused.value.as_str()), ("blocks", "1000000000 points"));
    let million = json!({"log": [1e3, 1e6, 1_000_000]});
    let overflow = problem_of(json!([{"grid": {
        "p": million, "sigma_c": million, "mw": million, "sigma_e": million, "ei": {"lin": [1, 2, 1_000_000]}
    }}]));
    assert!(overflow.value.starts_with("more than"));
    assert_eq!(
        problem_of(json!([{"grid": {"p": {"log": [1e3, 1e6, 1_000_000_000]}}}])).field,
        "blocks[0].grid.p.log[2]"
    );
    let mut replicated = with_blocks(json!([{"grid": {"p": {"log": [1e3, 1e6, 1000]}}}]));
    replicated["replicates"] = json!(1001);
    assert_eq!(problems(&replicated)[0].value, "1001000 points");
}

#[test]
fn required_keys_have_to_come_from_somewhere() {
    let definition = json!({
        "name": "x", "model": "cohesive_spheres", "base": {"p": 1e5},
        "blocks": [
            {"grid": {"sigma_c": [1e6], "sigma_e": [1e10]}},
            {"grid": {"sigma_c": [1e6]}},
            {"list": [{"sigma_c": 1e6, "sigma_e": 1e10}, {"sigma_c": 1e6}]}
        ]
    });
    let found: Vec<String> = problems(&definition).into_iter().map(|problem| problem.field).collect();
    assert_eq!(found, ["blocks[1].sigma_e", "blocks[2].list[1].sigma_e"]);
}

#[test]
fn seeds_beyond_the_largest_whole_number_are_problems() {
    let mut definition = with_blocks(json!([{"list": [{"seed": 9_007_199_254_740_991_u64}]}]));
    definition["replicates"] = json!(2);
    let broken = Sweep::from_json(&definition).unwrap().survey().unwrap_err();
    assert_eq!(broken.0[0].field, "points[1].seed");
}
