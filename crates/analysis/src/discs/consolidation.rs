//! Consolidation curves: eqs. (7), (8), (9).
//!
//! Regime II: 1/Φ = 1/Φ0 − λ ln(P*/P*0) (7). Regime III: 1/Φ = 1/Φmax + A/(P*)^α (8). Both:
//! 1/Φ = 1/Φ0 − λ ln{(P*/P*0) [1 − exp(−(P*1/P*)^α)]^(1/α)} (9), with A = λ P*1^α/(2α) and
//! ln(P*1/P*0) = (1/Φ0 − 1/Φmax)/λ. The paper prints the last relation without λ; [`RelationCheck`] tells the two apart.
//!
//! A free fit of (9) is degenerate (Φ0 runs away along λ), so it is made in stages on curves averaged over samples:
//! λ and Φ0 from the straight part, Φmax and α from the tail, then joined: α and P*1 of (9) on everything above
//! regime I with λ and Φ0 held, and these from the straight part freed from the bend that α and P*1 imply ([`Method`]).

mod fit;
mod model;

use serde::{Deserialize, Serialize};

use super::DiscState;
use super::series::{CurvePoint, Series, average, split};
use crate::{Determined, Estimate, FitError};

pub use fit::{ConsolidationFit, ErrorSource, Method, RelationCheck};
pub use model::{PaperFit, inverse_phi};

/// How the stages are chosen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ConsolidationOptions {
    /// Range of P* of the straight part; by default where 1/Φ has made 10 to 65 % of its way.
    pub straight: Option<[f64; 2]>,
    /// P* from which (8) holds; by default where 1/Φ has made 85 % of its way.
    pub tail: Option<f64>,
    /// Reference pressure P*0, a free choice that changes Φ0 alone; by default the lower end of the straight part.
    pub p_star_0: Option<f64>,
    /// Use states that did not meet all equilibrium criteria.
    pub include_unconverged: bool,
}

/// The curve of one kind of sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ConsolidationCurve {
    /// Assembling procedure.
    pub assembly: String,
    /// Rolling friction μ_R/a [1].
    pub mu_r: f64,
    /// Remaining scene keys.
    pub variant: String,
    /// Number of samples.
    pub samples: usize,
    /// Φ on first loading [1].
    pub phi: Vec<CurvePoint>,
    /// 1/Φ on first loading [1].
    pub inverse_phi: Vec<CurvePoint>,
    /// Φ on unloading [1].
    pub unloading: Vec<CurvePoint>,
    /// Coordination number on first loading [1].
    pub z: Vec<CurvePoint>,
    /// Φ at the lowest and at the highest pressure of loading [1].
    pub ends: Option<[Estimate; 2]>,
    /// The fit.
    pub fit: Determined<ConsolidationFit>,
    /// Table III of the paper for this μ_R, where it has one.
    pub paper: Option<PaperFit>,
    /// Root mean square distance of Φ from the paper's own curve for P* ≥ 0.05 [1].
    pub rms_to_paper: Option<f64>,
}

/// Consolidation curves of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Consolidation {
    /// One per assembling procedure, μ_R and remaining keys.
    pub curves: Vec<ConsolidationCurve>,
    /// States left out because they had not converged.
    pub unconverged: usize,
}

/// Averages and fits the consolidation curves of a sweep.
///
/// # Errors
/// [`FitError::TooFew`] without a single state under pressure.
pub fn consolidation(
    states: &[DiscState],
    options: &ConsolidationOptions,
) -> Result<Consolidation, FitError> {
    let usable: Vec<DiscState> =
        states.iter().filter(|state| options.include_unconverged || state.converged).cloned().collect();
    if !usable.iter().any(DiscState::is_loading) {
        return Err(FitError::too_few("consolidation", "states under pressure", 1, 0));
    }
    let curves = split(&usable).iter().map(|series| curve(series, options)).collect();
    Ok(Consolidation { curves, unconverged: states.len() - usable.len() })
}

fn curve(series: &Series<'_>, options: &ConsolidationOptions) -> ConsolidationCurve {
    let states = &series.states;
    let phi = average(states, DiscState::is_loading, |state| Some(state.phi));
    let inverse = average(states, DiscState::is_loading, |state| Some(1.0 / state.phi));
    let mut seeds: Vec<u64> = states.iter().map(|state| state.seed).collect();
    seeds.sort_unstable();
    seeds.dedup();
    let paper = PaperFit::of(series.mu_r).filter(|_| series.assembly == "type2");
    let distance = |paper: &PaperFit| {
        let squares: Vec<f64> = phi
            .iter()
            .filter(|point| point.p_star >= 0.05)
            .map(|point| (point.mean.value - 1.0 / paper.inverse_phi(point.p_star)).powi(2))
            .collect();
        (!squares.is_empty())
            .then(|| (squares.iter().sum::<f64>() / crate::point::count(squares.len())).sqrt())
    };
    ConsolidationCurve {
        assembly: series.assembly.clone(),
        mu_r: series.mu_r,
        variant: series.variant.clone(),
        samples: seeds.len(),
        unloading: average(states, |state| state.branch == "unloading", |state| Some(state.phi)),
        z: average(states, DiscState::is_loading, |state| state.z),
        ends: phi.first().zip(phi.last()).map(|(first, last)| [first.mean, last.mean]),
        fit: fit::fit(states, &seeds, options).into(),
        rms_to_paper: paper.as_ref().and_then(distance),
        paper,
        inverse_phi: inverse,
        phi,
    }
}

#[cfg(test)]
mod tests;
