//! Elastic moduli of the consolidation states beside their Voigt and Reuss estimates.

use serde::{Deserialize, Serialize};

use super::DiscState;
use super::series::{CurvePoint, Series, average, split};
use crate::fit::{Datum, Sigma, least_squares};
use crate::{Determined, Estimate, FitError};

/// Moduli of one kind of sample against P*.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ModuliCurve {
    /// Assembling procedure.
    pub assembly: String,
    /// Rolling friction μ_R/a [1].
    pub mu_r: f64,
    /// Remaining scene keys.
    pub variant: String,
    /// Bulk modulus B on first loading [K_N].
    pub bulk: Vec<CurvePoint>,
    /// Shear modulus G [K_N].
    pub shear: Vec<CurvePoint>,
    /// Voigt estimate of B (12), an upper bound [K_N].
    pub bulk_voigt: Vec<CurvePoint>,
    /// Voigt estimate of G (12) [K_N].
    pub shear_voigt: Vec<CurvePoint>,
    /// Reuss estimate of B (14) [K_N].
    pub bulk_reuss: Vec<CurvePoint>,
    /// Voigt bound over B, state by state; the paper finds 30 … 50 at low P* [1].
    pub voigt_over_bulk: Vec<CurvePoint>,
    /// B over its Reuss estimate; the paper finds it within about 2 for P* ≥ 0.1 [1].
    pub bulk_over_reuss: Vec<CurvePoint>,
    /// States above their Voigt bound: must be none.
    pub above_voigt: usize,
    /// States whose smallest stiffness eigenvalue is not positive.
    pub unstable: usize,
    /// Exponent of B ∝ P*^x over the range of the data [1].
    pub bulk_exponent: Determined<Estimate>,
}

/// Moduli of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Moduli {
    /// One per assembling procedure, μ_R and remaining keys.
    pub curves: Vec<ModuliCurve>,
}

/// Moduli of the states on first loading.
///
/// # Errors
/// [`FitError::TooFew`] when no state has them.
pub fn moduli(states: &[DiscState]) -> Result<Moduli, FitError> {
    if !states.iter().any(|state| state.bulk.is_some()) {
        return Err(FitError::too_few("moduli", "states with bulk modulus", 1, 0));
    }
    Ok(Moduli { curves: split(states).iter().map(curve).collect() })
}

fn curve(series: &Series<'_>) -> ModuliCurve {
    let of = |get: fn(&DiscState) -> Option<f64>| {
        average(&series.states, |state| state.is_loading() && state.converged, get)
    };
    let bulk = of(|state| state.bulk);
    let loaded = || series.states.iter().filter(|state| state.is_loading());
    ModuliCurve {
        assembly: series.assembly.clone(),
        mu_r: series.mu_r,
        variant: series.variant.clone(),
        shear: of(|state| state.shear),
        bulk_voigt: of(|state| state.bulk_voigt),
        shear_voigt: of(|state| state.shear_voigt),
        bulk_reuss: of(|state| state.bulk_reuss),
        voigt_over_bulk: of(|state| Some(state.bulk_voigt? / state.bulk.filter(|bulk| *bulk > 0.0)?)),
        bulk_over_reuss: of(|state| Some(state.bulk? / state.bulk_reuss.filter(|reuss| *reuss > 0.0)?)),
        above_voigt: loaded()
            .filter(|state| {
                let above = |value: Option<f64>, bound: Option<f64>| {
                    value.zip(bound).is_some_and(|(value, bound)| value > bound * (1.0 + 1e-9))
                };
                above(state.bulk, state.bulk_voigt) || above(state.shear, state.shear_voigt)
            })
            .count(),
        unstable: loaded().filter(|state| state.stiffness_sign.is_some_and(|sign| sign <= 0.0)).count(),
        bulk_exponent: exponent(&bulk).into(),
        bulk,
    }
}

fn exponent(bulk: &[CurvePoint]) -> Result<Estimate, FitError> {
    let data: Vec<Datum> = bulk
        .iter()
        .filter(|point| point.mean.value > 0.0)
        .map(|point| Datum { x: point.p_star.ln(), y: point.mean.value.ln(), sigma: 1.0 })
        .collect();
    let fit =
        least_squares("exponent of B(P*)", &data, &["ln_b", "x"], &[0.0, 0.3], Sigma::Relative, |x, t| {
            t[0] + t[1] * x
        })?;
    Ok(fit.parameter("x").expect("fitted"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(p_star: f64, seed: u64, bulk: f64) -> DiscState {
        DiscState {
            seed,
            p_star,
            phi: 0.6,
            branch: "compression".to_owned(),
            bulk: Some(bulk),
            shear: Some(0.5 * bulk),
            bulk_voigt: Some(0.5),
            shear_voigt: Some(0.3),
            bulk_reuss: Some(0.8 * bulk),
            stiffness_sign: Some(1.0),
            converged: true,
            ..DiscState::default()
        }
    }

    #[test]
    fn ratios_bounds_and_exponent() {
        let states: Vec<DiscState> = (0..8)
            .map(|i| 0.01 * 2.0_f64.powi(i))
            .flat_map(|p| [state(p, 1, 0.1 * p.powf(0.4)), state(p, 2, 0.1 * p.powf(0.4))])
            .collect();
        let found = moduli(&states).unwrap();
        let curve = &found.curves[0];
        assert_eq!(
            (curve.bulk.len(), curve.bulk[0].samples, curve.above_voigt, curve.unstable),
            (8, 2, 0, 0)
        );
        assert!((curve.bulk_exponent.value().unwrap().value - 0.4).abs() < 1e-9);
        assert!((curve.bulk_over_reuss[3].mean.value - 1.25).abs() < 1e-12);
        let mut broken = states;
        broken[0].bulk = Some(0.6);
        broken[1].stiffness_sign = Some(-1.0);
        let curve = &moduli(&broken).unwrap().curves[0];
        assert_eq!((curve.above_voigt, curve.unstable), (1, 1));
        assert!(moduli(&[DiscState::default()]).is_err());
    }
}
