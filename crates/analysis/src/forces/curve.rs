//! β± of a sweep against η and η*.

use serde::{Deserialize, Serialize};

use crate::compare::{Comparison, compare};
use crate::cost::Shape;
use crate::estimate::mean_of;
use crate::fit::{Datum, Sigma, least_squares};
use crate::{Determined, Estimate, FitError, Run};

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ForcePoint {
    /// Id of the run.
    pub id: String,
    /// Confining pressure [Pa].
    pub p: f64,
    /// Elastic stress [Pa].
    pub sigma_e: f64,
    /// η = σc/p [1].
    pub eta: f64,
    /// η* = σc/√(p σe) [1].
    pub eta_star: f64,
    /// Compressive exponent β+ [1].
    pub beta_plus: Option<f64>,
    /// Its standard error [1].
    pub beta_plus_se: Option<f64>,
    /// Tensile exponent β− [1].
    pub beta_minus: Option<f64>,
    /// Its standard error [1].
    pub beta_minus_se: Option<f64>,
    /// How the run ended.
    pub status: String,
    /// Whether σc/σe exceeds 0.05; shown, left out of the comparison.
    pub out_of_model: bool,
}

/// The minimum of β+(η).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Minimum {
    /// Where, η [1]; the paper finds 0.2.
    pub eta: Estimate,
    /// Its depth, β+ [1]; the paper finds 0.2.
    pub beta_plus: Estimate,
}

/// The exponents of the force distribution over a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Forces {
    /// The runs that have β+ or β−.
    pub points: Vec<ForcePoint>,
    /// β+ and β−: which of η and η* collapses them better.
    pub comparisons: Vec<Determined<Comparison>>,
    /// The minimum of β+, from a parabola in ln η through the runs within a factor 5 of the lowest.
    pub minimum: Determined<Minimum>,
    /// b0 = β+ at η = 1, from a line in ln η within a factor 5; the paper finds 1 [1].
    pub b0: Determined<Estimate>,
    /// Mean of β+/β− over the runs with η ≥ 10; the paper's limit is 1 [1].
    pub symmetry: Determined<Estimate>,
}

/// β± against η and η*.
///
/// # Errors
/// [`FitError::TooFew`] when no run has them.
pub fn forces(runs: &[Run]) -> Result<Forces, FitError> {
    let points: Vec<ForcePoint> = runs
        .iter()
        .filter(|run| run.settled() && run.sigma_c > 0.0)
        .filter(|run| run.beta_plus.is_some() || run.beta_minus.is_some())
        .map(point)
        .collect();
    if points.is_empty() {
        return Err(FitError::too_few("forces", "runs with beta_plus or beta_minus", 1, 0));
    }
    let inside: Vec<&ForcePoint> = points.iter().filter(|point| !point.out_of_model).collect();
    let plus: Vec<Sample> = inside.iter().filter_map(|p| sample(p, p.beta_plus, p.beta_plus_se)).collect();
    let minus: Vec<Sample> = inside.iter().filter_map(|p| sample(p, p.beta_minus, p.beta_minus_se)).collect();
    let ratios: Vec<f64> = inside
        .iter()
        .filter(|point| point.eta >= 10.0)
        .filter_map(|point| Some(point.beta_plus? / point.beta_minus?))
        .filter(|ratio| ratio.is_finite())
        .collect();
    let symmetry = if ratios.len() < 2 {
        Err(FitError::too_few("β+/β− at large η", "runs with η ≥ 10", 2, ratios.len()))
    } else {
        Ok(mean_of(&ratios).expect("two or more ratios"))
    };
    Ok(Forces {
        comparisons: vec![against("beta_plus", &plus).into(), against("beta_minus", &minus).into()],
        minimum: minimum(&plus).into(),
        b0: at_one(&plus).into(),
        symmetry: symmetry.into(),
        points,
    })
}

fn point(run: &Run) -> ForcePoint {
    ForcePoint {
        id: run.id.clone(),
        p: run.p,
        sigma_e: run.sigma_e,
        eta: run.eta(),
        eta_star: run.eta_star(),
        beta_plus: run.beta_plus,
        beta_plus_se: run.beta_plus_se,
        beta_minus: run.beta_minus,
        beta_minus_se: run.beta_minus_se,
        status: run.status.clone(),
        out_of_model: run.out_of_model,
    }
}

struct Sample {
    eta: f64,
    eta_star: f64,
    beta: f64,
    se: Option<f64>,
}

