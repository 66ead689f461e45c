//! The key tables agree with the structs, the defaults with their domains, `docs/keys.md` with the tables.

use std::path::Path;

use scene::table::{Absent, Domain, Key, document};
use scene::{Model, Scene};
use serde_json::{Value, json};

/// A scene of each model with nothing but its required keys.
fn smallest_scenes() -> Vec<Value> {
    vec![
        json!({"model": "cohesive_spheres", "p": 1e5, "sigma_c": 3e6, "sigma_e": 1e10}),
        json!({"model": "cohesive_discs"}),
        json!({"model": "plastic_discs"}),
    ]
}

#[test]
fn tables_and_structs_have_the_same_keys() {
    for smallest in smallest_scenes() {
        let scene = Scene::from_json(&smallest).unwrap();
        let written = scene.to_json();
        let mut fields: Vec<&str> = written.as_object().unwrap().keys().map(String::as_str).collect();
        fields.retain(|name| *name != "model");
        fields.sort_unstable();
        let mut keys: Vec<&str> = scene.model().keys().iter().map(|key| key.name).collect();
        keys.sort_unstable();
        assert_eq!(fields, keys);
        assert_eq!(Scene::from_json(&written).unwrap(), scene);
    }
}

#[test]
fn every_model_in_this_build_has_a_smallest_scene_here() {
    let tested: Vec<Value> = smallest_scenes().iter().map(|scene| scene["model"].clone()).collect();
    for model in Model::ALL.into_iter().filter(|model| !model.keys().is_empty()) {
        assert!(tested.contains(&Value::from(model.name())), "{} is missing", model.name());
    }
}

#[test]
fn tagged_records_with_every_default_are_scenes() {
    for smallest in smallest_scenes() {
        let model = Model::named(smallest["model"].as_str().unwrap()).unwrap();
        for key in model.keys() {
            for word in words_of(&key.domain) {
                let mut scene = smallest.clone();
                scene[key.name] = Value::from(word);
                if word == "common_mesh" {
                    scene["variant"] = Value::from("updated_cubic");
                }
                let read = Scene::from_json(&scene).unwrap();
                assert_eq!(Scene::from_json(&read.to_json()).unwrap(), read, "{} = {word}", key.name);
            }
        }
    }
}

fn words_of(domain: &Domain) -> Vec<&'static str> {
    match domain {
        Domain::Word(words) => words.iter().map(|word| word.name).collect(),
        Domain::Tagged { variants, .. } => variants
            .iter()
            .filter(|variant| variant.keys.iter().all(|key| key.absent != Absent::Required))
            .map(|variant| variant.name)
            .collect(),
        Domain::Auto(inner) => words_of(inner),
        _ => Vec::new(),
    }
}

#[test]
fn every_key_is_documented() {
    fn check(key: &Key) {
        assert!(!key.meaning.is_empty() && !key.meaning.ends_with('.'), "{key:?}");
        assert!(!key.unit.is_empty() && !key.source.is_empty(), "{key:?}");
    }
    for model in Model::ALL {
        model.keys().iter().for_each(check);
        for quantity in model.quantities() {
            assert!(model.key(quantity.name).is_none(), "{} is a key and a quantity", quantity.name);
        }
        let schema = model.schema();
        assert_eq!(schema["properties"].as_object().unwrap().len(), model.keys().len() + 1);
    }
}

#[test]
fn the_committed_documentation_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/keys.md");
    let generated = document();
    if std::env::var_os("TAMP_BLESS").is_some() {
        std::fs::write(&path, &generated).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == generated, "docs/keys.md is stale: run `TAMP_BLESS=1 cargo test -p scene`");
}
