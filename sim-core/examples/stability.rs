//! The stress suite of `docs/stability.md`, as a table: `cargo run --release -p sim-core --example stability [long]`.
//! With `long` the conservative packing runs ten million steps.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

use serde_json::{Value, json};
use sim_core::dem::{Dynamics, InitialState, Laws, SphereParameters, spheres};
use sim_core::{Options, SimError, compile, restore};

/// Compaction with all laws.
fn compaction() -> SphereParameters {
    SphereParameters {
        pressure: 1e-3,
        adhesion: 3e-4,
        alpha_n: 0.25,
        mu: 0.4,
        mu_wall: 0.4,
        wall_mass: 20.0,
        moving: [true; 6],
        ..SphereParameters::springs()
    }
}

/// side³ spheres on a lattice with small velocities that differ from one to the next.
fn lattice(side: usize, spacing: f64, speed: f64) -> InitialState {
    let mut positions = Vec::new();
    let mut velocities = Vec::new();
    for k in 0..side.pow(3) {
        let place = [k % side, k / side % side, k / (side * side)];
        positions.push(place.map(|c| (c as f64 + 0.5) * spacing));
        velocities.push(std::array::from_fn(|axis| speed * libm::sin((7 * k + 3 * axis) as f64 * 1.7)));
    }
    let edge = side as f64 * spacing;
    InitialState {
        spins: vec![[0.0; 3]; positions.len()],
        positions,
        velocities,
        walls: [0.0, edge, 0.0, edge, 0.0, edge],
        wall_velocities: [0.0; 6],
    }
}

fn system(parameters: &SphereParameters, initial: &InitialState, dt: f64) -> Box<dyn Dynamics> {
    spheres(parameters, initial, dt, Laws::Needed, &Options::default())
}

fn row(stress: &str, happened: &str, user: &str) {
    println!("| {stress} | {happened} | {user} |");
}

/// Time steps from a tenth of the estimated limit to twice the limit.
fn time_steps() {
    let parameters = SphereParameters { alpha_n: 0.05, ..compaction() };
    let mut settled = system(&parameters, &lattice(7, 1.05, 0.01), 0.1);
    settled.run(20_000).expect("0.1 τ is stable");
    let limit = settled.critical_dt();
    let saved = settled.save();
    for share in [0.1, 0.5, 0.9, 1.0, 1.2, 1.5, 2.0] {
        let mut dem =
            sim_core::dem::restore_spheres(&parameters, &saved, &Options::default()).expect("own bytes");
        dem.set_dt(share * limit);
        let before = dem.view().energies;
        let stress = format!("time step {share} of the estimated limit ({limit:.3} τ)");
        match dem.run(20_000) {
            Ok(()) => {
                let after = dem.view().energies;
                let growth = after.kinetic() / before.kinetic().max(1e-300);
                row(
                    &stress,
                    &format!(
                        "20 000 steps; kinetic energy × {growth:.1e}, KE/E_el {:.1e}",
                        after.kinetic() / after.elastic()
                    ),
                    if share > 1.4 {
                        "nothing from the bare engine; a run never gets there: an automatic step is at most 0.7 of the limit, a given one is lowered"
                    } else {
                        "a run (the automatic step is at most 0.7 of the limit)"
                    },
                );
            }
            Err(fault) => row(
                &stress,
                &format!("step {}: {}", fault.step, fault.what),
                "retry with half the step, then `unstable` with this text",
            ),
        }
    }
}

/// Energy of a conservative packing.
fn conservation(steps: u64) {
    let parameters = SphereParameters { alpha_n: 0.0, mu: 0.0, mu_wall: 0.0, adhesion: 0.0, ..compaction() };
    let mut dem = system(&parameters, &lattice(3, 1.02, 0.01), 0.1);
    let start = dem.view().energies.total();
    let (mut early, mut late) = (0.0_f64, 0.0_f64);
    let slices = 1000;
    for slice in 0..slices {
        dem.run(steps / slices).expect("stable");
        let error = (dem.view().energies.total() / start - 1.0).abs();
        if slice < slices / 10 { early = early.max(error) } else { late = late.max(error) }
    }
    row(
        &format!("conservative packing of 27 spheres and six walls, {steps} steps of 0.1 τ"),
        &format!("largest relative energy error {early:.1e} in the first tenth, {late:.1e} later"),
        "nothing",
    );
}

