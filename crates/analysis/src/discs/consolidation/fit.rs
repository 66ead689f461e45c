//! The staged fit and its errors.

use serde::{Deserialize, Serialize};

use super::ConsolidationOptions;
use super::model::{bend, inverse_phi};
use crate::discs::DiscState;
use crate::discs::series::average;
use crate::fit::{Datum, Sigma, least_squares};
use crate::point::count;
use crate::{Determined, Estimate, Fit, FitError};

const WHAT: &str = "consolidation curve (9)";

/// Where the intervals come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ErrorSource {
    /// Jackknife over whole samples (four or more): holds the correlation along the curve of a sample.
    Samples,
    /// Scatter of the points about the curve, taken as independent: a lower bound, for a sample that is too loose at
    /// one pressure is so at the next.
    Points,
}

/// Which form of ln(P*1/P*0) = (1/Φ0 − 1/Φmax)/λ the data support.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct RelationCheck {
    /// Φmax from the tail (8) alone [1].
    pub phi_max_tail: f64,
    /// Φmax from P*1 by the relation with λ [1].
    pub phi_max_with_lambda: f64,
    /// Φmax from P*1 by the relation as printed, without λ [1]; negative where it makes no sense.
    pub phi_max_as_printed: f64,
    /// Whether the relation with λ is the nearer one.
    pub with_lambda: bool,
}

/// The parameters of (9).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ConsolidationFit {
    /// Reference pressure P*0 [1].
    pub p_star_0: f64,
    /// Φ0 at P*0 [1].
    pub phi_0: Estimate,
    /// λ [1].
    pub lambda: Estimate,
    /// Φmax [1].
    pub phi_max: Estimate,
    /// α [1].
    pub alpha: Estimate,
    /// P*1 [1].
    pub p_star_1: Estimate,
    /// A = λ P*1^α/(2α) of (8) [1].
    pub a: Estimate,
    /// Where the intervals come from.
    pub errors: ErrorSource,
    /// Range of P* of the straight part.
    pub straight: [f64; 2],
    /// P* from which the tail was fitted.
    pub tail_from: f64,
    /// Fit of (7) to the straight part, freed from its bend: parameters inverse_phi_0, lambda; abscissa ln(P*/P*0).
    pub line: Fit,
    /// Fit of (8) to the tail alone: parameters inverse_phi_max, a, alpha; abscissa P*.
    pub tail: Determined<Fit>,
    /// Fit of (9) above regime I with λ and Φ0 held: parameters alpha, ln_p_star_1; abscissa P*.
    pub join: Fit,
    /// The relation between P*1 and Φmax, with and without λ.
    pub relation: Determined<RelationCheck>,
}

struct Windows {
    straight: [f64; 2],
    tail: f64,
    p_star_0: f64,
}

/// (λ, 1/Φ0, α, ln P*1).
type Theta = [f64; 4];

struct Stages {
    theta: Theta,
    line: Fit,
    join: Fit,
}

pub(super) fn fit(
    states: &[&DiscState],
    seeds: &[u64],
    options: &ConsolidationOptions,
) -> Result<ConsolidationFit, FitError> {
    let data = averaged(states, |_| true);
    let windows = windows(&data, options)?;
    let stages = stages(&data, &windows, None)?;
    let (errors, spread, dof) = if seeds.len() >= 4 {
        (ErrorSource::Samples, jackknife(states, seeds, &windows)?, count(seeds.len()) - 1.0)
    } else {
        let dof = count(stages.join.points) - 4.0;
        (ErrorSource::Points, by_points(&data, &windows, &stages), dof.max(1.0))
    };
    let estimate = |get: &dyn Fn(&Theta) -> f64| {
        let value = get(&stages.theta);
        let variance: f64 = spread.iter().map(|theta| (get(theta) - value).powi(2)).sum();
        Estimate::symmetric(value, variance.sqrt(), dof)
    };
    let tail_data: Vec<Datum> = data.iter().copied().filter(|d| d.x >= windows.tail * 0.999).collect();
    let tail = tail_fit(&tail_data, &stages.theta);
    let p_star_0 = windows.p_star_0;
    let relation = tail.as_ref().map_err(Clone::clone).map(|tail| check(tail, &stages.theta, p_star_0));
    Ok(ConsolidationFit {
        p_star_0,
        phi_0: estimate(&|t| 1.0 / t[1]),
        lambda: estimate(&|t| t[0]),
        phi_max: estimate(&|t| 1.0 / inverse_phi_max(t, p_star_0)),
        alpha: estimate(&|t| t[2]),
        p_star_1: estimate(&|t| t[3]).exp(),
        a: estimate(&|t| (t[0] / (2.0 * t[2])).ln() + t[2] * t[3]).exp(),
        errors,
        straight: windows.straight,
        tail_from: windows.tail,
        line: stages.line,
        tail: tail.into(),
        join: stages.join,
        relation: relation.into(),
    })
}

