//! Model `cohesive_discs`: scene and dimensionless groups.
//!
//! The model knows no SI scale: forces are in F0 (the pull-off force), lengths in a (the largest diameter), masses
//! in m (of a disc of diameter a), times in T0 = √(a m/F0). Choosing F0, a and m turns every result into SI units.

mod cost;
mod keys;
mod quantities;
mod reduce;

use serde::{Deserialize, Serialize};

use crate::Precision;

/// How the first equilibrium state is made from the hard-disc fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Assembly {
    /// Velocities zero, pressure from the start.
    Type1,
    /// Agitated discs aggregate in a fixed cell until one cluster holds all, equilibrium at P = 0, then pressure.
    Type2,
    /// F0 = 0: a granular gas (agitated discs) compressed from the start; pressures are P/K_N.
    Cohesionless,
}

/// One leg of the loading path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathLeg {
    /// Last pressure of the leg, P* (P/K_N without cohesion) [1].
    pub to: f64,
    /// Steps per decade of pressure, in equal ratios [1].
    pub per_decade: f64,
}

/// A scene of cohesive discs, all defaults filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Discs {
    /// Number of discs.
    pub n: u64,
    /// Seed of radii, positions and velocities.
    pub seed: u64,
    /// How the first state is made.
    pub assembly: Assembly,
    /// Friction coefficient μ [1].
    pub mu: f64,
    /// Rolling friction μ_R/a [1].
    pub mu_r: f64,
    /// Rolling stiffness K_R/(K_N a²) [1]; `None`: (μ_R/(μ a))².
    pub kr: Option<f64>,
    /// Stiffness number κ = a K_N/F0 [1].
    pub kappa: f64,
    /// K_T/K_N [1].
    pub kt_over_kn: f64,
    /// Range of the attraction D0/a [1].
    pub d0: f64,
    /// Normal restitution e_N without adhesion [1].
    pub en: f64,
    /// Smallest over largest diameter [1].
    pub size_ratio: f64,
    /// Solid fraction of the fluid Φ_I [1].
    pub phi_i: f64,
    /// Metropolis sweeps that turn the random insertion into a fluid.
    pub fluid_sweeps: u64,
    /// Agitation of type 2, V0/V*, and of the cohesionless gas, V0/√(a P/m) [1]; `None`: 9.5, and the speed at which
    /// the pressure of the gas is the first pressure.
    pub v0: Option<f64>,
    /// First pressure, P* (P/K_N without cohesion) [1]; `None`: 0.01 (1e-5).
    pub p0: Option<f64>,
    /// The path after it; `None`: to 13.33 (1.333e-3) with 8 steps per decade and back with 2.
    pub path: Option<Vec<PathLeg>>,
    /// Largest strain rate times T0: inertia parameter I_a [1].
    pub ia: f64,
    /// Mass M of the cell coordinate along the path [m].
    pub cell_mass: f64,
    /// M while the first pressure is applied [m]; `None`: `cell_mass` for type 2, else the mass of all discs.
    pub assembly_cell_mass: Option<f64>,
    /// Factor on the paper's four equilibrium tolerances [1].
    pub tolerance: f64,
    /// Coefficient of the local damping of the final stage [1]; 0: none.
    pub final_damping: f64,
    /// Rate of the drag once the final stage has lasted long [1/T0]; 0: none.
    pub final_drag: f64,
    /// Time step [√(m/K_N)]; `None`: 0.1.
    pub dt: Option<f64>,
    /// Time after which a state without equilibrium ends the run [T0].
    pub max_time: f64,
    /// What is kept in single precision.
    pub precision: Precision,
}

/// Cohesive discs in units a = m = K_N = 1, time unit √(m/K_N); every default resolved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReducedDiscs {
    /// Number of discs.
    pub n: u64,
    /// Seed of radii, positions and velocities.
    pub seed: u64,
    /// How the first state is made.
    pub assembly: Assembly,
    /// Friction coefficient μ [1].
    pub mu: f64,
    /// Rolling friction μ_R [a].
    pub mu_r: f64,
    /// Rolling stiffness K_R [K_N a²]; 0 without rolling resistance.
    pub kr: f64,
    /// Pull-off force F0 = 1/κ [K_N a]; 0 without cohesion.
    pub f0: f64,
    /// K_T [K_N]; 0 without friction.
    pub kt: f64,
    /// Range of the attraction D0 [a]; 0 without cohesion.
    pub d0: f64,
    /// Normal restitution e_N without adhesion [1].
    pub en: f64,
    /// Smallest over largest diameter [1].
    pub size_ratio: f64,
    /// Solid fraction of the fluid Φ_I [1].
    pub phi_i: f64,
    /// Metropolis sweeps of the fluid; left out where it is the default, so that older keys stay.
    #[serde(default = "default_sweeps", skip_serializing_if = "are_default_sweeps")]
    pub fluid_sweeps: u64,
    /// Agitation: V0/V* of type 2, V0/√(a P/m) without cohesion [1]; 0 for type 1.
    pub v0: f64,
    /// First pressure, P* (P/K_N without cohesion) [1].
    pub p0: f64,
    /// The path after it.
    pub path: Vec<PathLeg>,
    /// Inertia parameter I_a [1].
    pub ia: f64,
    /// Mass M of the cell coordinate along the path [m].
    pub cell_mass: f64,
    /// M while the first pressure is applied [m]; `None`: the mass of all discs.
    pub assembly_cell_mass: Option<f64>,
    /// Factor on the equilibrium tolerances [1].
    pub tolerance: f64,
    /// Coefficient of the local damping of the final stage [1].
    pub final_damping: f64,
    /// Rate of the drag once the final stage has lasted long [1/T0]; left out where there is none, so that older keys
    /// stay.
    #[serde(default, skip_serializing_if = "is_none")]
    pub final_drag: f64,
    /// Time step [√(m/K_N)].
    pub dt: f64,
    /// Time after which a state without equilibrium ends the run [T0].
    pub max_time: f64,
    /// What is kept in single precision.
    #[serde(default, skip_serializing_if = "Precision::is_double")]
    pub precision: Precision,
}

/// Sweeps after which pairs and long waves are those of the fluid, from insertion and from a lattice alike
/// (`docs/validation/cohesive-discs`).
const DEFAULT_SWEEPS: u64 = 300;

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn is_none(rate: &f64) -> bool {
    *rate == 0.0
}

fn default_sweeps() -> u64 {
    DEFAULT_SWEEPS
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn are_default_sweeps(sweeps: &u64) -> bool {
    *sweeps == DEFAULT_SWEEPS
}
