//! The exponents of the scaling variable (σc/p)(p/σe)^b (m_w/m)^c α_n^q, eqs. (11) and (28), as the data have them.
//!
//! The exponents are those that put e_r on one smooth monotone curve: they minimise the collapse cost of
//! [`cost`](crate::cost). e_r is taken as collapsed with the levels of the standard reading; the runs they are read
//! from lie so deep in the plateau and in the dense limit that b moves none of them across.
//! Intervals are bootstrap percentiles over points.

mod search;

use serde::{Deserialize, Serialize};

use crate::collapse::{CollapsePoint, Role};
use crate::cost::{Scatter, Shape, residual_sum, scatter};
use crate::run::LARGEST_OVERLAP;
use crate::{Collapse, Determined, Estimate, FitError, resample};
use search::{Bounds, minimise};

const WHAT: &str = "scaling exponents";

/// How the exponents are found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ExponentOptions {
    /// Number of bootstrap resamples.
    pub resamples: u32,
    /// Seed of the resamples.
    pub seed: u64,
    /// Exponents are sought in this range [1].
    pub range: [f64; 2],
}

impl Default for ExponentOptions {
    fn default() -> Self {
        Self { resamples: 200, seed: 1, range: [-1.0, 2.0] }
    }
}

/// Cost against one exponent, the others at their best values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CostScan {
    /// `b`, `c` or `q`.
    pub exponent: String,
    /// Values of the exponent [1].
    pub values: Vec<f64>,
    /// Scatter of e_r about the smooth curve [1].
    pub cost: Vec<f64>,
}

/// The exponent of α_n within one regime of e_r.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct RegimeExponent {
    /// Name of the regime: `dense` or `loose`.
    pub regime: String,
    /// Range of e_r [1].
    pub e_r: [f64; 2],
    /// q in it, b and c fixed at their best values [1].
    pub q: Determined<Estimate>,
}

/// What the data say about the scaling variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Exponents {
    /// Exponent b of p/σe; the paper has 1/2 (13) [1].
    pub b: Determined<Estimate>,
    /// Exponent c of m_w/m; the paper has 0 [1].
    pub c: Determined<Estimate>,
    /// Exponent q of α_n; the paper has between 1/4 and 1, depending on the regime [1].
    pub q: Determined<Estimate>,
    /// q within the dense and the loose regime.
    pub q_by_regime: Vec<RegimeExponent>,
    /// Scatter at the best exponents.
    pub best: Scatter,
    /// Scatter with b = 1/2, c = 0, and q = 1/4 where α_n varies.
    pub paper: Scatter,
    /// Scatter against η = σc/p: b = c = 0 and the same q.
    pub eta: Scatter,
    /// Cost against each exponent that the data can tell.
    pub scans: Vec<CostScan>,
    /// Number of bootstrap resamples.
    pub resamples: u32,
}

/// Points as logarithms, so that u = v·exponents is linear in the exponents.
struct Cases {
    /// ln(σc/p), ln(p/σe), ln(m_w/96), ln(α_n/0.25).
    logs: Vec<[f64; 4]>,
    e_r: Vec<f64>,
}

impl Cases {
    fn of(points: &[&CollapsePoint]) -> Self {
        let logs = |p: &&CollapsePoint| {
            [(p.sigma_c / p.p).ln(), (p.p / p.sigma_e).ln(), (p.mw / 96.0).ln(), (p.alpha_n / 0.25).ln()]
        };
        Self { logs: points.iter().map(logs).collect(), e_r: points.iter().map(|p| p.e_r).collect() }
    }

    fn len(&self) -> usize {
        self.e_r.len()
    }

    fn u(&self, exponents: [f64; 3]) -> Vec<f64> {
        let [b, c, q] = exponents;
        self.logs.iter().map(|l| l[0] + b * l[1] + c * l[2] + q * l[3]).collect()
    }

    fn cost(&self, exponents: [f64; 3], weights: &[f64]) -> f64 {
        residual_sum(&self.u(exponents), &self.e_r, weights, Shape::Increasing).unwrap_or(f64::INFINITY)
    }

    fn scatter(&self, exponents: [f64; 3]) -> Result<Scatter, FitError> {
        scatter(WHAT, &self.u(exponents), &self.e_r, &vec![1.0; self.len()], Shape::Increasing)
    }

    /// Which of b, c, q have at least two values of their group in the data.
    fn active(&self) -> [bool; 3] {
        let varies = |k: usize| self.logs.iter().any(|logs| (logs[k] - self.logs[0][k]).abs() > 1e-9);
        [varies(1), varies(2), varies(3)]
    }
}

const NAMES: [&str; 3] = ["b", "c", "q"];
const GROUPS: [&str; 3] = ["p/sigma_e", "mw", "alpha_n"];

