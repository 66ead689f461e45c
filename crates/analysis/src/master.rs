//! The master curve (30)/(31).
//!
//! s = (1 − e_r)/e_r = 1/(a x^α + b x^β) with x = η*/0.045, fitted for the four numbers the data
//! determine: ln a, α, ln b, β. The paper's A and s_m depend on the η*_m one quotes them at:
//! A = a (η*_m/0.045)^α, 1/s_m − A = b (η*_m/0.045)^β.
//!
//! The residual is that of e_r = 1/(1 + s), divided by its standard deviation. To first order in the noise this is the
//! log–log fit of s with the weights that the noise of e gives to ln s, e_r(1 − e_r)/σ. Beyond first order it is the
//! better one: the noise is in e; ln s of a point near an end is skewed, and beyond the end there is none, so that a
//! log–log fit has to leave out points by their own noise.

use serde::{Deserialize, Serialize};

use crate::fit::{Datum, Sigma, least_squares};
use crate::{Collapse, Estimate, Fit, FitError};

/// The paper's crossover η*_m [1].
pub const ETA_STAR_M: f64 = 0.045;

const WHAT: &str = "master curve (30)";
const NAMES: [&str; 4] = ["ln_a", "alpha", "ln_b", "beta"];

/// The four numbers of (30), at x = η*/0.045.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct MasterCurve {
    /// Prefactor of the dense regime: the paper's A at η*_m = 0.045 [1].
    pub a: f64,
    /// Exponent α of the dense regime [1].
    pub alpha: f64,
    /// Prefactor of the loose regime: the paper's 1/s_m − A at η*_m = 0.045 [1].
    pub b: f64,
    /// Exponent β of the loose regime [1].
    pub beta: f64,
}

impl MasterCurve {
    /// The paper's fit: A = 0.475, α = 0.74, s_m = 1.55, β = 2.3, η*_m = 0.045.
    pub const PAPER: Self = Self { a: 0.475, alpha: 0.74, b: 1.0 / 1.55 - 0.475, beta: 2.3 };

    /// 1/s = a x^α + b x^β.
    #[must_use]
    pub fn inverse_s(&self, eta_star: f64) -> f64 {
        let x = eta_star / ETA_STAR_M;
        self.a * x.powf(self.alpha) + self.b * x.powf(self.beta)
    }

    /// Relative void ratio e_r (31).
    #[must_use]
    pub fn e_r(&self, eta_star: f64) -> f64 {
        let inverse = self.inverse_s(eta_star);
        if inverse.is_infinite() { 1.0 } else { inverse / (1.0 + inverse) }
    }

    fn of_theta(theta: &[f64]) -> Self {
        Self { a: theta[0].exp(), alpha: theta[1], b: theta[2].exp(), beta: theta[3] }
    }

    pub(crate) fn theta(self) -> [f64; 4] {
        [self.a.ln(), self.alpha, self.b.ln(), self.beta]
    }
}

/// A and s_m at one choice of η*_m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Quoted {
    /// η*_m they are quoted at [1].
    pub eta_star_m: Estimate,
    /// A [1].
    pub a: Estimate,
    /// s_m [1].
    pub s_m: Estimate,
}

/// One sample of the fitted curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CurveSample {
    /// η* [1].
    pub eta_star: f64,
    /// Relative void ratio of the fit [1].
    pub e_r: f64,
    /// s = (1 − e_r)/e_r of the fit [1].
    pub s: f64,
    /// Relative void ratio of the paper's fit [1].
    pub e_r_paper: f64,
}

