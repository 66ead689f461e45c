//! One compaction run and its jamming point.

use std::cmp::Ordering;

use record::Row;
use serde::{Deserialize, Serialize};

use super::model::Material;
use crate::FitError;

/// One recorded state, stresses in Pa, compression positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct PlasticState {
    /// Solid fraction Φ [1].
    pub phi: f64,
    /// Stress on the bottom wall σ [Pa].
    pub sigma: f64,
    /// Cumulative vertical strain −ln(h/h_i) [1].
    pub strain: Option<f64>,
    /// Coordination number without rattlers Z [1].
    pub z: Option<f64>,
    /// Plastic share f_p [1].
    pub f_p: Option<f64>,
    /// Mean largest curvature times the mean diameter, κ⟨d⟩ [1].
    pub kappa_d: Option<f64>,
    /// Nominal strain 1 − h/h_i [1].
    pub strain_nominal: Option<f64>,
    /// Force over the width of the contact with the bottom wall [Pa].
    pub sigma_contact: Option<f64>,
    /// Mean −σ_yy over the volume [Pa].
    pub sigma_volume: Option<f64>,
    /// −σ_yy at the centre of the first disc [Pa].
    pub sigma_centre: Option<f64>,
}

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct PlasticCurve {
    /// Scene key or job id.
    pub id: String,
    /// What was compressed: `assembly`, `diametrical`, `cell`.
    pub setup: String,
    /// Material.
    pub material: Material,
    /// Seed.
    pub seed: u64,
    /// States in rising strain.
    pub states: Vec<PlasticState>,
}

/// Bottom-wall stress over E that counts as carried.
const CARRIED: f64 = 1e-4;

impl PlasticCurve {
    /// Reads one run: its scene and record in `run`, its rows in `states` with stresses in E.
    #[must_use]
    pub fn from_run(run: &Row, states: &[Row]) -> Self {
        let young = run.real("young").unwrap_or(10e6);
        let elastic = run.text("material") == Some("elastic");
        let material = Material {
            young,
            nu: run.real("nu").unwrap_or(0.45),
            sigma_y: run.real("sigma_y").unwrap_or(0.4e6),
            h: if elastic { None } else { Some(run.real("h").unwrap_or(0.0)) },
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "seeds are small whole numbers"
        )]
        let seed = run.real("seed").unwrap_or(1.0) as u64;
        let stress = |row: &Row, name: &str| row.real(name).map(|value| value * young);
        let state = |row: &Row| {
            Some(PlasticState {
                phi: row.real("phi").filter(|phi| *phi > 0.0)?,
                sigma: row.real("sigma")? * young,
                strain: row.real("strain_log").map(f64::abs),
                z: row.real("z"),
                f_p: row.real("f_p"),
                kappa_d: row.real("kappa_d"),
                strain_nominal: row.real("strain"),
                sigma_contact: stress(row, "sigma_contact"),
                sigma_volume: stress(row, "sigma_volume"),
                sigma_centre: stress(row, "sigma_centre"),
            })
        };
        Self {
            id: ["scene_key", "key", "job", "id"]
                .iter()
                .find_map(|column| run.text(column))
                .unwrap_or_default()
                .to_owned(),
            setup: run.text("setup").unwrap_or("assembly").to_owned(),
            material,
            seed,
            states: states.iter().filter_map(state).collect(),
        }
    }

    /// Name for tables and legends.
    #[must_use]
    pub fn name(&self) -> String {
        match self.material.h {
            None => "elastic".to_owned(),
            Some(h) => format!("H = {} MPa", crate::plot::plain(h / 1e6)),
        }
    }

    /// Elastic discs first, then by rising H, then by seed.
    #[must_use]
    pub fn order(&self, other: &Self) -> Ordering {
        let rank = |curve: &Self| curve.material.h.unwrap_or(-1.0);
        rank(self).total_cmp(&rank(other)).then(self.seed.cmp(&other.seed))
    }

    /// Index of the onset of sustained stress on the bottom wall: from it on σ > 1e-4 E.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`] when the wall bears nothing at the end, or something from the first state on.
    pub fn jamming(&self) -> Result<usize, FitError> {
        const WHAT: &str = "jamming point";
        let limit = CARRIED * self.material.young;
        let last_free = self.states.iter().rposition(|state| state.sigma <= limit);
        match last_free {
            _ if self.states.is_empty() => Err(FitError::too_few(WHAT, "states", 2, 0)),
            None => Err(FitError::out_of_range(WHAT, "the bottom wall bears stress from the first state on")),
            Some(last) if last + 1 >= self.states.len() => {
                Err(FitError::out_of_range(WHAT, "the bottom wall bears no sustained stress yet"))
            }
            Some(last) => Ok(last + 1),
        }
    }
}
