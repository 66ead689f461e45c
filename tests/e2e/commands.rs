//! Commands that need no coordinator.

use std::path::Path;
use std::process::{Command, Stdio};

use rustix::process::Signal;
use serde_json::Value;

use crate::lab::{PROGRAM, Process, digest_of, tamp, undisturbed};
use crate::scenes;
use crate::wait::until;

fn json_of(arguments: &[&str], paths: &[&Path]) -> Value {
    let output = tamp(arguments, paths);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_run_prints_one_flat_record() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.json");
    std::fs::write(&file, scenes::scene_of(500).to_string()).unwrap();
    let record = json_of(&["run", "--quiet"], &[&file]);
    let fields = record.as_object().unwrap();
    assert!(fields.values().all(|value| !value.is_object() && !value.is_array()), "flat: {record}");
    for name in ["e", "z", "status", "steps", "sigma_c", "eta_star", "scene_key", "kernel", "wall_s"] {
        assert!(fields.contains_key(name), "{name} is missing: {record}");
    }
    // any number of threads gives the same physics
    let again = json_of(&["run", "--quiet", "--threads", "2"], &[&file]);
    assert_eq!(record["e"], again["e"]);
}

#[test]
fn an_interrupted_run_goes_on_from_its_checkpoint_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("scene.json"), scenes::scene_of(scenes::LONG).to_string()).unwrap();
    let run = || {
        let mut command = Command::new(PROGRAM);
        command.args(["run", "--quiet", "--checkpoint-seconds", "0.1"]).arg(path("scene.json"));
        command.arg("--checkpoint").arg(path("state")).arg("--snapshot").arg(path("snapshot"));
        Process::spawn(command.stdout(Stdio::null()).stderr(Stdio::null()))
    };
    let interrupted = run();
    until("a checkpoint", || if path("state").exists() { Ok(()) } else { Err(()) });
    interrupted.signal(Signal::INT);
    assert_eq!(interrupted.end().code(), Some(1));
    assert!(!path("snapshot").join("record.json").exists(), "it was stopped in the middle");

    assert!(run().end().success());
    assert_eq!(digest_of(&path("snapshot")), undisturbed(scenes::LONG));
    let record: Value =
        serde_json::from_slice(&std::fs::read(path("snapshot").join("record.json")).unwrap()).unwrap();
    assert_eq!(record["resumed"], true);
}

#[test]
fn a_checkpoint_of_another_scene_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("scene.json"), scenes::scene_of(500).to_string()).unwrap();
    std::fs::write(path("state"), b"something else").unwrap();
    let output = tamp(&["run", "--quiet"], &[&path("scene.json"), Path::new("--checkpoint"), &path("state")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("remedy:"));
}

#[test]
fn bad_input_names_field_value_problem_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.json");
    std::fs::write(&file, r#"{"model":"cohesive_spheres","n":-3,"sigmac":1}"#).unwrap();
    for command in ["run", "explain", "bench"] {
        let output = tamp(&[command], &[&file]);
        assert_eq!(output.status.code(), Some(2), "{command}");
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(told.contains("n = -3") && told.contains("sigma_c") && told.contains("remedy:"), "{told}");
        assert!(output.stdout.is_empty(), "{command}");
    }
}

#[test]
fn explain_tells_kernel_step_memory_and_counts() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.json");
    std::fs::write(&file, scenes::scene_of(500).to_string()).unwrap();
    let scene = json_of(&["explain"], &[&file, Path::new("mu=0")]);
    for name in ["kernel", "skips", "dt", "dt_reason", "memory_bytes", "expected_steps", "cost", "scene_key"]
    {
        assert!(scene.get(name).is_some(), "{name} is missing: {scene}");
    }
    std::fs::write(&file, scenes::quick("counted", &[1e4, 1e4, 1e6]).to_string()).unwrap();
    let sweep = json_of(&["explain"], &[&file]);
    assert_eq!((&sweep["points"], &sweep["duplicates"]), (&Value::from(3), &Value::from(1)));
}

#[test]
fn bench_measures_a_step_and_the_plain_path_computes_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.json");
    std::fs::write(&file, scenes::scene_of(100_000).to_string()).unwrap();
    let arguments = ["bench", "--steps", "200", "--repeats", "2"];
    let fast = json_of(&arguments, &[&file]);
    assert!(fast["ns_per_particle_step"].as_f64().is_some_and(|cost| cost > 0.0), "{fast}");
    let plain = json_of(&[&arguments[..], &["--scalar"]].concat(), &[&file]);
    assert_eq!(fast["live"], plain["live"]);
}

#[test]
fn presets_print_sweeps_that_explain_takes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sweep.json");
    let preset = tamp(&["preset", "cohesive-study", "--set", "n=1000"], &[]);
    assert!(preset.status.success());
    std::fs::write(&file, &preset.stdout).unwrap();
    assert_eq!(json_of(&["explain"], &[&file])["points"], 291);
    assert_eq!(tamp(&["preset", "cohesive-stdy"], &[]).status.code(), Some(2));
}
