//! Expansion: counts, order, rounding, filters, duplicates, presets.

use proptest::prelude::*;
use scene::sweep::{Candidate, Point};
use scene::{PRESETS, Scene, Sweep, preset};
use serde_json::{Map, Value, json};

fn sweep(definition: &Value) -> Sweep {
    Sweep::from_json(definition).unwrap_or_else(|problems| panic!("{definition}: {problems}"))
}

fn mini(blocks: Value) -> Value {
    json!({
        "name": "test", "model": "cohesive_spheres", "blocks": blocks,
        "base": {"n": 100, "p": 1e5, "sigma_c": 3e6, "sigma_e": 1e10}
    })
}

fn column(points: &[Point], key: &str) -> Vec<f64> {
    points.iter().map(|point| point.scene.quantity(key).expect("a number")).collect()
}

#[test]
fn the_definition_of_the_design_expands() {
    let definition = json!({
        "name": "cohesive-mini", "model": "cohesive_spheres",
        "base": {"n": 1000, "mu": 0.4, "alpha_n": 0.25, "mw": 96, "ei": 1.704, "p": 1.0e5, "sigma_e": 1.0e10,
                 "sigma_c": 3.0e6},
        "blocks": [
            {"grid": {"sigma_c": {"log": [2e3, 4e8, 11]}, "p": [1e4, 1e5, 1e6], "sigma_e": [1e9, 1e10]}},
            {"zip": {"alpha_n": [0.05, 0.1], "seed": [1, 2]}},
            {"list": [{"ei": 1.4}, {"ei": 2.2}]}
        ],
        "replicates": 2,
        "where": [{"quantity": "sigma_c_over_sigma_e", "max": 0.05}],
        "priority": 0
    });
    let survey = sweep(&definition).survey().unwrap();
    assert_eq!(survey.candidates, 2 * (11 * 3 * 2 + 2 + 2));
    // σc of 1.18e8 and 4e8 at σe = 1e9; at 1e10 the largest ratio is 0.04: two values, three pressures, two seeds.
    assert_eq!(survey.left_out[0].points, 2 * 3 * 2);
    assert_eq!(survey.points, survey.candidates - 12);
    assert_eq!((survey.duplicates, survey.out_of_model), (0, 0));
}

#[test]
fn the_order_is_blocks_then_names_then_replicates() {
    let mut definition =
        mini(json!([{"grid": {"p": [1e4, 1e5], "mu": [0.1, 0.2, 0.3]}}, {"list": [{"mu": 0.9}]}]));
    definition["replicates"] = json!(2);
    let points: Vec<Point> = sweep(&definition).points().collect();
    let of = |key| column(&points, key);
    assert_eq!(of("mu")[..6], [0.1, 0.1, 0.1, 0.1, 0.2, 0.2]);
    assert_eq!(of("p")[..6], [1e4, 1e4, 1e5, 1e5, 1e4, 1e4]);
    assert_eq!(of("seed")[..6], [1.0, 2.0, 1.0, 2.0, 1.0, 2.0]);
    assert_eq!(of("mu")[12..], [0.9, 0.9]);
    assert!(points.iter().enumerate().all(|(place, point)| point.index == place as u64));
}

#[test]
fn replicates_count_on_from_seeds_of_a_range() {
    let mut definition = mini(json!([{"grid": {"seed": {"lin": [10, 30, 3]}}}]));
    definition["replicates"] = json!(2);
    let points: Vec<Point> = sweep(&definition).points().collect();
    assert_eq!(column(&points, "seed"), [10.0, 11.0, 20.0, 21.0, 30.0, 31.0]);
}

#[test]
fn parts_of_one_block_multiply() {
    let definition = mini(json!([{
        "grid": {"p": [1e4, 1e5]}, "zip": {"mu": [0.1, 0.2], "ei": [1.4, 1.5]}, "list": [{"mw": 24}, {"mw": 96}, {}]
    }]));
    let points: Vec<Point> = sweep(&definition).points().collect();
    assert_eq!(points.len(), 2 * 2 * 3);
    assert_eq!(column(&points, "mw")[..4], [24.0, 96.0, 96.0, 24.0]);
    assert_eq!(column(&points, "mu")[..4], [0.1, 0.1, 0.1, 0.2]);
    assert_eq!(column(&points, "ei")[..4], [1.4, 1.4, 1.4, 1.5]);
}

