//! Statistics of normal forces: exponents of the two exponential branches and the histogram.

/// Tensile branch of the fit: fn/fc in [−0.5, 0] (eq. 32 and the text after it).
const TENSILE_RANGE: f64 = 0.5;
/// Compressive branch of the fit: fn/fc in [0, 1.5].
const COMPRESSIVE_RANGE: f64 = 1.5;
/// Contacts with |fn/fc| up to this belong to the Dirac peak at 0; they are counted apart and left out of the fits.
pub const PEAK_WIDTH: f64 = 0.01;
/// Fewest forces a fit is made from.
const FEWEST: usize = 20;

/// A maximum-likelihood exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// β, positive when the density falls away from 0 [1].
    pub beta: f64,
    /// Standard error from the Fisher information, forces taken as independent [1].
    pub standard_error: f64,
    /// Forces used.
    pub count: usize,
}

/// Maximum-likelihood β of a density ∝ exp(−β y) on [0, `range`] from samples of y.
///
/// With b = β·range the likelihood equation is 1/b − 1/(e^b − 1) = mean(y)/range, whose left side falls
/// monotonically from 1 to 0, and the information of one sample is range² (1/b² − e^b/(e^b − 1)²). Samples outside
/// the range are ignored. Nothing is returned for fewer than 20 samples or when all sit at one end: the exponent is
/// not determined then.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
pub fn truncated_exponential(samples: impl IntoIterator<Item = f64>, range: f64) -> Option<Exponent> {
    let (mut sum, mut count) = (0.0, 0_usize);
    for y in samples {
        if (0.0..=range).contains(&y) {
            sum += y;
            count += 1;
        }
    }
    if count < FEWEST {
        return None;
    }
    let mean = sum / count as f64 / range;
    // beyond |b| = 700 exp overflows; such a sample sits at one end
    let (mut low, mut high) = (-700.0, 700.0);
    if mean <= mean_of(high) || mean >= mean_of(low) {
        return None;
    }
    let mut b = 12.0 * (0.5 - mean);
    for _ in 0..200 {
        let excess = mean_of(b) - mean;
        if excess > 0.0 {
            low = b;
        } else {
            high = b;
        }
        let newton = b + excess / variance_of(b);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let moved = (next - b).abs();
        b = next;
        if moved <= 1e-13 * b.abs().max(1.0) {
            break;
        }
    }
    let standard_error = 1.0 / (range * (count as f64 * variance_of(b)).sqrt());
    Some(Exponent { beta: b / range, standard_error, count })
}

/// Mean of exp(−b u) on [0, 1]: 1/b − 1/(e^b − 1).
fn mean_of(b: f64) -> f64 {
    if b.abs() < 1e-2 {
        let square = b * b;
        return 0.5 - b / 12.0 * (1.0 - square / 60.0 * (1.0 - square / 42.0));
    }
    1.0 / b - 1.0 / libm::expm1(b)
}

/// Variance of exp(−b u) on [0, 1]: 1/b² − e^b/(e^b − 1)² = 1/b² − 1/(2 sinh(b/2))².
fn variance_of(b: f64) -> f64 {
    if b.abs() < 1e-2 {
        let square = b * b;
        return 1.0 / 12.0 - square / 240.0 + square * square / 6048.0;
    }
    let s = 2.0 * libm::sinh(0.5 * b);
    1.0 / (b * b) - 1.0 / (s * s)
}

/// Exponents of the force distribution and the weight of its peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ForceStatistics {
    /// β+ on fn/fc in [0, 1.5].
    pub(crate) plus: Option<Exponent>,
    /// β− on fn/fc in [−0.5, 0].
    pub(crate) minus: Option<Exponent>,
    /// Share of contacts with |fn/fc| ≤ [`PEAK_WIDTH`].
    pub(crate) peak_share: f64,
}

/// Statistics of fn/fc; nothing without adhesion or without contacts. Moving the origin to the edge of the peak
/// leaves an exponential branch an exponential with the same β, so leaving the peak out costs no bias.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
pub(crate) fn statistics(normal_forces: &[f64], adhesion: f64) -> Option<ForceStatistics> {
    if adhesion <= 0.0 || normal_forces.is_empty() {
        return None;
    }
    let ratios = || normal_forces.iter().map(|force| force / adhesion);
    let beyond_peak = |x: f64| x - PEAK_WIDTH;
    let in_peak = ratios().filter(|x| x.abs() <= PEAK_WIDTH).count();
    let outside = || ratios().filter(|x| x.abs() > PEAK_WIDTH);
    Some(ForceStatistics {
        plus: truncated_exponential(outside().map(beyond_peak), COMPRESSIVE_RANGE - PEAK_WIDTH),
        minus: truncated_exponential(outside().map(|x| beyond_peak(-x)), TENSILE_RANGE - PEAK_WIDTH),
        peak_share: in_peak as f64 / normal_forces.len() as f64,
    })
}

