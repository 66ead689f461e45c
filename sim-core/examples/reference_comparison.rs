//! Compares settled packings with the independent reference runs, row by row:
//!
//! `cargo run --release -p sim-core --example reference_comparison -- docs/validation/cohesive-spheres/reference.csv`
//!
//! Every row is run with its own parameters, time step and number of steps, for the seeds given after the file
//! (default 1 2 3), and printed as a Markdown table. `--n N` keeps rows of one size, `--at-most STEPS` shortens runs.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use std::collections::BTreeMap;

use scene::Scene;
use serde_json::json;
use sim_core::{Options, compile};

/// One reference run: column to text.
type Row = BTreeMap<String, String>;

fn rows(text: &str) -> Vec<Row> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines
        .map(|line| {
            names.iter().map(|name| (*name).to_owned()).zip(line.split(',').map(str::to_owned)).collect()
        })
        .collect()
}

fn real(row: &Row, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name} is a number"))
}

/// (e, e_core, Z, Z+, Z−) of our run of a row.
fn run(row: &Row, seed: u64, at_most: u64) -> [f64; 5] {
    let whole = |name: &str| real(row, name).round();
    let keys = json!({
        "model": "cohesive_spheres", "n": whole("n") as u64, "seed": seed,
        "p": real(row, "p_Pa"), "sigma_c": real(row, "sigma_c_Pa"), "sigma_e": real(row, "sigma_e_Pa"),
        "alpha_n": real(row, "alpha_n"), "mw": real(row, "mw"), "scale_wall_mass": false, "ei": real(row, "ei"),
        "mu_wall": real(row, "mu_wall"), "wall_adhesion": real(row, "wall_adhesion"),
        "moving_walls": whole("moving_walls") as u64, "agitation": real(row, "agitation_factor"),
        "dt": real(row, "dt_over_tau"), "max_steps": (whole("steps") as u64).min(at_most),
        "stop": { "rule": "steps" },
    });
    let scene = Scene::from_json(&keys).unwrap_or_else(|error| panic!("{error}")).reduce();
    let mut simulation = compile(&scene, &Options::default()).expect("compiles");
    while !simulation.advance(100_000).expect("runs").finished {}
    let record = simulation.outcome().expect("an outcome").record;
    ["e", "e_core", "z", "z_plus", "z_minus"].map(|name| record.real(name).expect("in every record"))
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("usage: reference_comparison FILE [--n N] [--at-most STEPS] [SEED …]");
    let (mut size, mut at_most, mut seeds) = (None, u64::MAX, Vec::new());
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--n" => size = arguments.next(),
            "--at-most" => at_most = arguments.next().and_then(|n| n.parse().ok()).expect("--at-most STEPS"),
            seed => seeds.push(seed.parse().expect("a seed")),
        }
    }
    if seeds.is_empty() {
        seeds = vec![1, 2, 3];
    }
    println!(
        "| n | σc [MPa] | p [MPa] | σe [MPa] | mw | walls: μ, f_c, moving | dt | seed | e ref. | e | e_core ref. | e_core | Z ref. | Z | Z+ ref. | Z+ | Z− ref. | Z− |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for row in rows(&std::fs::read_to_string(&path).expect("a readable file")) {
        if size.as_ref().is_some_and(|n| *n != row["n"]) {
            continue;
        }
        let core =
            row["notes"].split("e_core(2.5d)=").nth(1).and_then(|rest| rest.split(' ').next()).unwrap_or("");
        for &seed in &seeds {
            let [e, e_core, z, z_plus, z_minus] = run(&row, seed, at_most);
            let mega = |name: &str| real(&row, name) / 1e6;
            println!(
                "| {} | {} | {} | {} | {} | {}, {}, {} | {} | {seed} | {} | {e:.4} | {core} | {e_core:.4} | {} | {z:.3} | {} | {z_plus:.3} | {} | {z_minus:.3} |",
                row["n"],
                mega("sigma_c_Pa"),
                mega("p_Pa"),
                mega("sigma_e_Pa"),
                row["mw"],
                row["mu_wall"],
                row["wall_adhesion"],
                row["moving_walls"],
                row["dt_over_tau"],
                row["e"],
                row["z"],
                row["z_plus"],
                row["z_minus"],
            );
        }
    }
}
