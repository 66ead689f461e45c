//! Case resampling with a counter-seeded generator: the same seed gives the same resamples.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::Estimate;
use crate::estimate::quantile_sorted;
use crate::point::count;

/// How often each of n cases is drawn in resample number `round` (multinomial counts).
pub(crate) fn weights(n: usize, seed: u64, round: u64) -> Vec<f64> {
    let mut rng = Pcg64::seed_from_u64(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(round));
    let mut weights = vec![0.0; n];
    for _ in 0..n {
        weights[rng.random_range(0..n)] += 1.0;
    }
    weights
}

/// Estimate with the standard deviation of the resamples and their 2.5 … 97.5 % range, widened by √(n/(n − m)) about
/// the value: resampled residuals lack the m degrees of freedom that the curve took.
pub(crate) fn estimate(value: f64, resamples: &[f64], n: usize, m: usize) -> Estimate {
    let mut sorted = resamples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mean = sorted.iter().sum::<f64>() / count(sorted.len());
    let variance =
        sorted.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count(sorted.len()) - 1.0).max(1.0);
    let widen = (count(n) / count(n.saturating_sub(m).max(1))).sqrt();
    let end = |q: f64| value + widen * (quantile_sorted(&sorted, q) - value);
    let (low, high) = (end(0.025), end(0.975));
    Estimate { value, se: widen * variance.sqrt(), ci95: [low.min(value), high.max(value)] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_n_of_n_the_same_for_the_same_seed() {
        let first = weights(50, 3, 7);
        assert_eq!(first.iter().sum::<f64>(), 50.0);
        assert_eq!(first, weights(50, 3, 7));
        assert_ne!(first, weights(50, 3, 8));
        assert_ne!(first, weights(50, 4, 7));
    }
}