fn sample(point: &ForcePoint, beta: Option<f64>, se: Option<f64>) -> Option<Sample> {
    Some(Sample { eta: point.eta, eta_star: point.eta_star, beta: beta?, se: se.filter(|se| *se > 0.0) })
}

/// Weights 1/se² where every run has an error, else equal.
fn against(name: &str, samples: &[Sample]) -> Result<Comparison, FitError> {
    let known = samples.iter().all(|sample| sample.se.is_some());
    let column = |get: fn(&Sample) -> f64| samples.iter().map(get).collect::<Vec<f64>>();
    let weights: Vec<f64> = samples
        .iter()
        .map(|sample| if known { sample.se.map_or(1.0, |se| se.powi(-2)) } else { 1.0 })
        .collect();
    compare(name, &column(|s| s.eta), &column(|s| s.eta_star), &column(|s| s.beta), &weights, Shape::Free)
}

fn near(samples: &[Sample], centre: f64) -> Vec<Datum> {
    samples
        .iter()
        .filter(|sample| (sample.eta / centre).ln().abs() <= 5.0_f64.ln())
        .map(|sample| Datum { x: (sample.eta / centre).ln(), y: sample.beta, sigma: 1.0 })
        .collect()
}

fn minimum(samples: &[Sample]) -> Result<Minimum, FitError> {
    const WHAT: &str = "minimum of β+";
    let lowest = samples
        .iter()
        .min_by(|a, b| a.beta.total_cmp(&b.beta))
        .ok_or_else(|| FitError::too_few(WHAT, "runs", 4, 0))?;
    let data = near(samples, lowest.eta);
    let start = [lowest.beta, 0.0, 0.1];
    let fit = least_squares(WHAT, &data, &["b", "x", "k"], &start, Sigma::Relative, |x, t| {
        t[0] + t[2] * (x - t[1]).powi(2)
    })?;
    let curvature = fit.parameter("k").expect("fitted");
    let (low, high) =
        data.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d.x), h.max(d.x)));
    let place = fit.parameter("x").expect("fitted");
    if curvature.ci95[0] <= 0.0 || place.value <= low || place.value >= high {
        return Err(FitError::underdetermined(WHAT, "β+ has no minimum inside the range of the runs"));
    }
    let centre = lowest.eta.ln();
    Ok(Minimum { eta: fit.derived(|t| t[1] + centre).exp(), beta_plus: fit.parameter("b").expect("fitted") })
}

fn at_one(samples: &[Sample]) -> Result<Estimate, FitError> {
    const WHAT: &str = "b0 (β+ at η = 1)";
    let data = near(samples, 1.0);
    let (below, above) =
        (data.iter().filter(|d| d.x <= 0.0).count(), data.iter().filter(|d| d.x >= 0.0).count());
    if below == 0 || above == 0 {
        return Err(FitError::too_few(WHAT, "runs on either side of η = 1", 1, 0));
    }
    let fit =
        least_squares(WHAT, &data, &["b0", "slope"], &[1.0, 0.0], Sigma::Relative, |x, t| t[0] + t[1] * x)?;
    Ok(fit.parameter("b0").expect("fitted"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Variable;
    use crate::synthetic::Study;

    #[test]
    fn the_synthetic_minimum_and_limits_are_found() {
        let runs = Study::paper(1).runs();
        let found = forces(&runs).unwrap();
        for comparison in &found.comparisons {
            assert_eq!(comparison.value().unwrap().better, Variable::Eta);
        }
        // β+ = 0.9 η/(0.2 + η) + 0.03/(0.02 + η): minimum 0.550 at η = 0.104
        let minimum = found.minimum.value().unwrap();
        assert!((minimum.eta.value / 0.104).ln().abs() < 0.15, "{minimum:?}");
        assert!((minimum.beta_plus.value - 0.550).abs() < 0.02, "{minimum:?}");
        let b0 = found.b0.value().unwrap();
        assert!((b0.value - 0.78).abs() < 0.05, "{b0:?}");
        assert!((found.symmetry.value().unwrap().value - 1.0).abs() < 0.05);
    }

    #[test]
    fn runs_without_forces_are_an_error() {
        let mut runs = Study::paper(1).runs();
        let few = forces(&runs[..3]).unwrap();
        assert!(few.comparisons.iter().all(|comparison| comparison.reason().is_some()));
        for run in &mut runs {
            (run.beta_plus, run.beta_minus) = (None, None);
        }
        assert!(matches!(forces(&runs), Err(FitError::TooFew { .. })));
    }
}
