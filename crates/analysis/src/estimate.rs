//! A number with its uncertainty.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A value with standard error and 95 % confidence interval, all in the unit of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Standard error.
    pub se: f64,
    /// 95 % confidence interval, lower and upper end.
    pub ci95: [f64; 2],
}

impl Estimate {
    /// Symmetric interval value ± t₀.₉₇₅(dof) se; the normal quantile for infinite `dof`.
    #[must_use]
    pub fn symmetric(value: f64, se: f64, dof: f64) -> Self {
        let half = student_975(dof) * se;
        Self { value, se, ci95: [value - half, value + half] }
    }

    /// Interval of exp(x) from the estimate of x: asymmetric, and positive as it has to be.
    #[must_use]
    pub fn exp(self) -> Self {
        let value = self.value.exp();
        Self { value, se: value * self.se, ci95: self.ci95.map(f64::exp) }
    }

    /// Whether `truth` lies in the 95 % interval.
    #[must_use]
    pub fn covers(&self, truth: f64) -> bool {
        (self.ci95[0]..=self.ci95[1]).contains(&truth)
    }
}

/// 97.5 % quantile of Student's t; 1.96 in the limit.
pub(crate) fn student_975(dof: f64) -> f64 {
    if !dof.is_finite() || dof > 1e6 {
        return 1.959_963_984_540_054;
    }
    StudentsT::new(0.0, 1.0, dof.max(1.0)).expect("at least one degree of freedom").inverse_cdf(0.975)
}

/// Weighted mean with its standard error from the scatter about it.
pub(crate) fn mean_of(values: &[f64]) -> Option<Estimate> {
    if values.is_empty() {
        return None;
    }
    #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let scatter = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    let se = if values.len() > 1 { (scatter / (n - 1.0) / n).sqrt() } else { 0.0 };
    Some(Estimate::symmetric(mean, se, n - 1.0))
}

/// Median; 0 for nothing.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => f64::midpoint(sorted[n / 2 - 1], sorted[n / 2]),
    }
}

/// Linear-interpolation quantile of sorted values, q in [0, 1].
pub(crate) fn quantile_sorted(sorted: &[f64], q: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
    let position = q * (sorted.len() - 1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 <= position < len")]
    let low = position.floor() as usize;
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + (position - position.floor()) * (sorted[high] - sorted[low])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn student_quantiles_of_the_tables() {
        for (dof, expected) in [(1.0, 12.706), (5.0, 2.571), (30.0, 2.042), (f64::INFINITY, 1.960)] {
            assert!((student_975(dof) - expected).abs() < 1e-3, "dof {dof}");
        }
    }

    #[test]
    fn mean_and_its_error() {
        let estimate = mean_of(&[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert!((estimate.value - 2.5).abs() < 1e-15);
        // s = sqrt(5/3), se = s/2
        assert!((estimate.se - (5.0_f64 / 3.0).sqrt() / 2.0).abs() < 1e-15);
        assert!(mean_of(&[]).is_none());
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(quantile_sorted(&[0.0, 1.0, 2.0], 0.25), 0.5);
    }
}
