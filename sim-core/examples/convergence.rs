//! Errors of deterministic cases against the time step, for docs/accuracy.md:
//!
//! `cargo run --release -p sim-core --example convergence > docs/validation/cohesive-spheres/error-study/convergence.csv`
//!
//! With the word `mixed` the same cases in mixed precision (`convergence-mixed.csv`).
//!
//! - `collision`: rebound speed off a wall against the exact solution (2024, equations 19 to 24), worst over where in a
//!   step the contact begins, over v0; α_n = 0.25, with and without adhesion.
//! - `chain`: a bonded chain of 16 spheres swings in its longest longitudinal mode; exact is
//!   u_j = A cos(π (j − ½)/16) cos(ω t), ω = 2 sin(π/32); largest displacement error over two periods, over A.
//! - `energy`: root mean square of the relative energy error of 27 elastic spheres in a fixed box over 20 τ.
//! - `walls`: gap of an empty box whose six walls are driven by p S, against L̈ = −2 p L²/m_w by Runge–Kutta.
#![expect(clippy::print_stdout, reason = "an example for the command line")]

use std::f64::consts::PI;

use sim_core::dem::{Dynamics, InitialState, Laws, SphereParameters, spheres};
use sim_core::{KernelChoice, Options};

fn boxed(positions: Vec<[f64; 3]>, velocities: Vec<[f64; 3]>, half: f64) -> InitialState {
    InitialState {
        spins: vec![[0.0; 3]; positions.len()],
        positions,
        velocities,
        walls: [-half, half, -half, half, -half, half],
        wall_velocities: [0.0; 6],
    }
}

fn build(parameters: &SphereParameters, initial: &InitialState, dt: f64) -> Box<dyn Dynamics> {
    let options = Options { threads: 1, kernel: KernelChoice::Auto };
    let mixed = std::env::args().any(|word| word == "mixed");
    spheres(&SphereParameters { mixed, ..*parameters }, initial, dt, Laws::Needed, &options)
}

fn whole(value: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive count")]
    let count = value.round() as u64;
    count
}

/// A sphere of unit mass in contact with a wall from t = 0 on: δ̈ = −δ − 2 α δ̇ − f_c with δ(0) = 0, δ̇(0) = −v0.
/// Returns the time and speed of the first return to δ = 0.
fn rebound(alpha: f64, fc: f64, v0: f64) -> (f64, f64) {
    let omega = (1.0 - alpha * alpha).sqrt();
    let state = |t: f64| {
        let (s, c) = (omega * t).sin_cos();
        let b = (alpha * fc - v0) / omega;
        let fade = (-alpha * t).exp();
        let position = -fc + fade * (fc * c + b * s);
        let speed = fade * ((b * omega - alpha * fc) * c - (fc * omega + alpha * b) * s);
        (position, speed)
    };
    let (mut low, mut high) = (0.5, 0.5);
    while state(high).0 < 0.0 {
        low = high;
        high += 1e-3;
        assert!(high < 7.0, "no rebound");
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if state(middle).0 < 0.0 { low = middle } else { high = middle }
    }
    (low, state(low).1)
}

fn collision(fc: f64, dt: f64) -> f64 {
    let (alpha, v0) = (0.25, 1e-2);
    let (time, speed) = rebound(alpha, fc, v0);
    (0..13)
        .map(|k| {
            let gap = (3.0 + f64::from(k) / 13.0) * dt * v0;
            let parameters = SphereParameters {
                alpha_n: alpha,
                adhesion: fc,
                wall_adhesion: fc,
                ..SphereParameters::springs()
            };
            let initial = boxed(vec![[0.0, 0.2, -8.5 + gap]], vec![[0.0, 0.0, -v0]], 9.0);
            let mut dem = build(&parameters, &initial, dt);
            dem.run(whole(time / dt) + 8).expect("a collision is sane");
            ((dem.view().velocities[0][2] - speed) / v0).abs()
        })
        .fold(0.0, f64::max)
}

