//! e_min, the plateaus and the master curve together.
//!
//! They are first read one after the other, but the same data determine them all through one model,
//! e = e_min + e_r(η*; ln a, α, ln b, β)(e_max(p) − e_min). Its least squares remove what the dense limit and the
//! plateau are not quite in their limits, and its covariance holds every correlation between the parts.

use nalgebra::DMatrix;

use crate::fit::{Datum, Sigma, least_squares};
use crate::master::{MasterCurve, e_r_theta};
use crate::point::count;

/// One point of the joint model.
pub(crate) struct JointPoint {
    pub eta_star: f64,
    /// Void ratio [1].
    pub e: f64,
    /// Standard deviation of e; 1 when relative.
    pub sigma: f64,
    /// Index of its pressure among the plateaus.
    pub plateau: usize,
}

/// Covariances of the parts.
pub(crate) struct Joint {
    /// Standard error of e_min.
    pub e_min_se: f64,
    /// Standard error of each plateau.
    pub e_max_se: Vec<f64>,
    /// Covariance of (ln a, α, ln b, β).
    pub curve: Vec<Vec<f64>>,
}

/// Least squares of the joint model from the given start; `fixed_e_min` keeps e_min. Nothing when it does not converge.
pub(crate) fn polish(
    points: &[JointPoint],
    known: Sigma,
    e_min: f64,
    fixed_e_min: bool,
    e_max: &[f64],
    curve: &MasterCurve,
) -> Option<(f64, Vec<f64>)> {
    #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
    let data: Vec<Datum> = points
        .iter()
        .enumerate()
        .map(|(i, point)| Datum { x: i as f64, y: point.e, sigma: point.sigma })
        .collect();
    let mut start: Vec<f64> = curve.theta().to_vec();
    start.extend(e_max);
    if !fixed_e_min {
        start.push(e_min);
    }
    let names = vec!["level"; start.len()];
    let fit = least_squares("levels", &data, &names, &start, known, |index, theta| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index, see above")]
        let point = &points[index as usize];
        let low = if fixed_e_min { e_min } else { theta[theta.len() - 1] };
        low + e_r_theta(point.eta_star, &theta[..4]) * (theta[4 + point.plateau] - low)
    })
    .ok()?;
    let values = fit.values();
    let low = if fixed_e_min { e_min } else { values[values.len() - 1] };
    Some((low, values[4..4 + e_max.len()].to_vec()))
}

/// Linearises at the given levels and curve. `prior` holds the standard error of a plateau that came from (15) and is
/// therefore no free parameter. Nothing when the model is rank deficient on these points.
pub(crate) fn covariance(
    points: &[JointPoint],
    known: Sigma,
    e_min: f64,
    e_max: &[f64],
    prior: &[Option<f64>],
    curve: &MasterCurve,
) -> Option<Joint> {
    let levels = 1 + e_max.len();
    let size = levels + 4;
    let n = points.len();
    if n <= size {
        return None;
    }
    // rows of the joint model in units of σ, then one row per prior
    let priors: Vec<(usize, f64)> =
        prior.iter().enumerate().filter_map(|(k, se)| se.filter(|se| *se > 0.0).map(|se| (k, se))).collect();
    let mut rows = DMatrix::<f64>::zeros(n + priors.len(), size);
    let mut chi2 = 0.0;
    for (i, point) in points.iter().enumerate() {
        let e_r = curve.e_r(point.eta_star);
        let span = e_max[point.plateau] - e_min;
        rows[(i, 0)] = (1.0 - e_r) / point.sigma;
        rows[(i, 1 + point.plateau)] = e_r / point.sigma;
        for (k, slope) in e_r_slopes(point.eta_star, curve).into_iter().enumerate() {
            rows[(i, levels + k)] = span * slope / point.sigma;
        }
        chi2 += ((point.e - e_min - e_r * span) / point.sigma).powi(2);
    }
    let reduced = chi2 / (count(n) - count(size));
    let scale = if known == Sigma::Absolute { reduced.max(1.0) } else { reduced };
    for (row, (k, se)) in priors.iter().enumerate() {
        rows[(n + row, 1 + k)] = scale.sqrt() / se;
    }
    let response = pseudo_inverse(&rows)?;
    let covariance = scale * &response * response.transpose();
    let element = |i: usize, j: usize| covariance[(levels + i, levels + j)];
    Some(Joint {
        e_min_se: covariance[(0, 0)].sqrt(),
        e_max_se: (1..levels).map(|i| covariance[(i, i)].sqrt()).collect(),
        curve: (0..4).map(|i| (0..4).map(|j| element(i, j)).collect()).collect(),
    })
}

fn e_r_slopes(eta_star: f64, curve: &MasterCurve) -> [f64; 4] {
    const H: f64 = 1e-5;
    let theta = curve.theta();
    std::array::from_fn(|k| {
        let (mut above, mut below) = (theta, theta);
        above[k] += H;
        below[k] -= H;
        (e_r_theta(eta_star, &above) - e_r_theta(eta_star, &below)) / (2.0 * H)
    })
}

/// (RᵀR)⁻¹Rᵀ with the columns scaled to unit length before the inversion.
fn pseudo_inverse(rows: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let lengths: Vec<f64> = rows.column_iter().map(|column| column.norm()).collect();
    if lengths.iter().any(|length| *length <= 0.0 || !length.is_finite()) {
        return None;
    }
    let mut unit = rows.clone();
    for (j, length) in lengths.iter().enumerate() {
        unit.column_mut(j).unscale_mut(*length);
    }
    let mut inverse = (unit.transpose() * &unit).cholesky()?.inverse() * unit.transpose();
    for (j, length) in lengths.iter().enumerate() {
        inverse.row_mut(j).unscale_mut(*length);
    }
    Some(inverse)
}
