//! Energy of conservative packings over long times, for docs/stability.md:
//!
//! `cargo run --release -p sim-core --example drift -- [SEEDS 8] [TIME 1e5] [mixed] > drift.csv`
//!
//! 27 spheres without friction and damping between six walls under pressure 1e-3, with and without adhesion. The energy
//! is averaged over the last tenth of every decade of time and compared with the mean of the first 100 τ, so that
//! what oscillates with the motion itself is left out.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use sim_core::dem::{InitialState, Laws, SphereParameters, spheres};
use sim_core::{KernelChoice, Options};

/// Looks at the energy in every average.
const LOOKS: u32 = 50;

/// 27 spheres on a lattice with velocities that differ from seed to seed.
fn lattice(seed: u32) -> InitialState {
    const SIDE: u32 = 3;
    let spacing = 1.02;
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for k in 0..SIDE.pow(3) {
        let place = [k % SIDE, k / SIDE % SIDE, k / (SIDE * SIDE)];
        positions.push(place.map(|c| (f64::from(c) + 0.5) * spacing));
        let wave = |axis: u32| 0.01 * libm::sin(f64::from(7 * k + 3 * axis) * 1.7 + f64::from(seed) * 0.9);
        velocities.push([0, 1, 2].map(wave));
    }
    let edge = f64::from(SIDE) * spacing;
    InitialState {
        spins: vec![[0.0; 3]; positions.len()],
        positions,
        velocities,
        walls: [0.0, edge, 0.0, edge, 0.0, edge],
        wall_velocities: [0.0; 6],
    }
}

fn steps(time: f64, dt: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive count")]
    let count = (time / dt).round() as u64;
    count
}

fn run(adhesion: f64, dt: f64, seed: u32, until: f64, mixed: bool) {
    let parameters = SphereParameters {
        pressure: 1e-3,
        adhesion,
        mixed,
        wall_mass: 20.0,
        moving: [true; 6],
        ..SphereParameters::springs()
    };
    let options = Options { threads: 1, kernel: KernelChoice::Auto };
    let mut dem = spheres(&parameters, &lattice(seed), dt, Laws::Needed, &options);
    let mut mean = |to: f64, over: f64| {
        dem.run(steps(to - over, dt) - dem.steps()).expect("stable");
        let sum: f64 = (0..LOOKS)
            .map(|_| {
                dem.run(steps(over / f64::from(LOOKS), dt)).expect("stable");
                dem.view().energies.total()
            })
            .sum();
        sum / f64::from(LOOKS)
    };
    let start = mean(100.0, 100.0);
    let mut time = 1e3;
    while time <= until * 1.001 {
        println!("{adhesion},{dt},{seed},{time},{:.4e}", mean(time, 0.1 * time) / start - 1.0);
        time *= 10.0;
    }
}

fn main() {
    let (words, numbers): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|text| text == "mixed");
    let mixed = !words.is_empty();
    let mut arguments = numbers.iter().map(|text| text.parse::<f64>().expect("a number"));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let seeds = arguments.next().unwrap_or(8.0) as u32;
    let until = arguments.next().unwrap_or(1e5);
    println!("adhesion,dt,seed,time,energy_error");
    for adhesion in [0.0, 3e-4] {
        for dt in [0.1, 0.05, 0.025] {
            for seed in 1..=seeds {
                run(adhesion, dt, seed, until, mixed);
            }
        }
    }
}
