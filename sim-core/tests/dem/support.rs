//! Shared by the tests of the particle engine.

use sim_core::dem::{Dynamics, InitialState, Laws, SphereParameters, View, spheres};
use sim_core::{KernelChoice, Options};

/// Parameters of spheres in a box of fixed walls without load: a place for two-body tests.
pub fn quiet() -> SphereParameters {
    SphereParameters::springs()
}

/// Parameters of a compaction: all physics on.
pub fn compaction() -> SphereParameters {
    SphereParameters {
        pressure: 1e-4,
        adhesion: 3e-4,
        wall_adhesion: 1e-4,
        alpha_n: 0.25,
        mu: 0.4,
        mu_wall: 0.3,
        wall_mass: 20.0,
        moving: [true; 6],
        ..quiet()
    }
}

/// Spheres at given places and velocities in a box of half-width `half` around the origin.
pub fn at(positions: &[[f64; 3]], velocities: &[[f64; 3]], half: f64) -> InitialState {
    InitialState {
        positions: positions.to_vec(),
        velocities: velocities.to_vec(),
        spins: vec![[0.0; 3]; positions.len()],
        walls: [-half, half, -half, half, -half, half],
        wall_velocities: [0.0; 6],
    }
}

/// A small deterministic stream of numbers in [0, 1).
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A gas of n³ spheres on a jittered lattice with random velocities and spins.
pub fn gas(n: usize, spacing: f64, speed: f64, seed: u64) -> InitialState {
    let mut numbers = Numbers(seed);
    let mut state = at(&[], &[], 1.0);
    for k in 0..n * n * n {
        let cell = [k % n, k / n % n, k / n / n];
        let jitter = 0.45 * (spacing - 1.0);
        state
            .positions
            .push(cell.map(|c| (c as f64 + 0.5) * spacing + jitter * (2.0 * numbers.next() - 1.0)));
        state.velocities.push(std::array::from_fn(|_| speed * (2.0 * numbers.next() - 1.0)));
        state.spins.push(std::array::from_fn(|_| speed * (2.0 * numbers.next() - 1.0)));
    }
    let side = n as f64 * spacing;
    state.walls = [0.0, side, 0.0, side, 0.0, side];
    state
}

pub fn scalar() -> Options {
    Options { threads: 1, kernel: KernelChoice::Scalar }
}

pub fn fast(threads: usize) -> Options {
    Options { threads, kernel: KernelChoice::Auto }
}

/// A violent compaction: contacts open, close, slide; walls hit.
pub fn violent(n: usize) -> (SphereParameters, InitialState) {
    (SphereParameters { pressure: 2e-3, ..compaction() }, gas(n, 1.12, 0.03, 11))
}

/// Runs the plain path and those with vectors side by side, to the last bit; the most contacts they had.
pub fn paths_agree(parameters: &SphereParameters, initial: &InitialState) -> usize {
    let choices = [KernelChoice::Scalar, KernelChoice::Avx2, KernelChoice::Auto];
    let mut paths = choices
        .map(|kernel| spheres(parameters, initial, 0.1, Laws::Needed, &Options { threads: 1, kernel }));
    let mut contacts = 0;
    for _ in 0..25 {
        let [plain, vectors @ ..] = paths.each_mut().map(|path| {
            path.run(40).expect("a sane compaction");
            path.view()
        });
        contacts = contacts.max(plain.contacts.len() + plain.wall_contacts.len());
        for vector in vectors {
            assert_eq!(bits(&plain), bits(&vector), "step {}", plain.step);
            assert_eq!(plain, vector);
        }
    }
    contacts
}

pub fn build(parameters: &SphereParameters, initial: &InitialState, dt: f64) -> Box<dyn Dynamics> {
    spheres(parameters, initial, dt, Laws::Needed, &scalar())
}

/// All bits of the motion of a view.
pub fn bits(view: &View) -> Vec<u64> {
    view.positions
        .iter()
        .chain(&view.velocities)
        .chain(&view.spins)
        .flatten()
        .chain(view.walls.iter().flat_map(|wall| [&wall.position, &wall.velocity, &wall.force]))
        .map(|x| x.to_bits())
        .collect()
}

/// Slope of log error against log step between the ends of a series of halved steps.
pub fn order(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).log2() / (errors.len() - 1) as f64
}