fn chain(dt: f64) -> f64 {
    const COUNT: u32 = 16;
    let (fc, amplitude) = (1e-2, 1e-4);
    let omega = 2.0 * (PI / (2.0 * f64::from(COUNT))).sin();
    let shape = |j: u32| amplitude * (PI * (f64::from(j) + 0.5) / f64::from(COUNT)).cos();
    let rest = |j: u32| (f64::from(j) - 0.5 * f64::from(COUNT - 1)) * (1.0 - fc);
    let positions = (0..COUNT).map(|j| [rest(j) + shape(j), 0.0, 0.0]).collect();
    let initial = boxed(positions, vec![[0.0; 3]; COUNT as usize], 12.0);
    let mut dem = build(&SphereParameters { adhesion: fc, ..SphereParameters::springs() }, &initial, dt);
    let period = 2.0 * PI / omega;
    let mut worst = 0.0_f64;
    while dem.time() < 2.0 * period {
        dem.run(1).expect("a chain is sane");
        let phase = (omega * dem.time()).cos();
        for (j, x) in (0..COUNT).zip(&dem.view().positions) {
            worst = worst.max((x[0] - rest(j) - shape(j) * phase).abs() / amplitude);
        }
    }
    worst
}

/// 27 spheres on a jittered lattice; a small deterministic stream of numbers.
fn gas(seed: u64) -> InitialState {
    let mut bits = seed;
    let mut draw = || {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let number = (bits >> 11) as f64 / (1_u64 << 53) as f64;
        2.0 * number - 1.0
    };
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for k in 0..27_u32 {
        let cell = [k % 3, k / 3 % 3, k / 9];
        positions.push(cell.map(|c| (f64::from(c) - 1.0) * 1.1 + 0.045 * draw()));
        velocities.push([0; 3].map(|_| 0.02 * draw()));
    }
    boxed(positions, velocities, 1.65)
}

fn energy(adhesion: f64, dt: f64) -> f64 {
    let mut sum = 0.0;
    for seed in 0..12 {
        let mut dem = build(&SphereParameters { adhesion, ..SphereParameters::springs() }, &gas(seed), dt);
        let start = dem.view().energies.total();
        for _ in 0..20 {
            dem.run(whole(1.0 / dt)).expect("a gas is sane");
            sum += ((dem.view().energies.total() - start) / start).powi(2);
        }
    }
    (sum / (12.0 * 20.0)).sqrt()
}

fn walls(dt: f64) -> f64 {
    let (p, mw, end) = (2e-3, 5.0, 12.8);
    let (mut gap, mut rate) = (10.0_f64, 0.0_f64);
    let h = end / 20_000.0;
    let f = |gap: f64| -2.0 * p * gap * gap / mw;
    for _ in 0..20_000 {
        let (k1, l1) = (rate, f(gap));
        let (k2, l2) = (rate + 0.5 * h * l1, f(gap + 0.5 * h * k1));
        let (k3, l3) = (rate + 0.5 * h * l2, f(gap + 0.5 * h * k2));
        let (k4, l4) = (rate + h * l3, f(gap + h * k3));
        gap += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        rate += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
    }
    let parameters =
        SphereParameters { pressure: p, wall_mass: mw, moving: [true; 6], ..SphereParameters::springs() };
    let mut dem = build(&parameters, &boxed(vec![[0.0; 3]], vec![[0.0; 3]], 5.0), dt);
    dem.run(whole(end / dt)).expect("walls alone are sane");
    let now = dem.view().walls;
    ((now[1].position - now[0].position) - gap).abs() / gap
}

fn main() {
    println!("case,dt,error");
    for dt in [0.2, 0.1, 0.05, 0.025, 0.0125, 0.00625] {
        println!("collision,{dt},{:.4e}", collision(0.0, dt));
        println!("collision with adhesion,{dt},{:.4e}", collision(1e-3, dt));
        println!("chain,{dt},{:.4e}", chain(dt));
        println!("energy,{dt},{:.4e}", energy(0.0, dt));
        println!("energy with adhesion,{dt},{:.4e}", energy(2e-4, dt));
        println!("walls,{dt},{:.4e}", walls(dt));
    }
}