#[test]
fn a_base_alone_is_one_point_and_derived_defaults_follow_the_axes() {
    let alone = json!({"name": "one", "model": "cohesive_spheres", "base": {"p": 1e5, "sigma_c": 1e6, "sigma_e": 1e10}});
    assert_eq!(sweep(&alone).points().count(), 1);
    let points: Vec<Point> = sweep(&mini(json!([{"grid": {"mu": [0.1, 0.7]}}]))).points().collect();
    assert_eq!(column(&points, "mu_wall"), [0.1, 0.7]);
}

#[test]
fn equal_scenes_are_counted_as_duplicates() {
    // With agitation 0 only the ratios of stresses matter.
    let definition = mini(json!([
        {"list": [
            {"agitation": 0, "p": 1e4, "sigma_c": 3e5, "sigma_e": 1e9},
            {"agitation": 0, "p": 1e5, "sigma_c": 3e6, "sigma_e": 1e10},
            {"agitation": 0, "p": 1e5, "sigma_c": 3e6, "sigma_e": 1e10, "seed": 2}
        ]},
        {"grid": {"agitation": [0], "sigma_c": {"log": [3e4, 3e8, 5]}}}
    ]));
    let survey = sweep(&definition).survey().unwrap();
    assert_eq!((survey.points, survey.duplicates, survey.distinct), (8, 2, 6));
    let known = sweep(&definition).survey_with(|_| true).unwrap();
    assert_eq!(known.core_seconds, 0.0);
}

#[test]
fn soft_points_run_and_are_marked_and_broken_ones_are_problems() {
    let points: Vec<Point> =
        sweep(&mini(json!([{"list": [{"sigma_c": 8e9}, {"sigma_c": 5e8}]}]))).points().collect();
    assert!(points[0].out_of_model.as_deref().is_some_and(|reason| reason.contains("0.8")));
    // Exactly 5 % is inside.
    assert!(points[1].out_of_model.is_none());
    let mut broken = mini(json!([{"grid": {"sigma_c": [1e6, 2e10, 3e10]}}]));
    let problems = sweep(&broken).survey().unwrap_err();
    assert_eq!(
        problems.0.iter().map(|one| one.field.as_str()).collect::<Vec<_>>(),
        ["points[1].sigma_c", "points[2].sigma_c"]
    );
    // `where` can leave them out.
    broken["where"] = json!([{"quantity": "sigma_c_over_sigma_e", "max": 0.05}]);
    assert_eq!(sweep(&broken).survey().unwrap().points, 1);
    broken["where"] = json!([{"quantity": "p", "min": 1e9}]);
    assert_eq!(sweep(&broken).survey().unwrap_err().0[0].field, "where");
}

#[test]
fn filters_take_their_ends_in() {
    let mut definition = mini(json!([{"grid": {"sigma_c": [1e6, 3e6, 1e7]}}]));
    // η = 10, 30, 100.
    definition["where"] = json!([{"quantity": "eta", "min": 30, "max": 100}]);
    let found = sweep(&definition);
    assert_eq!(column(&found.points().collect::<Vec<_>>(), "sigma_c"), [3e6, 1e7]);
    assert!(matches!(found.candidate(0), Candidate::LeftOut { filter: 0, .. }));
}

#[test]
fn the_study_has_the_runs_of_the_paper() {
    let study = preset("cohesive-study", &Map::new()).unwrap();
    let sizes: Vec<u64> = study.blocks.iter().map(scene::sweep::Block::size).collect();
    assert_eq!(sizes, [220, 55, 8, 8]);
    let survey = study.survey().unwrap();
    assert_eq!((survey.points, survey.distinct), (291, 291));
    assert!(study.points().all(|point| point.scene.quantity("n") == Some(17_657.0)));
    // σc/σe above 0.05: at σe = 5e8 (from 3.5e7 on: 3 values), 2.2e9 (2), 1e10 (none below 4e8: 0.04), …
    let soft = study.points().filter(|point| point.out_of_model.is_some()).count();
    assert_eq!(survey.out_of_model, soft as u64);
    let softest = study.points().filter_map(|point| point.scene.quantity("sigma_c_over_sigma_e"));
    assert_eq!(softest.fold(0.0, f64::max), 0.8);
}

