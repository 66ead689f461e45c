//! Standard errors of contact averages from the sample itself: a jackknife over the octants of the box.
//!
//! The box is symmetric about its middle planes, so its eight octants are statistically alike. Leaving out one at a
//! time (Quenouille–Tukey) gives the standard error of a ratio of sums, correlations shorter than an octant
//! included, with seven degrees of freedom: the error of the error is about a quarter.

/// Fewest particles in every octant for the jackknife to be made.
const FEWEST: u64 = 8;

/// Which octant of the box each particle is in.
pub(crate) fn octants(positions: &[[f64; 3]], walls: &[f64; 6]) -> Vec<usize> {
    positions
        .iter()
        .map(|x| (0..3).map(|k| usize::from(x[k] > 0.5 * (walls[2 * k] + walls[2 * k + 1])) << k).sum())
        .collect()
}

/// Standard error of Σ values/N by the jackknife over octants; nothing when an octant is nearly empty.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
pub(crate) fn standard_error(values: &[f64], octants: &[usize]) -> Option<f64> {
    let mut sums = [0.0; 8];
    let mut counts = [0_u64; 8];
    for (&value, &octant) in values.iter().zip(octants) {
        sums[octant] += value;
        counts[octant] += 1;
    }
    if counts.iter().any(|&count| count < FEWEST) {
        return None;
    }
    let (total, count) = (sums.iter().sum::<f64>(), counts.iter().sum::<u64>());
    let left_out = [0, 1, 2, 3, 4, 5, 6, 7].map(|b| (total - sums[b]) / (count - counts[b]) as f64);
    let mean = left_out.iter().sum::<f64>() / 8.0;
    let scatter: f64 = left_out.iter().map(|one| (one - mean) * (one - mean)).sum();
    Some((7.0 / 8.0 * scatter).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn independent_values_get_the_error_of_a_mean() {
        // mean over trials of the squared jackknife error against the variance 1/12/n of a mean of uniforms
        let n = 800;
        let walls = [0.0, 1.0, 0.0, 1.0, 0.0, 1.0];
        let trials = 200;
        let mut mean_square = 0.0;
        for trial in 0..trials {
            let mut stream = Stream::new(trial, 4);
            let positions: Vec<[f64; 3]> = (0..n).map(|_| [0; 3].map(|_| stream.unit())).collect();
            let values: Vec<f64> = (0..n).map(|_| stream.unit()).collect();
            let error = standard_error(&values, &octants(&positions, &walls)).unwrap();
            mean_square += error * error / trials as f64;
        }
        let expected = 1.0 / 12.0 / n as f64;
        // a χ² with 7 degrees of freedom averaged over 200 trials scatters by 4 %
        assert!((mean_square / expected - 1.0).abs() < 0.16, "{mean_square} {expected}");
    }

    #[test]
    fn too_few_particles_give_no_error() {
        assert_eq!(standard_error(&[1.0; 20], &[0; 20]), None);
    }
}
