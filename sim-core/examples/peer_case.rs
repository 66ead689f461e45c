//! Our side of the comparison with other codes (`bench/peers/run.py`).
//!
//! `peer_case export SCENE.json PACKING.csv` advances a scene by its `max_steps` and writes faces and centres [d].
//! `peer_case loose SCENE.json PACKING.csv RATE` writes the initial state of a scene, with velocities and the rate at which
//! every edge of the box is to shrink per unit of its first length [1/τ].
//! `peer_case time PACKING.csv STEPS [all] [scalar] [avx2] [mixed]` starts from such a packing, between fixed or moving walls, as the
//! peers do: linear spring and dashpot, tangential history, Coulomb friction, no adhesion (`all`: adhesion is computed,
//! with f_c = 0; `mixed`: in mixed precision). Prints one JSON line.

use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

use sim_core::bench::Bench;
use sim_core::dem::{InitialState, Laws, SphereParameters, View, spheres};
use sim_core::{KernelChoice, Options};

/// The cohesive study's standard parameters, as in `bench/peers/common.py`.
const DT: f64 = 0.1;
/// Steps before the clock starts, as for the peers.
const WARM_UP: u64 = 200;

/// Faces, and what else belongs to the first line.
fn header(view: &View, more: &str) -> Result<String, std::fmt::Error> {
    let mut text = String::from("#");
    for side in 0..2 {
        for axis in 0..3 {
            write!(text, " {:?}", view.walls[2 * axis + side].position)?;
        }
    }
    writeln!(text, "{more}")?;
    Ok(text)
}

fn prepare(scene: &str, advance: bool) -> Result<View, Box<dyn Error>> {
    let scene = scene::Scene::from_json(&serde_json::from_str(&std::fs::read_to_string(scene)?)?)
        .map_err(|problems| format!("{problems:?}"))?
        .reduce();
    let scene::Reduced::CohesiveSpheres(spheres) = &scene else { return Err("not spheres".into()) };
    let steps = if advance { spheres.max_steps.unwrap_or(0) } else { 0 };
    Ok(Bench::prepare(&scene, steps, &Options::default())?.view())
}

fn export(scene: &str, packing: &str) -> Result<(), Box<dyn Error>> {
    let view = prepare(scene, true)?;
    let mut text = header(&view, "")?;
    for [x, y, z] in &view.positions {
        writeln!(text, "{x:?},{y:?},{z:?}")?;
    }
    std::fs::write(packing, text)?;
    Ok(())
}

fn loose(scene: &str, packing: &str, rate: &str) -> Result<(), Box<dyn Error>> {
    let view = prepare(scene, false)?;
    let mut text = header(&view, &format!(" {:?}", rate.parse::<f64>()?))?;
    for ([x, y, z], [u, v, w]) in view.positions.iter().zip(&view.velocities) {
        writeln!(text, "{x:?},{y:?},{z:?},{u:?},{v:?},{w:?}")?;
    }
    std::fs::write(packing, text)?;
    Ok(())
}

/// The state and whether the walls move.
fn read(packing: &str) -> Result<(InitialState, bool), Box<dyn Error>> {
    let text = std::fs::read_to_string(packing)?;
    let mut lines = text.lines();
    let numbers = |line: &str, by: char| {
        line.split(by).filter(|part| !part.is_empty()).map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()
    };
    let head = numbers(lines.next().ok_or("empty packing")?.trim_start_matches('#').trim(), ' ')?;
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for line in lines {
        let row = numbers(line, ',')?;
        positions.push([row[0], row[1], row[2]]);
        velocities.push(if row.len() > 3 { [row[3], row[4], row[5]] } else { [0.0; 3] });
    }
    let rate = head.get(6).copied().unwrap_or(0.0);
    let walls = [head[0], head[3], head[1], head[4], head[2], head[5]];
    let inwards = |axis: usize| 0.5 * rate * (walls[2 * axis + 1] - walls[2 * axis]);
    let wall_velocities = [0, 1, 2, 3, 4, 5].map(|wall| [1.0, -1.0][wall % 2] * inwards(wall / 2));
    let spins = vec![[0.0; 3]; positions.len()];
    Ok((InitialState { velocities, spins, positions, walls, wall_velocities }, rate != 0.0))
}

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn time(
    packing: &str,
    steps: u64,
    laws: Laws,
    kernel: KernelChoice,
    mixed: bool,
) -> Result<(), Box<dyn Error>> {
    let (initial, moving) = read(packing)?;
    let parameters = SphereParameters {
        alpha_n: 0.25,
        mu: 0.4,
        mu_wall: 0.4,
        // so heavy that no force of the particles changes their velocity
        wall_mass: if moving { 1e15 } else { 1.0 },
        moving: [moving; 6],
        mixed,
        ..SphereParameters::springs()
    };
    let mut dem = spheres(&parameters, &initial, DT, laws, &Options { threads: 1, kernel });
    let run = |dem: &mut Box<dyn sim_core::dem::Dynamics>, steps| dem.run(steps).map_err(|fault| fault.what);
    run(&mut dem, if moving { 0 } else { WARM_UP })?;
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
        ["loose", scene, packing, rate] => loose(scene, packing, rate),
        ["time", packing, steps, options @ ..] => {
            let laws = if options.contains(&"all") { Laws::All } else { Laws::Needed };
            let kernel = match () {
                () if options.contains(&"scalar") => KernelChoice::Scalar,
                () if options.contains(&"avx2") => KernelChoice::Avx2,
                () => KernelChoice::Auto,
            };
            time(packing, steps.parse()?, laws, kernel, options.contains(&"mixed"))
        }
        _ => {
            Err("usage: peer_case export SCENE.json PACKING.csv | loose SCENE.json PACKING.csv RATE | time PACKING.csv STEPS \
                  [all] [scalar] [avx2] [mixed]"
                .into())
        }
    }
}