#[test]
fn presets_take_overrides() {
    let overrides = json!({"n": 1000, "stop": "settled", "replicates": 3, "name": "small"});
    let study = preset("cohesive-study", overrides.as_object().unwrap()).unwrap();
    assert_eq!((study.size(), study.name.as_str()), (291 * 3, "small"));
    assert!(study.points().all(|point| point.scene.quantity("n") == Some(1000.0)));
    let swept = preset("cohesive-study", json!({"p": 1e5}).as_object().unwrap()).unwrap_err();
    assert!(swept.0[0].problem.contains("sweeps"));
    let unknown = preset("cohesive-studie", &Map::new()).unwrap_err();
    assert!(unknown.0[0].remedy.contains("cohesive-study"));
}

#[test]
fn every_preset_expands_and_survives_json() {
    for one in PRESETS {
        let found = preset(one.name, &Map::new()).unwrap();
        assert_eq!(found.name, one.name);
        assert!(found.survey().unwrap().points >= 20, "{}", one.name);
        assert_eq!(sweep(&found.to_json()), found);
    }
}

fn axis_strategy(key: &'static str, low: f64, high: f64) -> impl Strategy<Value = (String, Value)> {
    let number = low..high;
    prop_oneof![
        prop::collection::vec(number.clone(), 1..5).prop_map(|values| json!(values)),
        prop::collection::vec(number, 1..5).prop_map(|values| json!({ "values": values })),
        (2_u64..6).prop_map(move |count| json!({ "log": [low, high, count] })),
        (2_u64..6).prop_map(move |count| json!({ "lin": [high, low, count] })),
    ]
    .prop_map(move |values| (key.to_owned(), values))
}

fn length(values: &Value) -> u64 {
    let list = |value: &Value| value.as_array().map_or(0, |list| list.len() as u64);
    match values {
        Value::Array(list) => list.len() as u64,
        range if range["values"].is_array() => list(&range["values"]),
        range => range["log"].as_array().or(range["lin"].as_array()).expect("a range")[2]
            .as_u64()
            .expect("a count"),
    }
}

proptest! {
    #[test]
    fn counts_are_products_and_sums(
        p in axis_strategy("p", 1e3, 1e6),
        sigma_c in axis_strategy("sigma_c", 1e3, 1e8),
        mu in axis_strategy("mu", 0.1, 1.0),
        zipped in prop::collection::vec((0.0..1.0_f64, 1_u64..100), 1..5),
        replicates in 1_u64..4,
    ) {
        let grid: Map<String, Value> = [p.clone(), sigma_c.clone()].into_iter().collect();
        let other: Map<String, Value> = [mu.clone()].into_iter().collect();
        let (alphas, seeds): (Vec<f64>, Vec<u64>) = zipped.iter().copied().unzip();
        let mut definition =
            mini(json!([{"grid": grid}, {"grid": other, "zip": {"alpha_n": alphas, "seed": seeds}}]));
        definition["replicates"] = json!(replicates);
        let found = sweep(&definition);
        let expected = replicates * (length(&p.1) * length(&sigma_c.1) + length(&mu.1) * zipped.len() as u64);
        prop_assert_eq!(found.size(), expected);
        let points: Vec<Point> = found.points().collect();
        prop_assert_eq!(points.len() as u64, expected);
        let survey = found.survey().unwrap();
        prop_assert_eq!(survey.points, survey.duplicates + survey.distinct);
        // Random access and walking agree; a round trip through JSON changes no scene.
        let again = sweep(&found.to_json());
        prop_assert_eq!(&again, &found);
        for place in [0, expected / 2, expected - 1] {
            let Candidate::Runs(point) = again.candidate(place) else { panic!("runs") };
            prop_assert_eq!(&point, &points[usize::try_from(place).unwrap()]);
            prop_assert_eq!(&Scene::from_json(&point.scene.to_json()).unwrap(), &point.scene);
        }
    }
}
