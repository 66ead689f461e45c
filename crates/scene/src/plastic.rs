//! Model `plastic_discs`: scene in SI units and its dimensionless groups.
//!
//! Lengths are in the largest diameter d, stresses in Young's modulus E, masses per thickness in ρ d², times in
//! d √(ρ/E).

mod cost;
mod keys;
mod quantities;
mod reduce;

use serde::{Deserialize, Serialize};

/// What is compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Setup {
    /// Polydisperse discs in a box whose top wall comes down (Section 4 of the paper).
    Assembly,
    /// One disc between a fixed bottom wall and a top wall that comes down (Section 3).
    Diametrical,
    /// One disc in a box as wide as itself, closed from top and bottom: the cell of a square lattice.
    Cell,
}

/// What the discs are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Material {
    /// Elastic without limit.
    Elastic,
    /// Elastic up to σ_y, then plastic with linear isotropic hardening.
    Plastic,
}

/// How the hardening constant is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HardeningMeaning {
    /// dσ_y/dε_p, as the paper's E_p = E H/(E + H) takes it.
    PlasticModulus,
    /// Slope of the uniaxial stress–strain line past yield; the plastic modulus is E H/(E − H).
    TangentModulus,
}

/// How the motion is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Total Lagrangian, implicit, contact solved inside each Newton iteration: the reference.
    Implicit,
    /// The same bodies, law and contact with explicit steps on lumped masses: the fast variant.
    Explicit,
}

/// How the motion is discretised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Variant {
    /// Body-fitted bilinear cells in the undeformed configuration.
    #[default]
    TotalBilinear,
    /// Cubic splines on a regular grid in the undeformed configuration.
    TotalCubic,
    /// Cubic splines on a regular grid that is new at every step, one grid per particle: the paper's method.
    UpdatedCubic,
}

/// Between what contact acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Contact {
    /// Markers on the true outlines, by their gap.
    #[default]
    Markers,
    /// Nodes of a common mesh, by their velocities: the paper's multi-mesh contact.
    CommonMesh,
}

/// How the discs of an assembly move before the first step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StartVelocity {
    /// Nothing moves: the wall sends a front ahead of itself.
    #[default]
    Rest,
    /// As if the box had always been closing, v_y = −v y/h: no front.
    Uniform,
}

/// How strain and rotation are read from the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rotation {
    /// Midpoint strain, stress rotated with the material: objective.
    Jaumann,
    /// The paper's infinitesimal strain taken literally: no rotation.
    Infinitesimal,
}

/// A scene of plastic discs in SI units, all defaults filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plastic {
    /// What is compressed.
    pub setup: Setup,
    /// What the discs are made of.
    pub material: Material,
    /// Young's modulus E [Pa].
    pub young: f64,
    /// Poisson's ratio ν [1].
    pub nu: f64,
    /// Density ρ [kg/m³].
    pub rho: f64,
    /// Yield stress σ_y [Pa].
    pub sigma_y: f64,
    /// Hardening constant H [Pa].
    pub h: f64,
    /// How H is meant.
    pub h_meaning: HardeningMeaning,
    /// Number of discs of an assembly.
    pub n: u64,
    /// Diameter of the disc, or of the largest one [m]; `None`: 4 µm in an assembly, else 60 µm.
    pub d: Option<f64>,
    /// Smallest over largest diameter of an assembly [1].
    pub size_ratio: f64,
    /// Solid fraction of an assembly before compression [1].
    pub phi_i: f64,
    /// Seed of an assembly.
    pub seed: u64,
    /// Coulomb friction coefficient μ of all contacts [1].
    pub mu: f64,
    /// Speed at which the box closes [m/s]; `None`: 2 m/s in an assembly, else 0.5 m/s.
    pub wall_speed: Option<f64>,
    /// Speed at which the box begins to close [m/s]; `None`: `wall_speed` from first to last.
    pub wall_speed_start: Option<f64>,
    /// Kinetic energy of uniform closing over elastic energy that the speed may grow to [1]; no effect without
    /// `wall_speed_start`.
    pub inertia_ratio: f64,
    /// How the discs of an assembly move before the first step.
    pub start_velocity: StartVelocity,
    /// Solid fraction at which the run ends [1]; `None`: 0.97, none for diametrical compression.
    pub phi_end: Option<f64>,
    /// Nominal strain 1 − h/h_i at which the run ends [1]; `None`: 0.17 for diametrical compression, else 0.45.
    pub strain_end: Option<f64>,
    /// How the motion is integrated.
    pub method: Method,
    /// How the motion is discretised.
    pub variant: Variant,
    /// Between what contact acts.
    pub contact: Contact,
    /// Time step [s]; `None`: by the speed of the wall, or the stable one of the explicit method.
    pub dt: Option<f64>,
    /// Time integration parameter θ [1].
    pub theta: f64,
    /// Cells across a diameter; `None`: 24 for one disc, 12 in an assembly.
    pub cells: Option<u64>,
    /// Material points across a cell, with splines.
    pub points_across: u64,
    /// How strain and rotation are read from the motion.
    pub rotation: Rotation,
    /// Whether the stress sees the mean volume change of a cell.
    pub f_bar: bool,
    /// Nominal strain between two recorded states [1].
    pub strain_step: f64,
}

