//! The staged fit and its errors.

use nalgebra::{Matrix4, Vector4};
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

/// How the stages were joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The straight part is freed from the bend that α and P*1 imply, and all four agree.
    SelfConsistent,
    /// λ and Φ0 are those of the straight part as it is, α and P*1 those of (9) on everything above regime I, Φmax
    /// follows: where the stages cannot be made to agree (jumpy curves of few samples). λ is then low by the bend of the
    /// straight part. The tail alone would fix α an order of magnitude worse and miss the points between.
    Staged,
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
    /// How the stages were joined.
    pub method: Method,
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
    method: Method,
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
        (ErrorSource::Samples, jackknife(states, seeds, &windows, &stages)?, count(seeds.len()) - 1.0)
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
        method: stages.method,
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

/// λ and Φ0 from the straight part, Φmax and α from the tail, then joined so that they agree; `start` and `method` repeat
/// an earlier answer on slightly different data.
fn stages(data: &[Datum], windows: &Windows, earlier: Option<(Theta, Method)>) -> Result<Stages, FitError> {
    let [low, high] = windows.straight;
    let parts = Parts {
        straight: data.iter().filter(|d| d.x >= low * 0.999 && d.x <= high * 1.001).copied().collect(),
        above: data.iter().copied().filter(|d| d.x >= low * 0.999).collect(),
        tail: data.iter().copied().filter(|d| d.x >= windows.tail * 0.999).collect(),
        p_star_0: windows.p_star_0,
    };
    if parts.straight.len() < 4 {
        return Err(FitError::too_few(WHAT, "pressures on the straight part", 4, parts.straight.len()));
    }
    if parts.tail.len() < 4 {
        return Err(FitError::too_few(WHAT, "pressures on the tail", 4, parts.tail.len()));
    }
    let plain = parts.line(None)?;
    if plain.values()[1] <= 0.0 {
        let reason = format!("λ = {:.3}: the curve does not consolidate", plain.values()[1]);
        return Err(FitError::underdetermined(WHAT, reason));
    }
    if earlier.is_none_or(|(_, method)| method == Method::SelfConsistent) {
        let start = match earlier {
            Some((theta, _)) => Some(theta),
            None => parts
                .join(plain.values()[1], plain.values()[0])
                .ok()
                .map(|join| [plain.values()[1], plain.values()[0], join.values()[0], join.values()[1]]),
        };
        let found = start.and_then(|start| parts.agree(start));
        if let Some(theta) = found.filter(|theta| parts.credible(theta, plain.values()[1])) {
            let line = parts.line(Some(&theta))?;
            let join = parts.join(theta[0], theta[1])?;
            return Ok(Stages { theta, line, join, method: Method::SelfConsistent });
        }
    }
    let (lambda, inverse_phi_0) = (plain.values()[1], plain.values()[0]);
    let join = parts.join(lambda, inverse_phi_0)?;
    let theta: Theta = [lambda, inverse_phi_0, join.values()[0], join.values()[1]];
    Ok(Stages { theta, line: plain, join, method: Method::Staged })
}

struct Parts {
    straight: Vec<Datum>,
    above: Vec<Datum>,
    tail: Vec<Datum>,
    p_star_0: f64,
}

impl Parts {
    /// (7) on the straight part, freed from the bend that θ implies.
    fn line(&self, theta: Option<&Theta>) -> Result<Fit, FitError> {
        let bent = |d: &Datum| theta.map_or(0.0, |t| t[0] * bend(d.x, t[2], t[3].exp()));
        let freed: Vec<Datum> = self
            .straight
            .iter()
            .map(|d| Datum { x: (d.x / self.p_star_0).ln(), y: d.y - bent(d), sigma: d.sigma })
            .collect();
        let start = [freed[0].y, 0.2];
        least_squares(WHAT, &freed, &["inverse_phi_0", "lambda"], &start, Sigma::Relative, |x, t| {
            t[0] - t[1] * x
        })
    }

