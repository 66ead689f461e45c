//! What the absence of a feature saves: every null law against the full law with zero coefficient, on a packing at
//! rest (`cargo run --release -p sim-core --example skips -- PACKING.csv STEPS`; the packing is made by
//! `bench/peers/run.py` or `--example peer_case export`). The two follow the same trajectory (tests: equivalence).

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

use std::error::Error;
use std::time::Instant;

use sim_core::Options;
use sim_core::dem::{Drag, Dynamics, InitialState, Laws, SphereParameters, spheres};

fn read(packing: &str) -> Result<InitialState, Box<dyn Error>> {
    let text = std::fs::read_to_string(packing)?;
    let mut lines = text.lines();
    let head = lines.next().ok_or("empty packing")?.trim_start_matches('#');
    let faces = head.split_whitespace().map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()?;
    let mut positions = Vec::new();
    for line in lines {
        let row = line.split(',').map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()?;
        positions.push([row[0], row[1], row[2]]);
    }
    let still = vec![[0.0; 3]; positions.len()];
    Ok(InitialState {
        velocities: still.clone(),
        spins: still,
        positions,
        walls: [faces[0], faces[3], faces[1], faces[4], faces[2], faces[5]],
        wall_velocities: [0.0; 6],
    })
}

/// Time of a particle-step [ns].
fn time(dem: &mut dyn Dynamics, steps: u64) -> Result<f64, Box<dyn Error>> {
    let start = Instant::now();
    dem.run(steps).map_err(|fault| fault.what)?;
    Ok(start.elapsed().as_secs_f64() * 1e9 / (steps as f64 * dem.counters().particles as f64))
}

/// Least time of a particle-step of either system, taken in turn [ns].
fn compare(
    first: &mut dyn Dynamics,
    second: &mut dyn Dynamics,
    steps: u64,
) -> Result<[f64; 2], Box<dyn Error>> {
    let mut best = [f64::INFINITY; 2];
    for _ in 0..9 {
        best[0] = best[0].min(time(first, steps)?);
        best[1] = best[1].min(time(second, steps)?);
    }
    Ok(best)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let (packing, steps) = (arguments.get(1).ok_or("usage: skips PACKING.csv STEPS")?, arguments[2].parse()?);
    let initial = read(packing)?;
    let n = initial.positions.len() as f64;
    let full = SphereParameters {
        adhesion: 1e-6,
        alpha_n: 0.25,
        mu: 0.4,
        mu_wall: 0.4,
        ..SphereParameters::springs()
    };
    let build =
        |parameters: &SphereParameters, laws| spheres(parameters, &initial, 0.1, laws, &Options::default());
    println!("| absent | with | without | saved | bytes per particle saved |\n|---|---|---|---|---|");
    let print = |what: &str, [with, without]: [f64; 2], bytes: f64| {
        let bytes = if bytes.is_nan() { "as above".to_owned() } else { format!("{bytes:.0}") };
        println!("| {what} | {with:.1} ns | {without:.1} ns | {:.1} ns | {bytes} |", with - without);
    };
    let cases = [
        ("friction (mu = mu_wall = 0)", SphereParameters { mu: 0.0, mu_wall: 0.0, ..full.clone() }),
        ("adhesion (sigma_c = 0)", SphereParameters { adhesion: 0.0, ..full.clone() }),
        ("damping (alpha_n = 0)", SphereParameters { alpha_n: 0.0, ..full.clone() }),
        (
            "all three",
            SphereParameters { mu: 0.0, mu_wall: 0.0, adhesion: 0.0, alpha_n: 0.0, ..full.clone() },
        ),
    ];
    for (what, parameters) in cases {
        let mut with = build(&parameters, Laws::All);
        let mut without = build(&parameters, Laws::Needed);
        let times = compare(&mut *with, &mut *without, steps)?;
        let bytes = (with.counters().bytes as f64 - without.counters().bytes as f64) / n;
        print(what, times, bytes);
    }
    let smooth = SphereParameters { mu: 0.0, mu_wall: 0.0, ..full.clone() };
    let times = compare(&mut *build(&full, Laws::Needed), &mut *build(&smooth, Laws::Needed), steps)?;
    print("friction, against mu = 0.4 on the same packing", times, f64::NAN);
    let mut dragged = build(&full, Laws::Needed);
    dragged.set_drag(Drag::Each(vec![0.0; initial.positions.len()]));
    let times = compare(&mut *dragged, &mut *build(&full, Laws::Needed), steps)?;
    print("drag (approach = natural)", times, size_of::<f64>() as f64);
    Ok(())
}