/// 1/Φmax = 1/Φ0 − λ ln(P*1/P*0).
fn inverse_phi_max(theta: &Theta, p_star_0: f64) -> f64 {
    theta[1] - theta[0] * (theta[3] - p_star_0.ln())
}

/// 1/Φ averaged over the samples to keep; sigma from their scatter, pooled over the curve, or 1.
fn averaged(states: &[&DiscState], keep: impl Fn(u64) -> bool) -> Vec<Datum> {
    let points =
        average(states, |state| state.is_loading() && keep(state.seed), |state| Some(1.0 / state.phi));
    let (squares, dof) = points.iter().fold((0.0, 0.0), |(squares, dof), point| {
        let own = point.scatter.unwrap_or(0.0).powi(2) * (count(point.samples) - 1.0);
        (squares + own, dof + count(point.samples) - 1.0)
    });
    let pooled = if dof > 0.0 && squares > 0.0 { (squares / dof).sqrt() } else { 1.0 };
    points
        .iter()
        .map(|point| Datum {
            x: point.p_star,
            y: point.mean.value,
            sigma: pooled / count(point.samples).sqrt(),
        })
        .collect()
}

fn windows(data: &[Datum], options: &ConsolidationOptions) -> Result<Windows, FitError> {
    if data.len() < 10 {
        return Err(FitError::too_few(WHAT, "pressures", 10, data.len()));
    }
    let (first, last) = (data[0].y, data[data.len() - 1].y);
    let way = |d: &Datum| (first - d.y) / (first - last);
    let begin = data.iter().position(|d| way(d) >= 0.10).unwrap_or(0);
    let end = data.iter().rposition(|d| way(d) <= 0.65).unwrap_or(0);
    let automatic = [data[begin].x, data[end].x];
    let straight = options.straight.unwrap_or(automatic);
    let tail = options.tail.unwrap_or_else(|| {
        let found = data.iter().skip(end).find(|d| way(d) >= 0.85);
        found.map_or(f64::INFINITY, |d| d.x)
    });
    Ok(Windows { straight, tail, p_star_0: options.p_star_0.unwrap_or(straight[0]) })
}

/// The stages, repeated until they agree; `start` saves rounds when the answer is nearly known.
fn stages(data: &[Datum], windows: &Windows, start: Option<Theta>) -> Result<Stages, FitError> {
    let [low, high] = windows.straight;
    let inside = |d: &&Datum| d.x >= low * 0.999 && d.x <= high * 1.001;
    let straight: Vec<Datum> = data.iter().filter(inside).copied().collect();
    let above: Vec<Datum> = data.iter().copied().filter(|d| d.x >= low * 0.999).collect();
    let tail: Vec<Datum> = data.iter().copied().filter(|d| d.x >= windows.tail * 0.999).collect();
    if straight.len() < 4 {
        return Err(FitError::too_few(WHAT, "pressures on the straight part", 4, straight.len()));
    }
    if tail.len() < 4 {
        return Err(FitError::too_few(WHAT, "pressures on the tail", 4, tail.len()));
    }
    let p_star_0 = windows.p_star_0;
    let mut theta: Theta = start.unwrap_or([0.0, 0.0, 1.0, f64::INFINITY]);
    for _ in 0..60 {
        let bent = |d: &Datum| {
            if theta[3].is_finite() { theta[0] * bend(d.x, theta[2], theta[3].exp()) } else { 0.0 }
        };
        let freed: Vec<Datum> = straight
            .iter()
            .map(|d| Datum { x: (d.x / p_star_0).ln(), y: d.y - bent(d), sigma: d.sigma })
            .collect();
        let start = [freed[0].y, 0.2];
        let line =
            least_squares(WHAT, &freed, &["inverse_phi_0", "lambda"], &start, Sigma::Relative, |x, t| {
                t[0] - t[1] * x
            })?;
        let (inverse_phi_0, lambda) = (line.values()[0], line.values()[1]);
        if lambda <= 0.0 {
            return Err(FitError::underdetermined(
                WHAT,
                format!("λ = {lambda:.3}: the curve does not consolidate"),
            ));
        }
        let densest = tail.iter().map(|d| d.y).fold(f64::INFINITY, f64::min);
        let crossing = ((inverse_phi_0 - densest) / lambda + p_star_0.ln()).exp();
        let start = if theta[3].is_finite() { [theta[2], theta[3]] } else { [1.0, crossing.ln()] };
        let join =
            least_squares(WHAT, &above, &["alpha", "ln_p_star_1"], &start, Sigma::Relative, |p, t| {
                if t[0] <= 0.0 {
                    return f64::NAN;
                }
                inverse_phi(p, p_star_0, 1.0 / inverse_phi_0, lambda, t[0], t[1].exp())
            })?;
        let next: Theta = [lambda, inverse_phi_0, join.values()[0], join.values()[1]];
        let moved = next.iter().zip(&theta).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        theta = next;
        if moved < 1e-7 {
            return Ok(Stages { theta, line, join });
        }
    }
    Err(FitError::not_converged(WHAT, "the straight part and the tail do not settle on one curve"))
}

