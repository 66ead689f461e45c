//! Our side of the comparison of compactions with other codes (`bench/peers/compaction.py`).
//!
//! `peer_compaction start SCENE.json SEED START.csv` writes the initial state of a cohesionless scene: pressure, wall
//! mass, walls, then x, y, z, vx, vy, vz of every particle (units d, m, k_n).
//! `peer_compaction run START.csv STEPS EVERY DT MU` compacts it between six walls under constant pressure, with time step DT [τ]
//! and friction MU, and prints one JSON line: step, void ratio, contacts per particle, contacts with walls, kinetic energy per particle, every EVERY steps.

use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write as _;

use sim_core::Options;
use sim_core::bench::Bench;
use sim_core::dem::{Dynamics, InitialState, Laws, SphereParameters, View, spheres};

fn start(scene: &str, seed: &str, path: &str) -> Result<(), Box<dyn Error>> {
    let mut keys: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(scene)?)?;
    keys["seed"] = seed.parse::<u64>()?.into();
    let scene = scene::Scene::from_json(&keys).map_err(|problems| format!("{problems:?}"))?.reduce();
    let view = Bench::prepare(&scene, 0, &Options::default())?.view();
    let wall = &view.walls[0];
    let area = {
        let gap = |axis: usize| view.walls[2 * axis + 1].position - view.walls[2 * axis].position;
        gap(1) * gap(2)
    };
    let scene::Reduced::CohesiveSpheres(spheres) = &scene else { return Err("not spheres".into()) };
    let mut text = format!("# {:?} {:?}", wall.load / area, spheres.wall_mass);
    for wall in &view.walls {
        write!(text, " {:?}", wall.position)?;
    }
    text.push('\n');
    for ([x, y, z], [u, v, w]) in view.positions.iter().zip(&view.velocities) {
        writeln!(text, "{x:?},{y:?},{z:?},{u:?},{v:?},{w:?}")?;
    }
    std::fs::write(path, text)?;
    Ok(())
}

fn read(path: &str, mu: f64) -> Result<(SphereParameters, InitialState), Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    let mut lines = text.lines();
    let numbers = |line: &str, by: char| {
        line.split(by).filter(|part| !part.is_empty()).map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()
    };
    let head = numbers(lines.next().ok_or("empty file")?.trim_start_matches('#').trim(), ' ')?;
    let [pressure, wall_mass, walls @ ..] = head.as_slice() else { return Err("no header".into()) };
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for line in lines {
        let row = numbers(line, ',')?;
        positions.push([row[0], row[1], row[2]]);
        velocities.push([row[3], row[4], row[5]]);
    }
    let initial = InitialState {
        spins: vec![[0.0; 3]; positions.len()],
        positions,
        velocities,
        walls: walls.try_into()?,
        wall_velocities: [0.0; 6],
    };
    let parameters = SphereParameters {
        pressure: *pressure,
        adhesion: 0.0,
        wall_adhesion: 0.0,
        alpha_n: 0.25,
        damping_uses_particle_mass: false,
        clamp_viscous: false,
        mu,
        mu_wall: mu,
        kt: 1.5,
        wall_mass: *wall_mass,
        moving: [true; 6],
        mixed: false,
    };
    Ok((parameters, initial))
}

/// Step, void ratio e, contacts per particle, wall contacts per particle, kinetic energy per particle.
fn row(view: &View) -> [f64; 5] {
    let n = view.positions.len() as f64;
    let gap = |axis: usize| view.walls[2 * axis + 1].position - view.walls[2 * axis].position;
    let e = gap(0) * gap(1) * gap(2) / (n * PI / 6.0) - 1.0;
    let kinetic = view.energies.translation / n;
    [view.step as f64, e, view.contacts.len() as f64 / n, view.wall_contacts.len() as f64 / n, kinetic]
}

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn run(path: &str, steps: u64, every: u64, dt: f64, mu: f64) -> Result<(), Box<dyn Error>> {
    let (parameters, initial) = read(path, mu)?;
    let mut dem: Box<dyn Dynamics> = spheres(&parameters, &initial, dt, Laws::Needed, &Options::default());
    let mut rows = vec![row(&dem.view())];
    while dem.steps() < steps {
        dem.run(every.min(steps - dem.steps())).map_err(|fault| fault.what)?;
        rows.push(row(&dem.view()));
    }
    println!(
        "{}",
        serde_json::json!({"rows": rows, "version": format!("Tamp {}", env!("CARGO_PKG_VERSION"))})
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["start", scene, seed, path] => start(scene, seed, path),
        ["run", path, steps, every, dt, mu] => {
            run(path, steps.parse()?, every.parse()?, dt.parse()?, mu.parse()?)
        }
        _ => {
            Err("usage: peer_compaction start SCENE.json SEED START.csv | run START.csv STEPS EVERY DT MU"
                .into())
        }
    }
}
