//! The collapse cost: scatter of data about a smooth curve through them.
//!
//! The curve is a cubic regression spline in u (a logarithm of the scaling variable) with knots at quantiles of u,
//! hence invariant when u is shifted or stretched: changing an exponent changes the cost only by how well the data
//! fall on one curve. A monotone curve has non-decreasing spline coefficients, found by non-negative least squares.

mod nnls;
mod spline;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::FitError;
use crate::point::count;
use spline::Spline;

/// What is asked of the smooth curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Monotone, rising.
    Increasing,
    /// Monotone, falling.
    Decreasing,
    /// Smooth only.
    Free,
}

/// Scatter about the smooth curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Scatter {
    /// √(Σ w r² / Σ w · n/(n − m)): scatter per point, freed from the m coefficients of the curve [unit of y].
    pub rms: f64,
    /// Number of points n.
    pub points: usize,
    /// Number of coefficients m of the curve.
    pub coefficients: usize,
}

/// Number of knot intervals for n points: one per six points, three to eight.
fn intervals(points: usize) -> usize {
    (points / 6).clamp(2, 8)
}

/// Scatter of y(u) with weights w about a smooth curve.
///
/// # Errors
/// [`FitError::TooFew`] when there are fewer than three points more than coefficients;
/// [`FitError::Underdetermined`] when all u coincide.
pub fn scatter(what: &str, u: &[f64], y: &[f64], w: &[f64], shape: Shape) -> Result<Scatter, FitError> {
    let coefficients = intervals(u.len()) + 3;
    if u.len() < coefficients + 3 {
        return Err(FitError::too_few(what, "points", coefficients + 3, u.len()));
    }
    let total: f64 = w.iter().sum();
    let rss = residual_sum(u, y, w, shape)
        .ok_or_else(|| FitError::underdetermined(what, "all points share one abscissa"))?;
    let n = count(u.len());
    let rms = (rss / total * n / (n - count(coefficients))).sqrt();
    Ok(Scatter { rms, points: u.len(), coefficients })
}

/// Σ w (y − curve)²; nothing when all u coincide. Weights may be zero (bootstrap resamples).
pub(crate) fn residual_sum(u: &[f64], y: &[f64], w: &[f64], shape: Shape) -> Option<f64> {
    let sign = if shape == Shape::Decreasing { -1.0 } else { 1.0 };
    let spline = Spline::with_quantile_knots(u, intervals(u.len()))?;
    let size = spline.coefficients();
    let mut gram = DMatrix::<f64>::zeros(size, size);
    let mut right = DVector::<f64>::zeros(size);
    let mut square = 0.0;
    for ((&u, &y), &w) in u.iter().zip(y).zip(w) {
        if w == 0.0 {
            continue;
        }
        let (first, basis) = spline.basis(u);
        let y = sign * y;
        square += w * y * y;
        for (i, a) in basis.iter().enumerate() {
            right[first + i] += w * a * y;
            for (j, b) in basis.iter().enumerate() {
                gram[(first + i, first + j)] += w * a * b;
            }
        }
    }
    // increments instead of coefficients: c_m = d_0 + … + d_m, so monotone means d_1 … ≥ 0
    let free = if shape == Shape::Free { size } else { 1 };
    suffix_sums(&mut gram, &mut right);
    let increments = nnls::solve(&gram, &right, free);
    let rss = square - 2.0 * increments.dot(&right) + increments.dot(&(&gram * &increments));
    Some(rss.max(0.0))
}

/// Tᵀ G T and Tᵀ r for T the lower triangle of ones: sums over all later rows and columns.
fn suffix_sums(gram: &mut DMatrix<f64>, right: &mut DVector<f64>) {
    let size = right.len();
    for i in (0..size - 1).rev() {
        right[i] += right[i + 1];
        for j in 0..size {
            let below = gram[(i + 1, j)];
            gram[(i, j)] += below;
        }
    }
    for j in (0..size - 1).rev() {
        for i in 0..size {
            let beside = gram[(i, j + 1)];
            gram[(i, j)] += beside;
        }
    }
}

#[cfg(test)]
mod tests;
