//! Cubic B-splines on a regular grid of square cells, and how a body is filled with material points.

mod fill;

pub use fill::{Fill, block, circle, disc, rim};

/// Value and slope of the four cubic B-splines that reach a place `share` (0 … 1) of the way through a cell; slopes by
/// the grid coordinate. N(r) = 2/3 − r² + |r|³/2 for |r| < 1, (2 − |r|)³/6 for 1 ≤ |r| < 2.
#[inline]
#[must_use]
pub fn weights(share: f64) -> ([f64; 4], [f64; 4]) {
    let (s, t) = (share, 1.0 - share);
    let value = [
        t * t * t / 6.0,
        2.0 / 3.0 - s * s * (1.0 - 0.5 * s),
        2.0 / 3.0 - t * t * (1.0 - 0.5 * t),
        s * s * s / 6.0,
    ];
    let slope = [-0.5 * t * t, s * (1.5 * s - 2.0), t * (2.0 - 1.5 * t), 0.5 * s * s];
    (value, slope)
}

/// The 16 functions that reach `x`: lowest node, values and gradients in space; node 4j + i is i to the right and j up.
#[must_use]
pub fn functions(x: [f64; 2], spacing: f64) -> ([i32; 2], [f64; 16], [[f64; 2]; 16]) {
    let cell = cell_of(x, spacing);
    let along = [0, 1].map(|axis| weights(x[axis] / spacing - f64::from(cell[axis])));
    let [(nx, gx), (ny, gy)] = along;
    let mut values = [0.0; 16];
    let mut gradients = [[0.0; 2]; 16];
    for j in 0..4 {
        for i in 0..4 {
            values[4 * j + i] = nx[i] * ny[j];
            gradients[4 * j + i] = [gx[i] * ny[j] / spacing, nx[i] * gy[j] / spacing];
        }
    }
    ([cell[0] - 1, cell[1] - 1], values, gradients)
}

/// Second and third derivative of the same four, by the grid coordinate.
fn bends(share: f64) -> ([f64; 4], [f64; 4]) {
    let (s, t) = (share, 1.0 - share);
    ([t, 3.0 * s - 2.0, 3.0 * t - 2.0, s], [-1.0, 3.0, -3.0, 1.0])
}

/// Second moments (xx, xy, yy) over its area of what a material point stands for, about its centroid.
pub type Spread = [f64; 3];

/// The gradients of [`functions`] in the mean over a small domain round `x`, ∇N + ½ M : ∇∇∇N with its moments M.
///
/// With the gradient at the point alone a stress is integrated by the midpoint rule. Inside a body its errors cancel
/// between points; where an edge cuts the functions they do not, and the nodal forces of a uniform stress miss the load on
/// that edge by a fixed share of a cell. The mean over the domains is exact as long as these fill the body, and keeps what
/// the plain gradients have: Σ ∇N = 0 and Σ ∇N ⊗ x_i = I. Terms of fourth order, but for M_xx M_yy, are left out.
#[must_use]
pub fn mean_gradients(x: [f64; 2], spread: Spread, spacing: f64) -> [[f64; 2]; 16] {
    let cell = cell_of(x, spacing);
    let unit = 1.0 / (spacing * spacing);
    let [xx, xy, yy] = spread.map(|one| one * unit);
    let along = |axis: usize, m: f64| {
        let share = x[axis] / spacing - f64::from(cell[axis]);
        let ((value, slope), (second, third)) = (weights(share), bends(share));
        let mean = |k: usize| [value[k] + 0.5 * m * second[k], slope[k] + 0.5 * m * third[k]];
        (std::array::from_fn::<_, 4, _>(mean), slope, second)
    };
    let ((nx, sx, bx), (ny, sy, by)) = (along(0, xx), along(1, yy));
    std::array::from_fn(|k| {
        let (i, j) = (k % 4, k / 4);
        let g = [nx[i][1] * ny[j][0] + xy * bx[i] * sy[j], nx[i][0] * ny[j][1] + xy * sx[i] * by[j]];
        g.map(|one| one / spacing)
    })
}