/// Shifts of θ whose outer products sum to the jackknife covariance: √((n−1)/n) (θ_(i) − θ̄), about the estimate.
fn jackknife(states: &[&DiscState], seeds: &[u64], windows: &Windows) -> Result<Vec<Theta>, FitError> {
    let base = stages(&averaged(states, |_| true), windows, None)?.theta;
    let left_out = seeds
        .iter()
        .map(|&out| Ok(stages(&averaged(states, |seed| seed != out), windows, Some(base))?.theta))
        .collect::<Result<Vec<Theta>, FitError>>()?;
    let n = count(left_out.len());
    let mean: Theta = std::array::from_fn(|k| left_out.iter().map(|theta| theta[k]).sum::<f64>() / n);
    let factor = ((n - 1.0) / n).sqrt();
    Ok(left_out
        .iter()
        .map(|theta| std::array::from_fn(|k| base[k] + factor * (theta[k] - mean[k])))
        .collect())
}

/// Shifts of θ from moving each point by its standard deviation (by linear response).
fn by_points(data: &[Datum], windows: &Windows, stages_found: &Stages) -> Vec<Theta> {
    const PART: f64 = 0.3;
    let scale = stages_found.join.reduced_chi2.sqrt();
    let base = stages_found.theta;
    (0..data.len())
        .filter_map(|i| {
            let mut moved = data.to_vec();
            moved[i].y += PART * scale * moved[i].sigma;
            let theta = stages(&moved, windows, Some(base)).ok()?.theta;
            Some(std::array::from_fn(|k| base[k] + (theta[k] - base[k]) / PART))
        })
        .collect()
}

fn tail_fit(tail: &[Datum], theta: &Theta) -> Result<Fit, FitError> {
    let a = theta[0] / (2.0 * theta[2]) * (theta[2] * theta[3]).exp();
    let densest = tail.iter().map(|d| d.y).fold(f64::INFINITY, f64::min);
    let names = ["inverse_phi_max", "a", "alpha"];
    least_squares("tail (8)", tail, &names, &[densest, a, theta[2]], Sigma::Relative, |p, t| {
        t[0] + t[1] * p.powf(-t[2])
    })
}

fn check(tail: &Fit, theta: &Theta, p_star_0: f64) -> RelationCheck {
    let phi_max_tail = 1.0 / tail.values()[0];
    let phi_max_with_lambda = 1.0 / inverse_phi_max(theta, p_star_0);
    let phi_max_as_printed = 1.0 / (theta[1] - (theta[3] - p_star_0.ln()));
    RelationCheck {
        phi_max_tail,
        phi_max_with_lambda,
        phi_max_as_printed,
        with_lambda: (phi_max_with_lambda - phi_max_tail).abs() < (phi_max_as_printed - phi_max_tail).abs(),
    }
}
