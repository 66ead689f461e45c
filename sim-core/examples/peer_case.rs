//! Our side of the comparison with other codes (`bench/peers/run.py`).
//!
//! `peer_case export SCENE.json PACKING.csv` advances a scene by its `max_steps` and writes faces and centres [d].
//! `peer_case time PACKING.csv STEPS [all] [scalar]` starts from such a packing at rest between fixed walls, as the
//! peers do: linear spring and dashpot, tangential history, Coulomb friction, no adhesion (`all`: adhesion is computed,
//! with f_c = 0). Prints one JSON line.

use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

use sim_core::bench::Bench;
use sim_core::dem::{InitialState, Laws, SphereParameters, spheres};
use sim_core::{KernelChoice, Options};

/// The cohesive study's standard parameters, as in `bench/peers/common.py`.
const DT: f64 = 0.1;
/// Steps before the clock starts, as for the peers.
const WARM_UP: u64 = 200;

fn export(scene: &str, packing: &str) -> Result<(), Box<dyn Error>> {
    let scene = scene::Scene::from_json(&serde_json::from_str(&std::fs::read_to_string(scene)?)?)
        .map_err(|problems| format!("{problems:?}"))?
        .reduce();
    let scene::Reduced::CohesiveSpheres(spheres) = &scene else { return Err("not spheres".into()) };
    let bench = Bench::prepare(&scene, spheres.max_steps.unwrap_or(0), &Options::default())?;
    let view = bench.view();
    let face = |side: usize, axis: usize| view.walls[2 * axis + side].position;
    let mut text = String::from("#");
    for side in 0..2 {
        for axis in 0..3 {
            write!(text, " {:?}", face(side, axis))?;
        }
    }
    text.push('\n');
    for [x, y, z] in &view.positions {
        writeln!(text, "{x:?},{y:?},{z:?}")?;
    }
    std::fs::write(packing, text)?;
    Ok(())
}

fn read(packing: &str) -> Result<InitialState, Box<dyn Error>> {
    let text = std::fs::read_to_string(packing)?;
    let mut lines = text.lines();
    let numbers = |line: &str, by: char| {
        line.split(by).filter(|part| !part.is_empty()).map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()
    };
    let faces = numbers(lines.next().ok_or("empty packing")?.trim_start_matches('#').trim(), ' ')?;
    let mut positions = Vec::new();
    for line in lines {
        let row = numbers(line, ',')?;
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

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn time(packing: &str, steps: u64, laws: Laws, kernel: KernelChoice) -> Result<(), Box<dyn Error>> {
    let parameters = SphereParameters { alpha_n: 0.25, mu: 0.4, mu_wall: 0.4, ..SphereParameters::springs() };
    let initial = read(packing)?;
    let mut dem = spheres(&parameters, &initial, DT, laws, &Options { threads: 1, kernel });
    let run = |dem: &mut Box<dyn sim_core::dem::Dynamics>, steps| dem.run(steps).map_err(|fault| fault.what);
    run(&mut dem, WARM_UP)?;
    let start = Instant::now();
    run(&mut dem, steps)?;
    let seconds = start.elapsed().as_secs_f64();
    let view = dem.view();
    let n = view.positions.len();
    let answer = serde_json::json!({
        "seconds": seconds,
        "steps": steps,
        "n": n,
        "contacts_per_particle": view.contacts.len() as f64 / n as f64,
        "kinetic_energy_per_particle": view.energies.translation / n as f64,
        "version": format!("Tamp {} ({})", env!("CARGO_PKG_VERSION"), dem.kernel()),
    });
    println!("{answer}");
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["export", scene, packing] => export(scene, packing),
        ["time", packing, steps, options @ ..] => {
            let laws = if options.contains(&"all") { Laws::All } else { Laws::Needed };
            let kernel = if options.contains(&"scalar") { KernelChoice::Scalar } else { KernelChoice::Auto };
            time(packing, steps.parse()?, laws, kernel)
        }
        _ => {
            Err("usage: peer_case export SCENE.json PACKING.csv | time PACKING.csv STEPS [all] [scalar]"
                .into())
        }
    }
}
