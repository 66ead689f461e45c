//! Weighted nonlinear least squares with parameter covariance.
//!
//! The iteration is MINPACK's Levenberg–Marquardt (crate `levenberg-marquardt`); the covariance
//! (Jᵀ W J)⁻¹, its scaling, the intervals and the refusal of what the data do not fix are here.

mod problem;

use levenberg_marquardt::LevenbergMarquardt;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::{Estimate, FitError};
use problem::Problem;

/// One datum of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datum {
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
    /// Standard deviation of y, or any number in proportion to it when [`Sigma::Relative`].
    pub sigma: f64,
}

/// What the `sigma` of the data mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Sigma {
    /// Standard deviations (from replicates). The covariance is enlarged by the reduced χ² when that exceeds 1.
    Absolute,
    /// Relative weights only. The covariance is always scaled by the reduced χ².
    Relative,
}

/// A fitted parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Parameter {
    /// Symbol as in the formula.
    pub name: String,
    /// Value with standard error and 95 % interval.
    pub estimate: Estimate,
}

/// One residual of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Residual {
    /// Abscissa.
    pub x: f64,
    /// Datum.
    pub y: f64,
    /// Curve.
    pub fitted: f64,
    /// Datum minus curve.
    pub residual: f64,
    /// Standard deviation or relative weight used, see [`Sigma`].
    pub sigma: f64,
}

/// A converged, determined fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Fit {
    /// The parameters that were fitted.
    pub parameters: Vec<Parameter>,
    /// Their covariance matrix, in the same order.
    pub covariance: Vec<Vec<f64>>,
    /// Datum by datum.
    pub residuals: Vec<Residual>,
    /// Number of data used.
    pub points: usize,
    /// points − parameters.
    pub degrees_of_freedom: usize,
    /// Σ(residual/sigma)² / degrees of freedom.
    pub reduced_chi2: f64,
    /// Root mean square residual, unweighted, in the unit of y.
    pub rms: f64,
    /// What `sigma` meant.
    pub sigma: Sigma,
}

impl Fit {
    /// The fitted values.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.estimate.value).collect()
    }

    /// A parameter by name.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<Estimate> {
        self.parameters.iter().find(|parameter| parameter.name == name).map(|parameter| parameter.estimate)
    }

    /// A function of the parameters with its error by linear propagation: var f = ∇f · Cov · ∇f.
    pub fn derived(&self, function: impl Fn(&[f64]) -> f64) -> Estimate {
        let theta = self.values();
        let gradient = gradient(&theta, &function);
        #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
        let dof = self.degrees_of_freedom as f64;
        Estimate::symmetric(function(&theta), quadratic(&self.covariance, &gradient).max(0.0).sqrt(), dof)
    }

    /// Replaces the covariance (for example by one that holds further sources of error) and all intervals.
    pub(crate) fn with_covariance(mut self, covariance: Vec<Vec<f64>>) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
        let dof = self.degrees_of_freedom as f64;
        for (i, parameter) in self.parameters.iter_mut().enumerate() {
            parameter.estimate =
                Estimate::symmetric(parameter.estimate.value, covariance[i][i].max(0.0).sqrt(), dof);
        }
        self.covariance = covariance;
        self
    }
}

/// vᵀ M v.
fn quadratic(matrix: &[Vec<f64>], vector: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (row, a) in matrix.iter().zip(vector) {
        for (element, b) in row.iter().zip(vector) {
            sum += element * a * b;
        }
    }
    sum
}

/// Central-difference step for a parameter of size `value`.
fn step(value: f64) -> f64 {
    6e-6 * value.abs().max(1e-2)
}

fn gradient(theta: &[f64], function: &impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let mut work = theta.to_vec();
    (0..theta.len())
        .map(|i| {
            let h = step(theta[i]);
            work[i] = theta[i] + h;
            let above = function(&work);
            work[i] = theta[i] - h;
            let below = function(&work);
            work[i] = theta[i];
            (above - below) / (2.0 * h)
        })
        .collect()
}

/// Smallest ratio of singular values of the column-normalised Jacobian that still counts as determined.
const RANK_TOLERANCE: f64 = 1e-7;

