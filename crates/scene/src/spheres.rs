//! Model `cohesive_spheres`: scene in SI units and its dimensionless groups.

mod cost;
mod keys;
mod quantities;
mod reduce;

use serde::{Deserialize, Serialize};

use crate::{Precision, round12};

/// Which mass enters the normal dashpot −2 α_n √(k_n m) δ̇_n.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampingMass {
    /// m/2 for a pair, m for a wall.
    Effective,
    /// The particle mass m for both.
    Particle,
}

/// How equilibrium is sought after e has settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Approach {
    /// Undisturbed dynamics.
    Natural,
    /// Rolling kicks on particles with one or two contacts, then drag (recorded; see docs/accuracy.md).
    RollingKicks,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "rule", rename_all = "snake_case", deny_unknown_fields)]
pub enum Stop {
    /// Evidence that e stands still: drift of e and wall-pressure imbalance below their tolerances.
    Settled {
        /// Largest change of e while the number of steps grows by a quarter [1].
        e_drift: f64,
        /// Largest relative deviation of a wall force from p S [1].
        wall_imbalance: f64,
    },
    /// Validated equilibrium: settled, hardly any motion that deforms the network, Z± near their limits.
    Evidence {
        /// Largest change of e while the number of steps grows by a quarter [1].
        e_drift: f64,
        /// Largest relative deviation of a wall force from p S [1].
        wall_imbalance: f64,
        /// Largest kinetic energy of the motion along the normals between particles with at least four contacts, over the
        /// elastic energy [1].
        ke_contacts: f64,
        /// Largest change that Z+ or Z− still has before it, extrapolated in 1/t [1].
        z_rest: f64,
    },
    /// The paper's criterion: kinetic over elastic energy of all particles [1].
    KineticEnergy {
        /// Threshold [1]; the paper uses 2e-7.
        ke_over_eel: f64,
    },
    /// Run to the step limit.
    Steps,
}

/// A scene of cohesive spheres in SI units, all defaults filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spheres {
    /// Number of spheres.
    pub n: u64,
    /// Seed of positions and velocities.
    pub seed: u64,
    /// Confining pressure p [Pa].
    pub p: f64,
    /// Cohesive stress σc = f_c/d² [Pa].
    pub sigma_c: f64,
    /// Elastic stress σe = k_n/d [Pa].
    pub sigma_e: f64,
    /// Damping ratio α_n of the normal dashpot [1].
    pub alpha_n: f64,
    /// Friction coefficient μ [1].
    pub mu: f64,
    /// Tangential over normal stiffness k_t/k_n [1].
    pub kt_over_kn: f64,
    /// Wall mass over particle mass m_w/m [1].
    pub mw: f64,
    /// Whether m_w is scaled by wall area to the paper's size (N = 17 657).
    pub scale_wall_mass: bool,
    /// Initial void ratio e_i [1].
    pub ei: f64,
    /// Wall friction [1].
    pub mu_wall: f64,
    /// Wall adhesion as a fraction of f_c [1].
    pub wall_adhesion: f64,
    /// Moving walls: 6 or 3.
    pub moving_walls: u8,
    /// Initial speed v_k in units of 0.158 √(p0 d³/m), p0 = 0.01 MPa [1].
    pub agitation: f64,
    /// Mass in the normal dashpot.
    pub damping_mass: DampingMass,
    /// Whether the viscous force is clamped so that it never pulls more than the elastic force pushes.
    pub clamp_viscous: bool,
    /// Time step [τ]; `None`: from the stiffest mode.
    pub dt: Option<f64>,
    /// Step limit; `None`: from the estimate.
    pub max_steps: Option<u64>,
    /// When to stop.
    pub stop: Stop,
    /// How equilibrium is sought.
    pub approach: Approach,
    /// What is kept in single precision.
    pub precision: Precision,
}

/// Cohesive spheres in units d = m = k_n = 1, time unit τ = √(m/k_n).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReducedSpheres {
    /// Number of spheres.
    pub n: u64,
    /// Seed of positions and velocities.
    pub seed: u64,
    /// p/σe [1].
    pub pressure: f64,
    /// f_c/(k_n d) = σc/σe [1].
    pub adhesion: f64,
    /// Damping ratio α_n [1].
    pub alpha_n: f64,
    /// Friction coefficient μ [1].
    pub mu: f64,
    /// k_t/k_n [1].
    pub kt_over_kn: f64,
    /// Mass of one wall [m], already scaled by wall area when the scene asks for it.
    pub wall_mass: f64,
    /// Initial void ratio [1].
    pub ei: f64,
    /// Wall friction [1].
    pub mu_wall: f64,
    /// Wall adhesion as a fraction of f_c [1].
    pub wall_adhesion: f64,
    /// Moving walls: 6 or 3.
    pub moving_walls: u8,
    /// Initial speed v_k [d/τ].
    pub agitation_speed: f64,
    /// Mass in the normal dashpot.
    pub damping_mass: DampingMass,
    /// Whether the viscous force is clamped.
    pub clamp_viscous: bool,
    /// Time step [τ]; `None`: from the stiffest mode.
    pub dt: Option<f64>,
    /// Step limit; `None`: from the estimate.
    pub max_steps: Option<u64>,
    /// When to stop.
    pub stop: Stop,
    /// How equilibrium is sought.
    pub approach: Approach,
    /// What is kept in single precision.
    #[serde(default, skip_serializing_if = "Precision::is_double")]
    pub precision: Precision,
}

impl Stop {
    /// Tolerances rounded to 12 significant digits.
    pub(crate) fn rounded(self) -> Self {
        match self {
            Self::Settled { e_drift, wall_imbalance } => {
                Self::Settled { e_drift: round12(e_drift), wall_imbalance: round12(wall_imbalance) }
            }
            Self::Evidence { e_drift, wall_imbalance, ke_contacts, z_rest } => Self::Evidence {
                e_drift: round12(e_drift),
                wall_imbalance: round12(wall_imbalance),
                ke_contacts: round12(ke_contacts),
                z_rest: round12(z_rest),
            },
            Self::KineticEnergy { ke_over_eel } => Self::KineticEnergy { ke_over_eel: round12(ke_over_eel) },
            Self::Steps => Self::Steps,
        }
    }
}
