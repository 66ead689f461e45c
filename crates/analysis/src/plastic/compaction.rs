//! Stress against solid fraction and strain with the fits of (5)–(13).

mod fit;

use serde::{Deserialize, Serialize};

use super::curve::PlasticCurve;
use super::model::{Constants, Material};
use crate::{Determined, Estimate, Fit, FitError};

/// How the constants are fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(default, deny_unknown_fields)]
pub struct CompactionOptions {
    /// Largest Φ used: beyond it the contact zones are finer than the mesh [1].
    pub largest_phi: f64,
    /// Relative difference at which a plastic curve counts as parted from the elastic one [1].
    pub parted: f64,
}

impl Default for CompactionOptions {
    fn default() -> Self {
        Self { largest_phi: 0.95, parted: 0.1 }
    }
}

/// The jamming point of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Jamming {
    /// Φ_c at the onset of sustained stress on the bottom wall [1]; the paper has 0.8.
    pub phi_c: f64,
    /// Stress there [Pa].
    pub sigma_c: f64,
    /// Strain there [1].
    pub strain_c: Option<f64>,
    /// Coordination number there [1].
    pub z_c: Option<f64>,
    /// Φ_c by linear back-extrapolation of σ(Φ) over the next 0.03 in Φ [1].
    pub phi_c_extrapolated: Determined<Estimate>,
}

/// One sample of the model curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ModelSample {
    /// Φ [1].
    pub phi: f64,
    /// σ by (6) or (10) with the paper's constants, and Z of the run [Pa].
    pub paper: f64,
    /// σ with the fitted constants [Pa].
    pub fitted: Option<f64>,
    /// ε − ε_c [1].
    pub excess_strain: Option<f64>,
    /// σ − σ_c from the strain, with the fitted or else the paper's constants [Pa]: (5); for plastic discs (10) of (5)
    /// and (12).
    pub by_strain: Option<f64>,
}

/// One run with its fits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CompactionCurve {
    /// Id of the run.
    pub id: String,
    /// `elastic` or the value of H.
    pub name: String,
    /// Material.
    pub material: Material,
    /// The states.
    pub states: Vec<super::PlasticState>,
    /// The jamming point.
    pub jamming: Determined<Jamming>,
    /// Elastic discs: fit of (6) for f_e, f_g with p_c = 1 − Φ_c, c2 = −ln Φ_c, c1 = 1. Plastic discs: fit of (10) for
    /// f_ep with the elastic constants held and f_p as measured or by (11). Abscissa: number of the state.
    pub fit: Determined<Fit>,
    /// α of (11) from the measured plastic share [1]; the paper has 2.5.
    pub alpha: Determined<Estimate>,
    /// Stress at which this curve parts from the elastic one [Pa]; the paper has about 0.35 MPa.
    pub parts_at: Determined<f64>,
    /// The model along the states from jamming on.
    pub model: Vec<ModelSample>,
}

/// Compaction curves of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Compaction {
    /// How it was made.
    pub options: CompactionOptions,
    /// One per run, elastic ones first, then by rising H.
    pub curves: Vec<CompactionCurve>,
    /// The paper's constants.
    pub paper: Constants,
}

/// Fits the compaction curves of a sweep.
///
/// # Errors
/// [`FitError::TooFew`] without a single state.
pub fn compaction(curves: &[PlasticCurve], options: &CompactionOptions) -> Result<Compaction, FitError> {
    let mut sorted: Vec<&PlasticCurve> = curves.iter().filter(|curve| !curve.states.is_empty()).collect();
    if sorted.is_empty() {
        return Err(FitError::too_few("compaction", "runs with states", 1, 0));
    }
    sorted.sort_by(|a, b| a.order(b));
    let elastic = sorted.iter().find(|curve| curve.material.h.is_none()).copied();
    let elastic_constants = elastic.map(|curve| fit::constants(curve, options));
    let curves = sorted
        .iter()
        .map(|curve| {
            let held = elastic_constants.as_ref().and_then(|result| result.as_ref().ok()).map(|(c, _)| *c);
            fit::curve(curve, elastic, held, options)
        })
        .collect();
    Ok(Compaction { options: options.clone(), curves, paper: Constants::PAPER })
}

#[cfg(test)]
mod tests;
