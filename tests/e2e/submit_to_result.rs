//! A sweep goes in, rows come out, and the service computes what the program computes alone.

use serde_json::Value;

use crate::lab::{Lab, undisturbed};
use crate::scenes;

#[test]
fn a_sweep_becomes_rows() {
    let lab = Lab::new();
    let _worker = lab.worker("worker");
    let sweep = lab.submit(&scenes::quick("rows", &[1e4, 1e6, 3e7]));
    let view = lab.wait_until_done(sweep);
    assert_eq!((view.points, view.counts.done, view.reused), (3, 3, 0));

    let text =
        lab.ask(async |client| client.get_bytes(&format!("/v1/sweeps/{sweep}/results?format=ndjson")).await);
    let text = String::from_utf8(text.to_vec()).unwrap();
    let rows: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(rows.len(), 3);
    for (row, sigma_c) in rows.iter().zip([1e4, 1e6, 3e7]) {
        assert_eq!(row["sigma_c"].as_f64(), Some(sigma_c), "{row}");
        assert!(row["e"].as_f64().is_some_and(|e| e > 0.0), "{row}");
        assert_eq!(row["attempt"], 1, "{row}");
    }
}

#[test]
fn the_service_computes_what_the_program_computes_alone() {
    let lab = Lab::new();
    let _worker = lab.worker("worker");
    let sweep = lab.submit(&scenes::sweep_of_one("alone", 3000));
    lab.wait_until_done(sweep);
    let result = lab.job(lab.jobs(sweep)[0]).result.expect("done");
    assert_eq!(result.digest, undisturbed(3000));
}
