//! Maximum likelihood for the exponential law on a bounded interval.

use serde::{Deserialize, Serialize};

use crate::point::count;
use crate::{Estimate, FitError};

/// Rate of P(x) ∝ exp(−β x) on [0, T].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Truncated {
    /// β, with the standard error 1/√(n I(β)) of the Fisher information [1/unit of x]; negative when the density
    /// rises with x.
    pub beta: Estimate,
    /// Number of contacts n.
    pub contacts: usize,
}

/// Fewest contacts for a rate.
const FEWEST: usize = 10;

/// β from the sample `x` in [0, `end`]: the mean x̄ is sufficient and x̄ = 1/β − T/(e^{βT} − 1). With t = βT,
/// x̄/T = 1/t − 1/(e^t − 1) falls monotonically from 1 to 0, so bisection finds the only root.
/// Information per contact: I = 1/β² − T² e^t/(e^t − 1)².
///
/// # Errors
/// [`FitError::TooFew`] below ten contacts; [`FitError::OutOfRange`] for a value outside [0, T];
/// [`FitError::Underdetermined`] when the mean is so near to an end that β is unbounded.
pub fn truncated_exponential(x: &[f64], end: f64) -> Result<Truncated, FitError> {
    const WHAT: &str = "truncated exponential";
    if x.len() < FEWEST {
        return Err(FitError::too_few(WHAT, "contacts", FEWEST, x.len()));
    }
    if let Some(bad) = x.iter().find(|value| !(0.0..=end).contains(*value)) {
        return Err(FitError::out_of_range(WHAT, format!("x = {bad} lies outside [0, {end}]")));
    }
    let n = count(x.len());
    let share = x.iter().sum::<f64>() / n / end;
    const LARGEST: f64 = 700.0;
    if share <= reduced_mean(LARGEST) || share >= reduced_mean(-LARGEST) {
        return Err(FitError::underdetermined(
            WHAT,
            format!("the mean {} lies at an end of [0, {end}]", share * end),
        ));
    }
    let (mut low, mut high) = (-LARGEST, LARGEST);
    while high - low > 1e-13 * (1.0 + low.abs().max(high.abs())) {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            break;
        }
        if reduced_mean(middle) > share {
            low = middle;
        } else {
            high = middle;
        }
    }
    let t = f64::midpoint(low, high);
    let se = 1.0 / (n * reduced_information(t)).sqrt() / end;
    Ok(Truncated { beta: Estimate::symmetric(t / end, se, f64::INFINITY), contacts: x.len() })
}

/// Mean of x/T at t = βT: 1/t − 1/(e^t − 1).
fn reduced_mean(t: f64) -> f64 {
    if t.abs() < 1e-2 {
        0.5 - t / 12.0 + t.powi(3) / 720.0 - t.powi(5) / 30_240.0
    } else {
        1.0 / t - 1.0 / t.exp_m1()
    }
}

/// T⁻² times the information of one contact: the variance of x/T, 1/t² − 1/(4 sinh²(t/2)).
fn reduced_information(t: f64) -> f64 {
    if t.abs() < 1e-1 {
        1.0 / 12.0 - t * t / 240.0 + t.powi(4) / 6048.0
    } else {
        t.powi(-2) - 0.25 * (0.5 * t).sinh().powi(-2)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    use super::*;

    /// Inverse of the distribution function (1 − e^{−βx})/(1 − e^{−βT}).
    fn sample(beta: f64, end: f64, n: usize, rng: &mut Pcg64) -> Vec<f64> {
        (0..n)
            .map(|_| {
                let u: f64 = rng.random();
                let x = if beta == 0.0 { u * end } else { -(u * (-beta * end).exp_m1()).ln_1p() / beta };
                x.clamp(0.0, end)
            })
            .collect()
    }

    #[test]
    fn closed_forms() {
        // a mean of T/2 is the uniform law: β = 0, se = √(12/n)/T
        let flat =
            truncated_exponential(&[0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 0.75, 0.75, 0.75, 0.75], 1.5).unwrap();
        assert!(flat.beta.value.abs() < 1e-11);
        assert!((flat.beta.se - (12.0_f64 / 10.0).sqrt() / 1.5).abs() < 1e-9);
        // far from the end it is the plain exponential: β = 1/x̄, se = β/√n
        let steep: Vec<f64> = (0..50).map(|i| 0.001 * f64::from(i)).collect();
        let found = truncated_exponential(&steep, 1.5).unwrap();
        assert!((found.beta.value * 0.0245 - 1.0).abs() < 1e-9);
        assert!((found.beta.se / found.beta.value - 1.0 / 50.0_f64.sqrt()).abs() < 1e-9);
        // the two branches of the series meet
        for t in [0.009_999, 0.010_001, -0.009_999, -0.010_001] {
            assert!((reduced_mean(t) - (0.5 - t / 12.0 + t.powi(3) / 720.0)).abs() < 1e-12);
        }
        assert!((reduced_information(0.1 - 1e-9) - reduced_information(0.1 + 1e-9)).abs() < 1e-9);
    }

    #[test]
    fn mirrored_data_change_the_sign() {
        let x = [0.1, 0.2, 0.2, 0.4, 0.05, 0.3, 0.25, 0.15, 0.35, 0.6];
        let mirrored = x.map(|value| 1.5 - value);
        let (a, b) =
            (truncated_exponential(&x, 1.5).unwrap(), truncated_exponential(&mirrored, 1.5).unwrap());
        assert!((a.beta.value + b.beta.value).abs() < 1e-9 && (a.beta.se - b.beta.se).abs() < 1e-9);
    }

    #[test]
    fn degenerate_samples_are_errors() {
        assert!(matches!(truncated_exponential(&[0.1; 9], 1.5), Err(FitError::TooFew { .. })));
        assert!(matches!(truncated_exponential(&[1.6; 20], 1.5), Err(FitError::OutOfRange { .. })));
        assert!(matches!(truncated_exponential(&[0.0; 20], 1.5), Err(FitError::Underdetermined { .. })));
        assert!(matches!(truncated_exponential(&[f64::NAN; 20], 1.5), Err(FitError::OutOfRange { .. })));
    }

    #[test]
    fn rates_lie_within_their_interval() {
        for (beta, end, n) in [(0.2, 1.5, 400), (1.0, 1.5, 60), (0.9, 0.5, 2000), (8.0, 0.5, 100)] {
            let hits = (0..200)
                .filter(|&seed| {
                    let mut rng = Pcg64::seed_from_u64(seed);
                    truncated_exponential(&sample(beta, end, n, &mut rng), end).unwrap().beta.covers(beta)
                })
                .count();
            assert!((180..=200).contains(&hits), "β = {beta}: {hits} of 200");
        }
    }
}