/// Plastic discs in units d = E = ρ = 1; every default resolved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReducedPlastic {
    /// What is compressed.
    pub setup: Setup,
    /// Poisson's ratio ν [1].
    pub nu: f64,
    /// Yield stress σ_y [E]; `None`: elastic.
    pub sigma_y: Option<f64>,
    /// Plastic modulus H [E]; 0 if elastic.
    pub h: f64,
    /// Number of discs.
    pub n: u64,
    /// Smallest over largest diameter [1].
    pub size_ratio: f64,
    /// Solid fraction before compression [1]; 0 for one disc.
    pub phi_i: f64,
    /// Seed; 0 for one disc.
    pub seed: u64,
    /// Coulomb friction coefficient μ [1].
    pub mu: f64,
    /// Speed at which the box closes [√(E/ρ)].
    pub wall_speed: f64,
    /// Speed programme of the wall; `None`: one speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pace: Option<Pace>,
    /// How the discs of an assembly move before the first step.
    #[serde(default, skip_serializing_if = "is_default")]
    pub start_velocity: StartVelocity,
    /// Solid fraction at which the run ends [1]; `None`: by strain alone.
    pub phi_end: Option<f64>,
    /// Nominal strain at which the run ends [1].
    pub strain_end: f64,
    /// How the motion is integrated.
    pub method: Method,
    /// How the motion is discretised; left out where it is the default, so that older keys stay.
    #[serde(default, skip_serializing_if = "is_default")]
    pub variant: Variant,
    /// Between what contact acts; left out likewise.
    #[serde(default, skip_serializing_if = "is_default")]
    pub contact: Contact,
    /// Time step [d √(ρ/E)]; `None`: by the speed of the wall, or the stable one of the explicit method.
    pub dt: Option<f64>,
    /// Time integration parameter θ [1].
    pub theta: f64,
    /// Cells across a diameter.
    pub cells: u64,
    /// Material points across a cell, with splines; left out where there are two.
    #[serde(default = "default_points", skip_serializing_if = "are_default_points")]
    pub points_across: u64,
    /// How strain and rotation are read from the motion.
    pub rotation: Rotation,
    /// Whether the stress sees the mean volume change of a cell.
    pub f_bar: bool,
    /// Nominal strain between two recorded states [1].
    pub strain_step: f64,
}

/// Material points across a cell unless the scene says otherwise.
const DEFAULT_POINTS: u64 = 2;

fn default_points() -> u64 {
    DEFAULT_POINTS
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn are_default_points(points: &u64) -> bool {
    *points == DEFAULT_POINTS
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A wall that begins slowly and speeds up as the elastic energy allows: v² = 6 r E_el/m between `speed` and the
/// speed of the scene, m v²/6 being the kinetic energy of uniform closing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pace {
    /// Speed at the start, the least one [√(E/ρ)].
    pub speed: f64,
    /// Kinetic energy of uniform closing over elastic energy, r [1].
    pub ratio: f64,
}
