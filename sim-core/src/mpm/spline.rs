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
            let (slope, up, down) = (weights(share).1, weights(share + d).0, weights(share - d).0);
            for k in 0..4 {
                assert!((slope[k] - (up[k] - down[k]) / (2.0 * d)).abs() < 1e-9);
            }
        }
    }
}