/// Minimises Σ((y − model(x, θ))/σ)² from `start`.
///
/// # Errors
/// [`FitError::TooFew`] without at least one degree of freedom, [`FitError::NotConverged`],
/// [`FitError::Underdetermined`] when the Jacobian at the minimum is rank deficient.
pub fn least_squares(
    what: &str,
    data: &[Datum],
    names: &[&str],
    start: &[f64],
    sigma: Sigma,
    model: impl Fn(f64, &[f64]) -> f64,
) -> Result<Fit, FitError> {
    let count = names.len();
    debug_assert_eq!(count, start.len());
    if data.len() <= count {
        return Err(FitError::too_few(what, "points", count + 1, data.len()));
    }
    if let Some(bad) = data.iter().find(|d| !(d.x.is_finite() && d.y.is_finite() && d.sigma > 0.0)) {
        return Err(FitError::out_of_range(what, format!("datum {bad:?} is not finite or has no weight")));
    }
    let problem = Problem { data, theta: DVector::from_column_slice(start), model: &model };
    let (problem, report) = LevenbergMarquardt::new().with_patience(400).minimize(problem);
    if !report.termination.was_successful() {
        return Err(FitError::not_converged(
            what,
            format!("{:?} after {} evaluations", report.termination, report.number_of_evaluations),
        ));
    }
    let theta: Vec<f64> = problem.theta.iter().copied().collect();
    let jacobian = problem.weighted_jacobian();
    let mut covariance = covariance(what, &jacobian, names)?;
    let residuals: Vec<Residual> = data
        .iter()
        .map(|d| {
            let fitted = model(d.x, &theta);
            Residual { x: d.x, y: d.y, fitted, residual: d.y - fitted, sigma: d.sigma }
        })
        .collect();
    let chi2: f64 = residuals.iter().map(|r| (r.residual / r.sigma).powi(2)).sum();
    let dof = data.len() - count;
    #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
    let (dof_real, points) = (dof as f64, data.len() as f64);
    let reduced_chi2 = chi2 / dof_real;
    if !reduced_chi2.is_finite() {
        return Err(FitError::not_converged(what, "the residuals are not finite"));
    }
    let scale = match sigma {
        Sigma::Absolute => reduced_chi2.max(1.0),
        Sigma::Relative => reduced_chi2,
    };
    for row in &mut covariance {
        for element in row.iter_mut() {
            *element *= scale;
        }
    }
    let parameters = names
        .iter()
        .zip(&theta)
        .enumerate()
        .map(|(i, (name, &value))| Parameter {
            name: (*name).to_owned(),
            estimate: Estimate::symmetric(value, covariance[i][i].sqrt(), dof_real),
        })
        .collect();
    let rms = (residuals.iter().map(|r| r.residual * r.residual).sum::<f64>() / points).sqrt();
    Ok(Fit {
        parameters,
        covariance,
        residuals,
        points: data.len(),
        degrees_of_freedom: dof,
        reduced_chi2,
        rms,
        sigma,
    })
}

/// (Jᵀ J)⁻¹ by the singular values of the column-normalised J; refuses what is not determined.
fn covariance(what: &str, jacobian: &DMatrix<f64>, names: &[&str]) -> Result<Vec<Vec<f64>>, FitError> {
    let count = names.len();
    let norms: Vec<f64> = (0..count).map(|j| jacobian.column(j).norm()).collect();
    if let Some(dead) = norms.iter().position(|norm| !norm.is_finite() || *norm == 0.0) {
        return Err(FitError::underdetermined(what, format!("no datum depends on {}", names[dead])));
    }
    let mut scaled = jacobian.clone();
    for (j, norm) in norms.iter().enumerate() {
        scaled.column_mut(j).unscale_mut(*norm);
    }
    let svd = scaled.svd(false, true);
    let v_t = svd.v_t.expect("the right singular vectors were asked for");
    let largest = svd.singular_values.max();
    let (weakest, smallest) = svd
        .singular_values
        .iter()
        .copied()
        .enumerate()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .expect("some parameter");
    if smallest <= RANK_TOLERANCE * largest {
        let free: Vec<&str> =
            (0..count).filter(|&j| v_t[(weakest, j)].abs() > 0.3).map(|j| names[j]).collect();
        return Err(FitError::underdetermined(
            what,
            format!("only a combination of {} is fixed", free.join(", ")),
        ));
    }
    let element = |i: usize, j: usize| -> f64 {
        let sum: f64 = (0..count).map(|k| v_t[(k, i)] * v_t[(k, j)] / svd.singular_values[k].powi(2)).sum();
        sum / (norms[i] * norms[j])
    };
    Ok((0..count).map(|i| (0..count).map(|j| element(i, j)).collect()).collect())
}

#[cfg(test)]
mod tests;
