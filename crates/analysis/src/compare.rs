//! Which of η and η* collapses a quantity better, as a number.

use serde::{Deserialize, Serialize};

use crate::cost::{Scatter, Shape, residual_sum, scatter};
use crate::point::count;
use crate::{FitError, resample};

/// A scaling variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Variable {
    /// Cohesion number η = σc/p.
    Eta,
    /// Modified cohesion number η* = σc/√(p σe).
    EtaStar,
}

/// Scatter of a quantity about a smooth curve in either variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Comparison {
    /// The quantity.
    pub quantity: String,
    /// Scatter against ln η [unit of the quantity].
    pub eta: Scatter,
    /// Scatter against ln η* [unit of the quantity].
    pub eta_star: Scatter,
    /// Scatter against η* over scatter against η: above 1, η collapses better [1].
    pub ratio: f64,
    /// The variable with the smaller scatter.
    pub better: Variable,
    /// Share of 200 bootstrap resamples in which that variable has the smaller scatter [1].
    pub confidence: f64,
}

const RESAMPLES: u32 = 200;

/// Compares both variables for y(η), y(η*) with weights.
pub(crate) fn compare(
    quantity: &str,
    eta: &[f64],
    eta_star: &[f64],
    y: &[f64],
    weights: &[f64],
    shape: Shape,
) -> Result<Comparison, FitError> {
    let logs = |values: &[f64]| values.iter().map(|value| value.ln()).collect::<Vec<f64>>();
    let (u, v) = (logs(eta), logs(eta_star));
    let first = scatter(quantity, &u, y, weights, shape)?;
    let second = scatter(quantity, &v, y, weights, shape)?;
    let better = if first.rms <= second.rms { Variable::Eta } else { Variable::EtaStar };
    let wins = (0..RESAMPLES)
        .filter(|&round| {
            let mut drawn = resample::weights(y.len(), 1, u64::from(round));
            drawn.iter_mut().zip(weights).for_each(|(draw, weight)| *draw *= weight);
            let by_eta = residual_sum(&u, y, &drawn, shape);
            let by_eta_star = residual_sum(&v, y, &drawn, shape);
            match better {
                Variable::Eta => by_eta <= by_eta_star,
                Variable::EtaStar => by_eta_star <= by_eta,
            }
        })
        .count();
    Ok(Comparison {
        quantity: quantity.to_owned(),
        ratio: second.rms / first.rms,
        eta: first,
        eta_star: second,
        better,
        confidence: count(wins) / f64::from(RESAMPLES),
    })
}