/// The cell a point lies in; cell (i, j) spans from node (i, j) to node (i + 1, j + 1).
#[inline]
#[must_use]
pub fn cell_of(x: [f64; 2], spacing: f64) -> [i32; 2] {
    #[expect(clippy::cast_possible_truncation, reason = "a body is far smaller than 2³¹ cells")]
    x.map(|one| (one / spacing).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_reproduce_quadratics_and_slopes_are_derivatives() {
        let h = 0.3;
        for x in [[0.1, -0.2], [0.299, 0.6], [-1.0, 2.05]] {
            let (low, n, g) = functions(x, h);
            let sum = |of: &dyn Fn(usize, [f64; 2]) -> f64| -> f64 {
                (0..16)
                    .map(|k| {
                        let node =
                            [low[0] + (k % 4) as i32, low[1] + (k / 4) as i32].map(|i| h * f64::from(i));
                        of(k, node)
                    })
                    .sum()
            };
            assert!((sum(&|k, _| n[k]) - 1.0).abs() < 1e-14);
            assert!((sum(&|k, at| n[k] * at[0]) - x[0]).abs() < 1e-14);
            assert!((sum(&|k, at| g[k][1] * at[1]) - 1.0).abs() < 1e-13);
            assert!(sum(&|k, at| g[k][0] * at[1]).abs() < 1e-13);
            // Σ N x_i² = x² + h²/3: the moment that makes affine transfer exact
            let second = sum(&|k, at| n[k] * (at[0] - x[0]) * (at[0] - x[0]));
            assert!((second - h * h / 3.0).abs() < 1e-14, "{second}");
        }
        let d = 1e-6;
        for share in [0.1, 0.5, 0.9] {
            let (at, up, down) = (weights(share), weights(share + d), weights(share - d));
            let (bend, up_bend, down_bend) = (bends(share), bends(share + d).0, bends(share - d).0);
            for k in 0..4 {
                assert!((at.1[k] - (up.0[k] - down.0[k]) / (2.0 * d)).abs() < 1e-9);
                assert!((bend.0[k] - (up.1[k] - down.1[k]) / (2.0 * d)).abs() < 1e-9);
                assert!((bend.1[k] - (up_bend[k] - down_bend[k]) / (2.0 * d)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn mean_gradients_are_means_over_the_domain() {
        // a parallelogram inside one cell, 2 × 2 Gauss points: exact up to the terms of fourth order, which for this size
        // are below 2e-5 of the gradients
        let (h, at, edges) = (0.3, [0.16, 0.74], [[0.06, 0.02], [-0.03, 0.05]]);
        let mut exact = [[0.0; 2]; 16];
        for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let g = 0.5 / f64::sqrt(3.0);
            let x = [0, 1].map(|i| at[i] + g * (a * edges[0][i] + b * edges[1][i]));
            for (sum, g) in exact.iter_mut().zip(functions(x, h).2) {
                *sum = [sum[0] + 0.25 * g[0], sum[1] + 0.25 * g[1]];
            }
        }
        let moment = |i: usize, j: usize| edges.iter().map(|e| e[i] * e[j]).sum::<f64>() / 12.0;
        let found = mean_gradients(at, [moment(0, 0), moment(0, 1), moment(1, 1)], h);
        let worst = |g: &[[f64; 2]; 16]| {
            let off = g.iter().zip(&exact).flat_map(|(a, b)| [(a[0] - b[0]).abs(), (a[1] - b[1]).abs()]);
            off.fold(0.0, f64::max) * h
        };
        assert!(worst(&found) < 2e-5 && worst(&functions(at, h).2) > 1e-3, "{}", worst(&found));
        // they still sum to nothing and reproduce an affine motion, for any moments
        let low = functions(at, h).0;
        let node = |k: usize| [low[0] + (k % 4) as i32, low[1] + (k / 4) as i32].map(|i| h * f64::from(i));
        let sum = |of: &dyn Fn(usize) -> f64| (0..16).map(of).sum::<f64>();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            assert!(sum(&|k| found[k][j]).abs() < 1e-12);
            let unit = if i == j { 1.0 } else { 0.0 };
            assert!((sum(&|k| found[k][j] * node(k)[i]) - unit).abs() < 1e-12);
        }
    }
}
