//! What goes into a collapse and what comes out.

use serde::{Deserialize, Serialize};

use super::{Reading, ReadingComparison};
use crate::Determined;
use crate::cost::Scatter;
use crate::levels::{EMin, OutlierReason, Plateau};
use crate::plateau::{P0, PlateauFit};

/// How the collapse reads the runs. The default is the documented procedure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(default, deny_unknown_fields)]
pub struct CollapseOptions {
    /// Points up to this η* are the dense limit [1].
    pub dense_eta_star: f64,
    /// The plateau is centred on runs of this range of η* [1]; runs above it belong to it unless outliers.
    pub plateau_eta_star: [f64; 2],
    /// Whose e_max.
    pub reading: Reading,
    /// e_min to use instead of the dense limit [1].
    pub e_min: Option<f64>,
    /// Use runs with σc/σe above 0.05 in fits.
    pub include_out_of_model: bool,
    /// Use runs that ended at their step limit.
    pub include_unsettled: bool,
    /// A run is off the plateau beyond this many robust standard deviations …
    pub outlier_sigma: f64,
    /// … and beyond this share of e_max − e_min [1].
    pub outlier_least: f64,
    /// Reference pressure p_Δ of (15) [Pa].
    pub p_delta: f64,
}

impl Default for CollapseOptions {
    fn default() -> Self {
        Self {
            dense_eta_star: 1e-3,
            plateau_eta_star: [0.5, 3.0],
            reading: Reading::PerPressure,
            e_min: None,
            include_out_of_model: false,
            include_unsettled: false,
            outlier_sigma: 3.5,
            outlier_least: 0.05,
            p_delta: P0,
        }
    }
}

/// What part a point plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Used in levels and fits.
    Fit,
    /// Off the plateau; shown, not fitted.
    Outlier,
    /// σc/σe above 0.05; shown, not fitted.
    OutOfModel,
    /// α_n, m_w or e_i differs from the main series; shown, not fitted.
    Variation,
}

/// One point of the collapse: the mean over replicates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CollapsePoint {
    /// Id of the first run.
    pub id: String,
    /// Confining pressure [Pa].
    pub p: f64,
    /// Cohesive stress [Pa].
    pub sigma_c: f64,
    /// Elastic stress [Pa].
    pub sigma_e: f64,
    /// Damping ratio α_n [1].
    pub alpha_n: f64,
    /// Wall mass m_w/m [1].
    pub mw: f64,
    /// Initial void ratio [1].
    pub ei: f64,
    /// Cohesion number η = σc/p [1].
    pub eta: f64,
    /// Modified cohesion number η* = σc/√(p σe) [1].
    pub eta_star: f64,
    /// Critical pressure p_crit = σc²/σe [Pa].
    pub p_crit: f64,
    /// Void ratio [1].
    pub e: f64,
    /// Standard deviation of e from replicate scatter [1]; absent without replicates.
    pub e_sigma: Option<f64>,
    /// Number of replicates.
    pub replicates: usize,
    /// Plateau used [1].
    pub e_max: f64,
    /// Relative void ratio (17) [1].
    pub e_r: f64,
    /// What part the point plays.
    pub role: Role,
}

/// A run off the plateau.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Outlier {
    /// Id of the first run of the point.
    pub id: String,
    /// Pressure [Pa].
    pub p: f64,
    /// Cohesive stress [Pa].
    pub sigma_c: f64,
    /// Elastic stress [Pa].
    pub sigma_e: f64,
    /// e minus the plateau [1].
    pub deviation: f64,
    /// Why.
    pub reason: OutlierReason,
    /// Why, as a sentence.
    pub message: String,
}

/// A run that could not be placed on the collapse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Excluded {
    /// Id of the run.
    pub id: String,
    /// Why.
    pub reason: String,
}

/// The collapse of a set of runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Collapse {
    /// How it was made.
    pub options: CollapseOptions,
    /// Number of runs given.
    pub runs: usize,
    /// The dense limit.
    pub e_min: EMin,
    /// The plateau of each pressure, in rising order.
    pub plateaus: Vec<Plateau>,
    /// Fit of (15) to the plateaus that were read from runs.
    pub plateau_fit: Determined<PlateauFit>,
    /// The points.
    pub points: Vec<CollapsePoint>,
    /// Points off the plateau with their reasons.
    pub outliers: Vec<Outlier>,
    /// Runs left out with their reasons.
    pub excluded: Vec<Excluded>,
    /// Scatter of e_r about a smooth monotone curve in ln η*: the collapse cost.
    pub scatter: Determined<Scatter>,
    /// The two readings of e_max and which collapses better.
    pub readings: Determined<ReadingComparison>,
}
