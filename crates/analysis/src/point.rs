//! Replicates joined to points: mean over seeds, and the scatter that gives the weights.

use crate::Run;

/// Runs that differ only in the seed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Point {
    /// The first run: scene of the point.
    pub scene: Run,
    /// Mean void ratio [1].
    pub e: f64,
    /// Standard deviation of that mean [1], if any scatter is known.
    pub e_sigma: Option<f64>,
    /// Number of replicates.
    pub replicates: usize,
    /// Void ratios of the replicates [1].
    pub values: Vec<f64>,
}

/// Degrees of freedom lent to the pooled variance when it is mixed with a point's own.
const PRIOR_DOF: f64 = 4.0;

/// The scene of a run without its seed, for grouping.
fn same_scene(a: &Run, b: &Run) -> bool {
    let numbers =
        |run: &Run| [run.p, run.sigma_c, run.sigma_e, run.alpha_n, run.mw, run.ei].map(f64::to_bits);
    numbers(a) == numbers(b) && a.variant == b.variant
}

/// Total order of scenes, so that the answer does not depend on the order of the runs.
fn order(a: &Run, b: &Run) -> std::cmp::Ordering {
    let numbers = |run: &Run| [run.p, run.sigma_e, run.sigma_c, run.alpha_n, run.mw, run.ei];
    numbers(a)
        .iter()
        .zip(numbers(b))
        .map(|(x, y)| x.total_cmp(&y))
        .find(|o| o.is_ne())
        .unwrap_or_else(|| a.variant.cmp(&b.variant).then(a.seed.cmp(&b.seed)))
}

/// Groups runs by scene. A point's variance mixes its own with the pooled one,
/// s² = (4 s_pool² + (n−1) s_own²)/(4 + n−1), and σ of the mean is s/√n: two replicates alone tell little.
pub(crate) fn group(runs: &[Run]) -> Vec<Point> {
    let mut sorted: Vec<&Run> = runs.iter().collect();
    sorted.sort_by(|a, b| order(a, b));
    let mut points: Vec<Point> = Vec::new();
    for run in sorted {
        match points.last_mut() {
            Some(point) if same_scene(&point.scene, run) => point.values.push(run.e),
            _ => points.push(Point {
                scene: run.clone(),
                e: run.e,
                e_sigma: None,
                replicates: 1,
                values: vec![run.e],
            }),
        }
    }
    let (mut squares, mut dof) = (0.0, 0.0);
    for point in &mut points {
        let n = count(point.values.len());
        point.replicates = point.values.len();
        point.e = point.values.iter().sum::<f64>() / n;
        squares += sum_of_squares(point);
        dof += n - 1.0;
    }
    if dof > 0.0 {
        let pooled = squares / dof;
        for point in &mut points {
            let n = count(point.replicates);
            let own = sum_of_squares(point);
            let variance = (PRIOR_DOF * pooled + own) / (PRIOR_DOF + n - 1.0);
            let within = point.scene.e_se.unwrap_or(0.0);
            let sigma = (variance / n).sqrt().max(within);
            point.e_sigma = (sigma > 0.0).then_some(sigma);
        }
    }
    points
}

fn sum_of_squares(point: &Point) -> f64 {
    point.values.iter().map(|value| (value - point.e).powi(2)).sum()
}

/// A count as a real number.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
pub(crate) fn count(n: usize) -> f64 {
    n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(sigma_c: f64, seed: u64, e: f64) -> Run {
        Run { p: 1e5, sigma_e: 1e10, sigma_c, seed, e, ..Run::default() }
    }

    #[test]
    fn replicates_become_one_point_with_shrunk_variance() {
        let runs = [run(1e6, 1, 1.0), run(3e6, 1, 1.2), run(1e6, 2, 1.02), run(3e6, 2, 1.26)];
        let points = group(&runs);
        assert_eq!(points.len(), 2);
        assert!((points[0].e - 1.01).abs() < 1e-12 && (points[1].e - 1.23).abs() < 1e-12);
        // own sums of squares 2e-4 and 1.8e-3, pooled variance 1e-3
        let expected = |own: f64| ((4.0 * 1e-3 + own) / 5.0 / 2.0_f64).sqrt();
        assert!((points[0].e_sigma.unwrap() - expected(2e-4)).abs() < 1e-12);
        assert!((points[1].e_sigma.unwrap() - expected(1.8e-3)).abs() < 1e-12);
    }

    #[test]
    fn without_replicates_no_scatter_is_claimed() {
        let points = group(&[run(1e6, 1, 1.0), run(3e6, 1, 1.2)]);
        assert!(points.iter().all(|point| point.e_sigma.is_none() && point.replicates == 1));
        let shuffled = group(&[run(3e6, 1, 1.2), run(1e6, 1, 1.0)]);
        assert_eq!(points, shuffled);
    }
}
