//! `tamp study`: the whole chain with one command, and nothing twice.

use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};

use crate::lab::tamp;

fn study(folder: &Path, definition: &Value) -> String {
    let file = folder.join("sweep.json");
    std::fs::write(&file, definition.to_string()).unwrap();
    let output = tamp(&["study", "--slots", "2"], &[&file, Path::new("--data-dir"), &folder.join("data")]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// The lines that begin with a number.
fn table(text: &str) -> Vec<&str> {
    let is_row = |line: &&str| line.split_whitespace().next().is_some_and(|word| word.parse::<f64>().is_ok());
    text.lines().filter(is_row).collect()
}

#[test]
fn a_study_ends_with_a_table_and_files_and_does_nothing_twice() {
    let folder = tempfile::tempdir().unwrap();
    let definition = json!({
        "name": "tiny",
        "model": "cohesive_spheres",
        "base": { "n": 30, "sigma_e": 1e9, "stop": "settled" },
        "blocks": [ { "grid": { "p": [1e5, 1e6], "sigma_c": { "log": [1e5, 4e7, 6] } } } ]
    });
    let first = study(folder.path(), &definition);
    assert_eq!(table(&first).len(), 12, "{first}");

    let begun = Instant::now();
    let second = study(folder.path(), &definition);
    assert_eq!(table(&first), table(&second));
    assert!(begun.elapsed().as_secs() < 20, "found every point done");

    let files = folder.path().join("data").join("tiny");
    for name in ["results.csv", "results.json", "collapse.json", "collapse.svg"] {
        let size =
            std::fs::metadata(files.join(name)).unwrap_or_else(|error| panic!("{name}: {error}")).len();
        assert!(size > 0, "{name} is empty");
    }
    let csv = std::fs::read_to_string(files.join("results.csv")).unwrap();
    assert_eq!(csv.lines().count(), 13, "a header and a line per point");
}

#[test]
fn bad_input_is_told_field_by_field_with_status_2() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sweep.json");
    std::fs::write(&file, r#"{"name":"x","model":"cohesive_spheres","base":{"n":-1,"sigmac":1}}"#).unwrap();
    let output = tamp(&["study"], &[&file, Path::new("--data-dir"), &folder.path().join("data")]);
    assert_eq!(output.status.code(), Some(2));
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(errors.contains("base.n = -1") && errors.contains("sigma_c"), "{errors}");
    assert!(!folder.path().join("data").exists(), "nothing is begun");
}
