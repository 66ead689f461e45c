//! Non-negative least squares on the normal equations (Lawson & Hanson 1974, ch. 23), with free variables first.

use nalgebra::{DMatrix, DVector};

/// Minimises xᵀ G x/2 − rᵀ x with x_i ≥ 0 for i ≥ `free`.
pub(super) fn solve(gram: &DMatrix<f64>, right: &DVector<f64>, free: usize) -> DVector<f64> {
    let size = right.len();
    let mut passive: Vec<usize> = (0..free).collect();
    let mut x = restricted(gram, right, &passive);
    let tolerance = 1e-11 * right.amax().max(f64::MIN_POSITIVE);
    for _ in 0..8 * size {
        let slope = right - gram * &x;
        let best = (free..size)
            .filter(|i| !passive.contains(i) && slope[*i] > tolerance)
            .max_by(|a, b| slope[*a].total_cmp(&slope[*b]));
        let Some(best) = best else { break };
        passive.push(best);
        passive.sort_unstable();
        loop {
            let trial = restricted(gram, right, &passive);
            let blocked = |i: &usize| *i >= free && trial[*i] <= 0.0;
            if !passive.iter().any(blocked) {
                x = trial;
                break;
            }
            let step = passive
                .iter()
                .filter(|i| blocked(i))
                .map(|&i| if x[i] > trial[i] { x[i] / (x[i] - trial[i]) } else { 0.0 })
                .fold(1.0_f64, f64::min);
            x += step * (trial - &x);
            let before = passive.len();
            passive.retain(|&i| i < free || x[i] > 1e-13 * x.amax());
            for i in free..size {
                if !passive.contains(&i) {
                    x[i] = 0.0;
                }
            }
            if passive.len() == before {
                return x;
            }
        }
    }
    x
}

/// Solution with only the passive variables; a ridge of 1e-12 of the diagonal keeps empty knot spans harmless.
fn restricted(gram: &DMatrix<f64>, right: &DVector<f64>, passive: &[usize]) -> DVector<f64> {
    let count = passive.len();
    let ridge = 1e-12 * gram.diagonal().amax().max(f64::MIN_POSITIVE);
    let part = DMatrix::from_fn(count, count, |i, j| {
        gram[(passive[i], passive[j])] + if i == j { ridge } else { 0.0 }
    });
    let side = DVector::from_fn(count, |i, _| right[passive[i]]);
    let mut full = DVector::zeros(right.len());
    if let Some(factor) = part.cholesky() {
        for (i, value) in passive.iter().zip(factor.solve(&side).iter()) {
            full[*i] = *value;
        }
    }
    full
}