/// Bins of equal width with their counts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Histogram {
    /// Left edge of the first bin.
    pub(crate) start: f64,
    /// Width of a bin.
    pub(crate) width: f64,
    /// Values per bin; those outside all bins are in `outside`.
    pub(crate) counts: Vec<u64>,
    /// Values outside the bins.
    pub(crate) outside: u64,
}

/// Histogram of normal forces over `scale`, from −1 (pull-off) to 8, in bins of 0.05.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to lie in the bins")]
pub(crate) fn histogram(normal_forces: &[f64], scale: f64) -> Histogram {
    const START: f64 = -1.0;
    const WIDTH: f64 = 0.05;
    const BINS: usize = 180;
    let mut found = Histogram { start: START, width: WIDTH, counts: vec![0; BINS], outside: 0 };
    for force in normal_forces {
        let bin = ((force / scale - START) / WIDTH).floor();
        if bin >= 0.0 && bin < BINS as f64 {
            found.counts[bin as usize] += 1;
        } else {
            found.outside += 1;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    /// Samples of exp(−β y) on [0, range] by inversion.
    fn sample(beta: f64, range: f64, n: usize, seed: u64) -> Vec<f64> {
        let mut stream = Stream::new(seed, 9);
        (0..n)
            .map(|_| {
                let u = stream.unit();
                if beta == 0.0 { u * range } else { -(u * (-beta * range).exp_m1()).ln_1p() / beta }
            })
            .collect()
    }

    #[test]
    fn the_mean_and_variance_agree_with_their_series() {
        for b in [-0.0101, -0.0099, 0.0099, 0.0101_f64] {
            let direct = 1.0 / b - 1.0 / b.exp_m1();
            assert!((mean_of(b) - direct).abs() < 1e-12, "{b}");
            let s = 2.0 * (0.5 * b).sinh();
            assert!((variance_of(b) - (1.0 / (b * b) - 1.0 / (s * s))).abs() < 1e-10, "{b}");
        }
        assert!((mean_of(0.0) - 0.5).abs() < 1e-15 && (variance_of(0.0) - 1.0 / 12.0).abs() < 1e-15);
    }

    #[test]
    fn known_exponents_lie_inside_their_95_percent_interval_in_at_least_90_percent_of_trials() {
        for (beta, range) in [(-1.0, 1.5), (0.0, 1.5), (0.2, 1.5), (1.0, 1.5), (4.0, 0.5), (40.0, 1.5)] {
            let inside = (0..200)
                .filter(|&seed| {
                    let fit = truncated_exponential(sample(beta, range, 500, seed), range).unwrap();
                    (fit.beta - beta).abs() < 1.96 * fit.standard_error
                })
                .count();
            assert!(inside >= 180, "β = {beta}: {inside} of 200");
        }
    }

    #[test]
    fn a_peak_at_zero_does_not_bias_the_branches() {
        let mut forces: Vec<f64> = sample(1.0, 5.0, 40_000, 1);
        forces.extend(sample(3.0, 1.0, 20_000, 2).into_iter().map(|y| -y));
        let without = statistics(&forces, 1.0).unwrap();
        forces.extend(std::iter::repeat_n(0.0, 10_000));
        let with = statistics(&forces, 1.0).unwrap();
        assert_eq!((with.plus, with.minus), (without.plus, without.minus));
        assert!(with.peak_share > 10_000.0 / 70_000.0);
        let plus = with.plus.unwrap();
        let minus = with.minus.unwrap();
        assert!((plus.beta - 1.0).abs() < 3.0 * plus.standard_error);
        assert!((minus.beta - 3.0).abs() < 3.0 * minus.standard_error);
    }

    #[test]
    fn what_is_not_determined_is_not_a_number() {
        assert_eq!(truncated_exponential([0.1; 5], 1.0), None);
        assert_eq!(truncated_exponential([0.0; 50], 1.0), None);
        assert_eq!(truncated_exponential([1.0; 50], 1.0), None);
        assert_eq!(statistics(&[0.1, 0.2], 0.0), None);
    }

    #[test]
    fn every_force_is_counted_once() {
        let forces = [-1.2, -1.0, -0.001, 0.0, 0.049, 7.99, 8.0, 100.0];
        let found = histogram(&forces, 1.0);
        assert_eq!(found.counts.iter().sum::<u64>() + found.outside, 8);
        assert_eq!(found.outside, 3);
        assert_eq!(found.counts[20], 2);
    }
}
