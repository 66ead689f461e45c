//! What the stop rules cost against running ten times longer:
//!
//! `cargo run --release -p sim-core --example stop_study -- N SEED`
//!
//! Every scene is run to the rule `settled`, to the rule `evidence`, with rolling kicks, and to ten times the steps
//! of `settled`; equal seeds give the same trajectory until a rule stops it, so the differences are what a rule
//! misses. Prints a Markdown table.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use record::Row;
use scene::Scene;
use serde_json::{Value, json};
use sim_core::{Options, compile};

fn run(n: u64, seed: u64, [sigma_c, p, sigma_e]: [f64; 3], rule: &Value, more: &Value) -> Row {
    let mut keys = json!({
        "model": "cohesive_spheres", "n": n, "seed": seed, "p": p, "sigma_c": sigma_c, "sigma_e": sigma_e,
        "stop": rule,
    });
    for (key, value) in more.as_object().expect("an object") {
        keys[key] = value.clone();
    }
    let scene = Scene::from_json(&keys).unwrap_or_else(|error| panic!("{error}")).reduce();
    let mut simulation = compile(&scene, &Options::default()).expect("compiles");
    while !simulation.advance(100_000).expect("runs").finished {}
    simulation.outcome().expect("an outcome").record
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>().expect("a whole number"));
    let (n, seed) = (arguments.next().unwrap_or(400), arguments.next().unwrap_or(1));
    println!(
        "| σc [MPa] | p [MPa] | σe [MPa] | run | status | steps | e | Z | Z+ | Z− | β+ | KE/E_el | KE held/E_el | two-contact | e − e_long | ΔZ | ΔZ+ | ΔZ− | drift of e |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for [p, sigma_e] in [[1e5, 1e10], [1e6, 1e10], [1e6, 1e9]] {
        for sigma_c in [1e5, 1e6, 3e6, 3e7] {
            let stresses = [sigma_c, p, sigma_e];
            let settled_rule = json!({ "rule": "settled", "e_drift": 2.5e-4, "wall_imbalance": 0.01 });
            let evidence_rule =
                json!({ "rule": "evidence", "e_drift": 2.5e-4, "wall_imbalance": 0.01, "ke_over_eel": 2e-7 });
            let settled = run(n, seed, stresses, &settled_rule, &json!({}));
            let evidence = run(n, seed, stresses, &evidence_rule, &json!({}));
            let kicked = run(n, seed, stresses, &evidence_rule, &json!({ "approach": "rolling_kicks" }));
            let steps = settled.real("steps").expect("in every record");
            let long = run(
                n,
                seed,
                stresses,
                &json!({ "rule": "steps" }),
                &json!({ "max_steps": (10.0 * steps) as u64 }),
            );
            for (name, row) in
                [("settled", &settled), ("evidence", &evidence), ("kicks", &kicked), ("long", &long)]
            {
                let real = |column: &str| row.real(column).unwrap_or(f64::NAN);
                let miss = |column: &str| real(column) - long.real(column).unwrap_or(f64::NAN);
                println!(
                    "| {} | {} | {} | {name} | {} | {} | {:.4} | {:.3} | {:.3} | {:.3} | {:.2} | {:.1e} | {:.1e} | {} | {:+.5} | {:+.3} | {:+.3} | {:+.3} | {:.1e} |",
                    sigma_c / 1e6,
                    p / 1e6,
                    sigma_e / 1e6,
                    row.text("status").unwrap_or("?"),
                    real("steps"),
                    real("e"),
                    real("z"),
                    real("z_plus"),
                    real("z_minus"),
                    real("beta_plus"),
                    real("ke_over_eel"),
                    real("ke_held_over_eel"),
                    real("two_contact_particles"),
                    miss("e"),
                    miss("z"),
                    miss("z_plus"),
                    miss("z_minus"),
                    real("e_drift"),
                );
            }
        }
    }
}
