//! The plateau of the void ratio against pressure, eqs. (15) and (16).

use serde::{Deserialize, Serialize};

use crate::fit::{Datum, Sigma, least_squares};
use crate::point::count;
use crate::{Determined, Estimate, Fit, FitError};

const WHAT: &str = "plateau (15)";

/// Reference pressure at which the paper has Δe = 1, 0.01 MPa [Pa].
pub const P0: f64 = 1.0e4;

/// e_max(p) = e_min + Δe/(1 + C Δe ln(p/p_Δ)) (15).
///
/// # Errors
/// [`FitError::OutOfRange`] where the denominator is not positive: below p0 exp(−1/C), with p0 from (16).
pub fn e_max(p: f64, e_min: f64, delta_e: f64, c: f64, p_delta: f64) -> Result<f64, FitError> {
    let denominator = 1.0 + c * delta_e * (p / p_delta).ln();
    if p > 0.0 && denominator > 0.0 {
        Ok(e_min + delta_e / denominator)
    } else {
        let limit = p_delta * (-1.0 / (c * delta_e)).exp();
        Err(FitError::out_of_range(WHAT, format!("p = {p:.4e} Pa, the formula diverges at {limit:.4e} Pa")))
    }
}

/// Δe = 1/(1 + C ln(p_Δ/p0)) (16).
#[must_use]
pub fn delta_e(c: f64, p_delta: f64, p0: f64) -> f64 {
    1.0 / (1.0 + c * (p_delta / p0).ln())
}

/// The plateau of one pressure, as read from runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Level {
    /// p, or p_crit in the other reading [Pa].
    pub p: f64,
    /// e_max with its standard error [1].
    pub e_max: f64,
    pub se: f64,
}

/// The fitted plateau (15).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct PlateauFit {
    /// Reference pressure p_Δ [Pa]; a free choice that changes Δe but neither C nor any prediction.
    pub p_delta: f64,
    /// e_min used [1].
    pub e_min: f64,
    /// Δe at p_Δ [1].
    pub delta_e: Estimate,
    /// C [1].
    pub c: Estimate,
    /// p0: the pressure where Δe = 1, from (16) [Pa]. The paper takes it as 0.01 MPa. Undetermined where the interval
    /// of C reaches zero: without a slope the plateau comes to Δe = 1 nowhere.
    pub p0: Determined<Estimate>,
    /// The fit: parameters delta_e, c; abscissa p [Pa], ordinate e_max [1].
    pub fit: Fit,
}

impl PlateauFit {
    /// e_max at pressure p with its error.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`] where (15) diverges.
    pub fn predict(&self, p: f64) -> Result<Estimate, FitError> {
        e_max(p, self.e_min, self.delta_e.value, self.c.value, self.p_delta)?;
        let (e_min, p_delta) = (self.e_min, self.p_delta);
        Ok(self.fit.derived(|t| e_min + t[0] / (1.0 + t[1] * t[0] * (p / p_delta).ln())))
    }
}

/// Fits (15) for Δe and C at the chosen p_Δ.
///
/// # Errors
/// [`FitError`] with fewer than three levels or when the fit does not converge.
pub(crate) fn fit(levels: &[Level], e_min: f64, e_min_se: f64, p_delta: f64) -> Result<PlateauFit, FitError> {
    let known = levels.iter().all(|level| level.se > 0.0);
    let sigma = if known { Sigma::Absolute } else { Sigma::Relative };
    let run = |e_min: f64| {
        let data: Vec<Datum> = levels
            .iter()
            .map(|l| Datum { x: l.p, y: l.e_max, sigma: if known { l.se } else { 1.0 } })
            .collect();
        let start = start(levels, e_min, p_delta).unwrap_or([1.0, 0.24]);
        least_squares(WHAT, &data, &["delta_e", "c"], &start, sigma, |p, t| {
            let denominator = 1.0 + t[1] * t[0] * (p / p_delta).ln();
            if denominator > 0.0 { e_min + t[0] / denominator } else { f64::NAN }
        })
    };
    let base = run(e_min)?;
    let mut covariance = base.covariance.clone();
    if e_min_se > 0.0
        && let Ok(moved) = run(e_min + e_min_se)
    {
        let shift: Vec<f64> = moved.values().iter().zip(base.values()).map(|(x, y)| x - y).collect();
        for (row, a) in covariance.iter_mut().zip(&shift) {
            for (element, b) in row.iter_mut().zip(&shift) {
                *element += a * b;
            }
        }
    }
    let fit = base.with_covariance(covariance);
    let delta = fit.parameter("delta_e").expect("fitted");
    let c = fit.parameter("c").expect("fitted");
    if delta.value <= 0.0 {
        return Err(FitError::underdetermined(WHAT, format!("Δe = {:.3} is not positive", delta.value)));
    }
    let p0 = if c.ci95[0] <= 0.0 {
        let reason =
            format!("C = {:.3} ({:.3} … {:.3}) does not exclude zero", c.value, c.ci95[0], c.ci95[1]);
        Err(FitError::underdetermined(WHAT, reason))
    } else {
        // (16) solved for p0: ln(p0/p_Δ) = (1 − 1/Δe)/C; its interval is that of the logarithm
        let p0 = fit.derived(|t| (1.0 - 1.0 / t[0]) / t[1] + p_delta.ln()).exp();
        // with C barely above zero the end of the interval may be beyond every number
        if p0.ci95.iter().all(|end| end.is_finite()) {
            Ok(p0)
        } else {
            Err(FitError::underdetermined(WHAT, format!("the interval of p0 ends beyond {:e} Pa", f64::MAX)))
        }
    }
    .into();
    Ok(PlateauFit { p_delta, e_min, delta_e: delta, c, p0, fit })
}

/// The start: 1/(e_max − e_min) = 1/Δe + C ln(p/p_Δ) is a straight line in ln p.
fn start(levels: &[Level], e_min: f64, p_delta: f64) -> Option<[f64; 2]> {
    let usable: Vec<(f64, f64)> = levels
        .iter()
        .filter(|level| level.e_max > e_min)
        .map(|level| ((level.p / p_delta).ln(), 1.0 / (level.e_max - e_min)))
        .collect();
    let n = count(usable.len());
    let (mean_x, mean_y) =
        (usable.iter().map(|(x, _)| x).sum::<f64>() / n, usable.iter().map(|(_, y)| y).sum::<f64>() / n);
    let sxx: f64 = usable.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    let sxy: f64 = usable.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let c = sxy / sxx;
    let inverse = mean_y - c * mean_x;
    (c.is_finite() && inverse > 0.0).then(|| [1.0 / inverse, c])
}

#[cfg(test)]
mod tests;