/// Finds b, c and q.
///
/// # Errors
/// [`FitError`] when there are too few points for a smooth curve.
pub fn exponents(collapse: &Collapse, options: &ExponentOptions) -> Result<Exponents, FitError> {
    let main_ei = collapse.points.iter().find(|point| point.role == Role::Fit).map(|point| point.ei);
    let usable: Vec<&CollapsePoint> = collapse
        .points
        .iter()
        .filter(|point| matches!(point.role, Role::Fit | Role::Variation))
        .filter(|point| Some(point.ei) == main_ei && point.sigma_c > 0.0)
        .filter(|point| {
            collapse.options.include_out_of_model || point.sigma_c / point.sigma_e <= LARGEST_OVERLAP
        })
        .collect();
    if usable.is_empty() {
        return Err(FitError::too_few(WHAT, "points", 8, 0));
    }
    let cases = Cases::of(&usable);
    let active = cases.active();
    let start = [0.5, 0.0, if active[2] { 0.25 } else { 0.0 }];
    let reference = cases.scatter(start)?;
    let eta = cases.scatter([0.0, 0.0, start[2]])?;
    let bounds = Bounds { low: options.range[0], high: options.range[1] };
    let uniform = vec![1.0; cases.len()];
    let best = minimise(&|x| cases.cost(x, &uniform), start, active, bounds, None);
    let resamples: Vec<[f64; 3]> = (0..options.resamples)
        .map(|round| {
            let weights = resample::weights(cases.len(), options.seed, u64::from(round));
            minimise(&|x| cases.cost(x, &weights), best, active, bounds, Some(0.35))
        })
        .collect();
    let best_scatter = cases.scatter(best)?;
    let estimate = |k: usize| -> Result<Estimate, FitError> {
        if !active[k] {
            return Err(FitError::too_few(NAMES[k], &format!("values of {}", GROUPS[k]), 2, 1));
        }
        if best[k] <= bounds.low + 1e-3 || best[k] >= bounds.high - 1e-3 {
            return Err(FitError::underdetermined(
                NAMES[k],
                format!("the collapse cost has no minimum within [{}, {}]", bounds.low, bounds.high),
            ));
        }
        let values: Vec<f64> = resamples.iter().map(|r| r[k]).collect();
        Ok(resample::estimate(best[k], &values, cases.len(), best_scatter.coefficients))
    };
    let scans = (0..3).filter(|&k| active[k]).map(|k| scan(&cases, best, k, bounds)).collect();
    let regimes = if active[2] { regimes(&usable, best, options, bounds) } else { Vec::new() };
    Ok(Exponents {
        b: estimate(0).into(),
        c: estimate(1).into(),
        q: estimate(2).into(),
        q_by_regime: regimes,
        best: best_scatter,
        paper: reference,
        eta,
        scans,
        resamples: options.resamples,
    })
}

fn scan(cases: &Cases, best: [f64; 3], k: usize, bounds: Bounds) -> CostScan {
    let values: Vec<f64> =
        (0..=60).map(|i| bounds.low + (bounds.high - bounds.low) * f64::from(i) / 60.0).collect();
    let cost = values
        .iter()
        .map(|&value| {
            let mut at = best;
            at[k] = value;
            cases.scatter(at).map_or(f64::NAN, |scatter| scatter.rms)
        })
        .collect();
    CostScan { exponent: NAMES[k].to_owned(), values, cost }
}

/// q in the dense (e_r < 0.2) and the loose regime apart: the paper finds 1 in the first and 1/4 as a compromise.
fn regimes(
    points: &[&CollapsePoint],
    best: [f64; 3],
    options: &ExponentOptions,
    bounds: Bounds,
) -> Vec<RegimeExponent> {
    [("dense", [f64::NEG_INFINITY, 0.2]), ("loose", [0.2, f64::INFINITY])]
        .into_iter()
        .map(|(regime, e_r)| {
            let inside: Vec<&CollapsePoint> =
                points.iter().copied().filter(|point| point.e_r > e_r[0] && point.e_r <= e_r[1]).collect();
            RegimeExponent {
                regime: regime.to_owned(),
                e_r: [e_r[0].max(0.0), e_r[1].min(1.0)],
                q: regime_q(&Cases::of(&inside), best, options, bounds).into(),
            }
        })
        .collect()
}

fn regime_q(
    cases: &Cases,
    best: [f64; 3],
    options: &ExponentOptions,
    bounds: Bounds,
) -> Result<Estimate, FitError> {
    if cases.len() == 0 || !cases.active()[2] {
        return Err(FitError::too_few("q", "values of alpha_n in this regime", 2, cases.len().min(1)));
    }
    let scatter = cases.scatter(best)?;
    let only_q = [false, false, true];
    let uniform = vec![1.0; cases.len()];
    let found = minimise(&|x| cases.cost(x, &uniform), best, only_q, bounds, None);
    if found[2] <= bounds.low + 1e-3 || found[2] >= bounds.high - 1e-3 {
        return Err(FitError::underdetermined("q", "the collapse cost has no minimum in this regime"));
    }
    let values: Vec<f64> = (0..options.resamples)
        .map(|round| {
            let weights = resample::weights(cases.len(), options.seed, u64::from(round));
            minimise(&|x| cases.cost(x, &weights), found, only_q, bounds, Some(0.35))[2]
        })
        .collect();
    Ok(resample::estimate(found[2], &values, cases.len(), scatter.coefficients))
}

#[cfg(test)]
mod tests;
