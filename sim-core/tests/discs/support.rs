//! Small systems of discs.

use sim_core::dem::{CellControl, CellDynamics, DiscParameters, InitialDiscs, discs};
use sim_core::{KernelChoice, Options};

/// Laws of Table I in units of K_N, with restitution e_N = 0.015 and μ_R = 0.005 a.
pub const TABLE_1: DiscParameters = DiscParameters {
    f0: 1e-5,
    d0: 1e-3,
    restitution: 0.015,
    kt: 1.0,
    mu: 0.5,
    kr: 1e-4,
    mu_r: 0.005,
    mixed: false,
};

/// Frictionless, without cohesion and damping.
pub const ELASTIC: DiscParameters =
    DiscParameters { f0: 0.0, d0: 0.0, restitution: 1.0, kt: 0.0, mu: 0.0, kr: 0.0, mu_r: 0.0, mixed: false };

pub const FAST: Options = Options { threads: 1, kernel: KernelChoice::Auto };

/// Two discs on the x axis in a wide fixed cell, `gap` apart, the second one moving with `velocity`.
pub fn pair(
    parameters: &DiscParameters,
    radii: [f64; 2],
    gap: f64,
    velocity: f64,
    dt: f64,
) -> Box<dyn CellDynamics> {
    let initial = InitialDiscs {
        positions: vec![[4.0, 5.0], [4.0 + radii[0] + radii[1] + gap, 5.0]],
        radii: radii.to_vec(),
        velocities: vec![[0.0; 2], [velocity, 0.0]],
        spins: vec![0.0; 2],
        edges: [10.0, 10.0],
        control: CellControl::Fixed,
    };
    discs(parameters, &initial, dt, &FAST)
}

/// Equal discs of diameter 1 on a triangular lattice of the given spacing, `columns` by 2 `pairs` rows.
pub fn triangular(columns: usize, pairs: usize, spacing: f64, control: CellControl) -> InitialDiscs {
    let height = 3.0_f64.sqrt() / 2.0;
    let mut positions = Vec::new();
    for row in 0..2 * pairs {
        for column in 0..columns {
            let shift = if row % 2 == 1 { 0.75 } else { 0.25 };
            positions.push([(column as f64 + shift) * spacing, (row as f64 + 0.5) * height * spacing]);
        }
    }
    let count = positions.len();
    InitialDiscs {
        positions,
        radii: vec![0.5; count],
        velocities: vec![[0.0; 2]; count],
        spins: vec![0.0; count],
        edges: [columns as f64 * spacing, 2.0 * pairs as f64 * height * spacing],
        control,
    }
}

/// A fluid of unequal discs that fly and stick.
pub fn gas(control: CellControl) -> InitialDiscs {
    fluid(120, control)
}

/// The same with enough discs for four chunks.
pub fn large_gas(control: CellControl) -> InitialDiscs {
    fluid(7000, control)
}

fn fluid(count: usize, control: CellControl) -> InitialDiscs {
    use rand_pcg::Pcg64;
    use sim_core::packing::hard_discs::{FluidRecipe, hard_disc_fluid, maxwell_velocities};
    let recipe =
        FluidRecipe { discs: count, solid_fraction: 0.45, size_ratio: 0.5, clearance: 1.01e-3, sweeps: 5 };
    let mut random = Pcg64::new(11, 1);
    let fluid = hard_disc_fluid(&recipe, &mut random).unwrap();
    let velocities = maxwell_velocities(&fluid.radii, 1e-3, &mut random);
    InitialDiscs {
        positions: fluid.positions,
        velocities,
        spins: vec![0.0; count],
        radii: fluid.radii,
        edges: [fluid.edge; 2],
        control,
    }
}

/// Lets a system come to rest: local damping on all motion.
pub fn settle(dem: &mut dyn CellDynamics, steps: u64) {
    dem.set_local_damping(0.5);
    dem.run(steps).unwrap();
}