/// Initial overlaps.
fn overlaps() {
    for distance in [0.9, 0.5, 1e-3, 0.0] {
        let mut initial = lattice(3, 1.3, 0.0);
        initial.positions[13] = initial.positions[0];
        initial.positions[13][0] += distance;
        let stress = format!("two spheres {distance} d apart at the start");
        let mut dem = system(&compaction(), &initial, 0.1);
        match dem.run(5000) {
            Ok(()) => {
                row(&stress, &format!("5000 steps; largest speed {:.1e} d/τ", dem.max_speed()), "a run")
            }
            Err(fault) => {
                row(&stress, &format!("step {}: {}", fault.step, fault.what), "`unstable` with this text")
            }
        }
    }
}

fn scene(keys: &Value) -> scene::Reduced {
    let mut all = json!({
        "model": "cohesive_spheres", "n": 200, "seed": 1, "p": 1e6, "sigma_e": 1e9, "sigma_c": 3e6, "max_steps": 20000,
    });
    for (key, value) in keys.as_object().expect("keys") {
        all[key] = value.clone();
    }
    scene::Scene::from_json(&all).expect("a valid scene").reduce()
}

/// One scene to its end.
fn whole(stress: &str, keys: &Value) {
    let outcome = compile(&scene(keys), &Options::default()).and_then(|mut run| {
        while !run.advance(5000)?.finished {}
        run.outcome()
    });
    match outcome {
        Ok(outcome) => {
            let status = outcome.record.text("status").unwrap_or("?").to_owned();
            let e = outcome.record.real("e").unwrap_or(f64::NAN);
            row(stress, &format!("status `{status}`, e = {e:.3}"), "a record with this status");
        }
        Err(error @ SimError::Scene { .. }) => {
            row(stress, "refused before the first step", &format!("`{error}`"))
        }
        Err(error) => row(stress, "stopped", &format!("`{error}`")),
    }
}

/// A run that is saved and restored every 1000 steps.
fn restarts() {
    let scene = scene(&json!({}));
    let options = Options::default();
    let finish = |every: Option<u64>| -> Result<String, SimError> {
        let mut run = compile(&scene, &options)?;
        while !run.advance(every.unwrap_or(5000))?.finished {
            if every.is_some() {
                run = restore(&scene, &options, &run.save())?;
            }
        }
        Ok(serde_json::to_string(&run.outcome()?).expect("plain"))
    };
    let same = finish(None) == finish(Some(1000));
    row(
        "saved and restored every 1000 steps",
        if same { "the same bits in every cell of record, tables and packing" } else { "DIFFERENT results" },
        "nothing",
    );
}

fn main() {
    let long = std::env::args().any(|word| word == "long");
    println!("| stress | what happened | what the user sees |\n|---|---|---|");
    time_steps();
    conservation(if long { 10_000_000 } else { 100_000 });
    overlaps();
    for (p, sigma_e) in [(1e4, 5e8), (1e4, 2e11), (1e6, 5e8), (1e6, 2e11)] {
        for sigma_c in [2e3, 4e8] {
            let keys = json!({ "p": p, "sigma_e": sigma_e, "sigma_c": sigma_c });
            whole(
                &format!(
                    "corner p = {p:e}, σe = {sigma_e:e}, σc = {sigma_c:e} Pa, 200 spheres, 20 000 steps"
                ),
                &keys,
            );
        }
    }
    for n in [1, 2, 3] {
        whole(&format!("{n} sphere(s), e_i = 9"), &json!({ "n": n, "ei": 9.0 }));
        whole(&format!("{n} sphere(s), default e_i"), &json!({ "n": n }));
    }
    for mw in [0.1, 0.01] {
        whole(&format!("walls of {mw} particle masses"), &json!({ "mw": mw }));
    }
    for agitation in [100.0, 1e4] {
        whole(&format!("agitation × {agitation}"), &json!({ "agitation": agitation }));
    }
    for mu in [0.0, 10.0] {
        whole(&format!("friction {mu}"), &json!({ "mu": mu }));
    }
    for dt in [0.1, 0.2, 0.4, 0.6, 0.8, 3.0] {
        whole(&format!("time step {dt} τ given"), &json!({ "dt": dt }));
    }
    restarts();
}