/// The fitted master curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct MasterFit {
    /// The curve.
    pub curve: MasterCurve,
    /// The fit: parameters ln_a, alpha, ln_b, beta; abscissa η*, ordinate e_r. The covariance holds the
    /// scatter of the points and the uncertainty of e_min and of every plateau.
    pub fit: Fit,
    /// Prefactor of the dense regime at η* = 0.045 [1].
    pub a: Estimate,
    /// α [1].
    pub alpha: Estimate,
    /// Prefactor of the loose regime at η* = 0.045 [1].
    pub b: Estimate,
    /// β [1].
    pub beta: Estimate,
    /// A and s_m at the paper's η*_m = 0.045.
    pub at_paper: Quoted,
    /// A and s_m at the crossover of the two asymptotes, where a x^α = b x^β.
    pub at_crossover: Quoted,
    /// Standard deviation of e_r of a point of weight one, from replicates or from the residuals [1].
    pub e_r_sigma: f64,
    /// The curve, sampled over the range of the data.
    pub samples: Vec<CurveSample>,
}

/// One point for the fit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MasterPoint {
    pub eta_star: f64,
    pub e_r: f64,
    /// Standard deviation of e_r, or its relative size.
    pub sigma: f64,
}

pub(crate) struct Core {
    pub fit: Fit,
    pub curve: MasterCurve,
    /// Standard deviation of e_r of a point of weight one.
    pub sigma: f64,
}

/// Least squares of e_r. Without replicates σ is the common scatter, found from the residuals.
pub(crate) fn fit_points(
    points: &[MasterPoint],
    known: Sigma,
    start: Option<MasterCurve>,
) -> Result<Core, FitError> {
    let data: Vec<Datum> = points
        .iter()
        .filter(|point| point.eta_star > 0.0)
        .map(|point| Datum { x: point.eta_star, y: point.e_r, sigma: point.sigma })
        .collect();
    let attempt = |from: MasterCurve| least_squares(WHAT, &data, &NAMES, &from.theta(), known, e_r_theta);
    let mut result = attempt(start.unwrap_or(MasterCurve::PAPER));
    if start.is_none() && result.is_err() {
        for (alpha, beta) in [(0.5, 1.5), (1.0, 3.0), (0.9, 1.8)] {
            let other = attempt(MasterCurve { a: 0.5, alpha, b: 0.2, beta });
            if other.is_ok() {
                result = other;
                break;
            }
        }
    }
    let mut fit = result?;
    let curve = MasterCurve::of_theta(&fit.values());
    if curve.alpha > curve.beta {
        // the two terms have changed places: α is the exponent of the dense regime, hence the smaller one
        fit = attempt(MasterCurve { a: curve.b, alpha: curve.beta, b: curve.a, beta: curve.alpha })?;
    }
    for (name, other) in [("alpha", 1), ("beta", 3)] {
        let estimate = fit.parameters[other].estimate;
        if !estimate.se.is_finite() || estimate.ci95[0] <= 0.0 {
            return Err(FitError::underdetermined(
                WHAT,
                format!(
                    "{name} = {:.3} ± {:.3} may be zero: the data do not reach both regimes",
                    estimate.value, estimate.se
                ),
            ));
        }
    }
    let curve = MasterCurve::of_theta(&fit.values());
    let sigma = match known {
        Sigma::Absolute => 1.0,
        Sigma::Relative => fit.reduced_chi2.sqrt(),
    };
    Ok(Core { fit, curve, sigma })
}

fn ln_s(eta_star: f64, theta: &[f64]) -> f64 {
    // ln(e^u + e^v) without overflow
    let l = (eta_star / ETA_STAR_M).ln();
    let (u, v) = (theta[0] + theta[1] * l, theta[2] + theta[3] * l);
    let top = u.max(v);
    -(top + ((u - top).exp() + (v - top).exp()).ln())
}

/// e_r (31) at θ = (ln a, α, ln b, β).
pub(crate) fn e_r_theta(eta_star: f64, theta: &[f64]) -> f64 {
    MasterCurve::of_theta(theta).e_r(eta_star)
}