    /// (9) on everything above regime I with λ and Φ0 held.
    fn join(&self, lambda: f64, inverse_phi_0: f64) -> Result<Fit, FitError> {
        let densest = self.tail.iter().map(|d| d.y).fold(f64::INFINITY, f64::min);
        let start = [1.0, (inverse_phi_0 - densest) / lambda + self.p_star_0.ln()];
        let names = ["alpha", "ln_p_star_1"];
        least_squares(WHAT, &self.above, &names, &start, Sigma::Relative, |p, t| {
            if t[0] <= 0.0 {
                return f64::NAN;
            }
            self.curve(p, &[lambda, inverse_phi_0, t[0], t[1]])
        })
    }

    fn curve(&self, p: f64, theta: &Theta) -> f64 {
        inverse_phi(p, self.p_star_0, 1.0 / theta[1], theta[0], theta[2], theta[3].exp())
    }

    /// Newton's method for the θ at which line and join agree: the residuals of (9) are orthogonal to ∂/∂λ and ∂/∂(1/Φ0) on
    /// the straight part and to ∂/∂α and ∂/∂ln P*1 above regime I.
    fn agree(&self, start: Theta) -> Option<Theta> {
        let mut theta = start;
        let (mut side, mut matrix) = self.balance(&theta);
        for _ in 0..60 {
            let step = matrix.lu().solve(&side)?;
            let mut part = 1.0;
            let (next, balance) = loop {
                let trial: Theta = std::array::from_fn(|k| theta[k] + part * step[k]);
                let balance = self.balance(&trial);
                if trial[2] > 0.0 && balance.0.norm() < side.norm() {
                    break (trial, balance);
                }
                part *= 0.5;
                if part < 1e-6 {
                    // no progress left: either there, or stuck
                    return (step.amax() < 1e-6).then_some(theta);
                }
            };
            theta = next;
            (side, matrix) = balance;
            if part * step.amax() < 1e-10 {
                return Some(theta);
            }
        }
        None
    }

    /// The four sums that have to vanish, and minus their derivatives (without second derivatives of the curve).
    fn balance(&self, theta: &Theta) -> (Vector4<f64>, Matrix4<f64>) {
        let (mut side, mut matrix) = (Vector4::zeros(), Matrix4::zeros());
        let mut add = |data: &[Datum], rows: std::ops::Range<usize>| {
            for d in data {
                let slopes = self.slopes(d.x, theta);
                let weight = d.sigma.powi(-2);
                let residual = d.y - self.curve(d.x, theta);
                for i in rows.clone() {
                    side[i] += weight * slopes[i] * residual;
                    for j in 0..4 {
                        matrix[(i, j)] += weight * slopes[i] * slopes[j];
                    }
                }
            }
        };
        add(&self.straight, 0..2);
        add(&self.above, 2..4);
        (side, matrix)
    }

    fn slopes(&self, p: f64, theta: &Theta) -> Theta {
        const H: f64 = 1e-6;
        std::array::from_fn(|k| {
            let (mut above, mut below) = (*theta, *theta);
            above[k] += H;
            below[k] -= H;
            (self.curve(p, &above) - self.curve(p, &below)) / (2.0 * H)
        })
    }

    /// A free fit may run away along λ: the slope may exceed the plain one by what a bend explains, not more, and the
    /// crossover has to lie within the data.
    fn credible(&self, theta: &Theta, plain_lambda: f64) -> bool {
        let last = self.above[self.above.len() - 1].x;
        let p_star_1 = theta[3].exp();
        (0.7..1.6).contains(&(theta[0] / plain_lambda))
            && p_star_1 > self.p_star_0
            && p_star_1 < last
            && theta[2] < 5.0
    }
}

/// Shifts of θ whose outer products sum to the jackknife covariance: √((n−1)/n) (θ_(i) − θ̄), about the estimate.
fn jackknife(
    states: &[&DiscState],
    seeds: &[u64],
    windows: &Windows,
    found: &Stages,
) -> Result<Vec<Theta>, FitError> {
    let base = found.theta;
    let left_out = seeds
        .iter()
        .map(|&out| {
            Ok(stages(&averaged(states, |seed| seed != out), windows, Some((base, found.method)))?.theta)
        })
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
            let theta = stages(&moved, windows, Some((base, stages_found.method))).ok()?.theta;
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