/// Fits (30) to a collapse.
///
/// # Errors
/// [`FitError`] when fewer than five usable points are left, when they do not reach both regimes, or when the
/// iteration does not converge.
pub fn fit(collapse: &Collapse) -> Result<MasterFit, FitError> {
    let (points, known) = collapse.master_points(0.0, None);
    let core = fit_points(&points, known, None)?;
    let covariance =
        collapse.joint(&core).map_or_else(|| with_levels(collapse, &core, known), |joint| joint.curve);
    let fit = core.fit.with_covariance(covariance);
    let curve = core.curve;
    let crossover = |t: &[f64]| ((t[0] - t[2]) / (t[3] - t[1])).exp() * ETA_STAR_M;
    let a_at = |t: &[f64], eta: f64| (t[0] + t[1] * (eta / ETA_STAR_M).ln()).exp();
    let s_at = |t: &[f64], eta: f64| ln_s(eta, t).exp();
    let at_paper = Quoted {
        eta_star_m: Estimate { value: ETA_STAR_M, se: 0.0, ci95: [ETA_STAR_M; 2] },
        a: fit.derived(|t| a_at(t, ETA_STAR_M).ln()).exp(),
        s_m: fit.derived(|t| s_at(t, ETA_STAR_M).ln()).exp(),
    };
    let at_crossover = Quoted {
        eta_star_m: fit.derived(|t| crossover(t).ln()).exp(),
        a: fit.derived(|t| a_at(t, crossover(t)).ln()).exp(),
        s_m: fit.derived(|t| s_at(t, crossover(t)).ln()).exp(),
    };
    let estimate = |name: &str| fit.parameter(name).expect("one of NAMES");
    Ok(MasterFit {
        a: estimate("ln_a").exp(),
        alpha: estimate("alpha"),
        b: estimate("ln_b").exp(),
        beta: estimate("beta"),
        at_paper,
        at_crossover,
        e_r_sigma: match known {
            // weights are 1/(e_max − e_min): back to a point of a typical span
            Sigma::Relative => {
                core.sigma * crate::estimate::median(&points.iter().map(|p| p.sigma).collect::<Vec<_>>())
            }
            Sigma::Absolute => crate::estimate::median(&points.iter().map(|p| p.sigma).collect::<Vec<_>>()),
        },
        samples: samples(&points, curve),
        curve,
        fit,
    })
}

/// Where the joint covariance cannot be had (the other reading of e_max, few points): adds to the covariance of the
/// scatter what e_min and the plateaus contribute: each is moved by its standard
/// error, the fit repeated, and the outer product of the shift added.
fn with_levels(collapse: &Collapse, core: &Core, known: Sigma) -> Vec<Vec<f64>> {
    let mut covariance = core.fit.covariance.clone();
    let base = core.fit.values();
    let mut add = |points: Vec<MasterPoint>| {
        let Ok(moved) = fit_points(&points, known, Some(core.curve)) else { return };
        let shift: Vec<f64> = moved.fit.values().iter().zip(&base).map(|(x, y)| x - y).collect();
        for (row, a) in covariance.iter_mut().zip(&shift) {
            for (element, b) in row.iter_mut().zip(&shift) {
                *element += a * b;
            }
        }
    };
    add(collapse.master_points(collapse.e_min.estimate.se, None).0);
    for (k, plateau) in collapse.plateaus.iter().enumerate() {
        if plateau.e_max.se > 0.0 {
            add(collapse.master_points(0.0, Some((k, plateau.e_max.se))).0);
        }
    }
    covariance
}

fn samples(points: &[MasterPoint], curve: MasterCurve) -> Vec<CurveSample> {
    let positive = points.iter().map(|point| point.eta_star).filter(|eta| *eta > 0.0);
    let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(l, h), eta| (l.min(eta), h.max(eta)));
    (0..=200)
        .map(|i| {
            let eta_star = low * (high / low).powf(f64::from(i) / 200.0);
            CurveSample {
                eta_star,
                e_r: curve.e_r(eta_star),
                s: 1.0 / curve.inverse_s(eta_star),
                e_r_paper: MasterCurve::PAPER.e_r(eta_star),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests;
