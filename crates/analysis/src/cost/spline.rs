//! Clamped cubic B-splines.

/// Cubic B-spline basis on clamped knots.
pub(super) struct Spline {
    /// First and last knot four times.
    knots: Vec<f64>,
}

impl Spline {
    /// Knots at quantiles of u; nothing when all u coincide.
    pub fn with_quantile_knots(u: &[f64], intervals: usize) -> Option<Self> {
        let mut sorted = u.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (low, high) = (*sorted.first()?, *sorted.last()?);
        if high <= low {
            return None;
        }
        let mut knots = vec![low; 4];
        for k in 1..intervals {
            #[expect(clippy::cast_precision_loss, reason = "a handful of knots")]
            let q = k as f64 / intervals as f64;
            let knot = crate::estimate::quantile_sorted(&sorted, q);
            // tied data would make empty spans; their basis functions are then held by the ridge of the solver
            knots.push(knot.clamp(low, high));
        }
        knots.extend([high; 4]);
        Some(Self { knots })
    }

    /// Number of basis functions.
    pub fn coefficients(&self) -> usize {
        self.knots.len() - 4
    }

    /// Index of the first of the four non-zero functions at u, and their values (Cox–de Boor).
    pub fn basis(&self, u: f64) -> (usize, [f64; 4]) {
        let last = self.coefficients();
        let mut span = 3;
        while span + 1 < last && u >= self.knots[span + 1] {
            span += 1;
        }
        let mut values = [1.0, 0.0, 0.0, 0.0];
        let (mut left, mut right) = ([0.0; 4], [0.0; 4]);
        for degree in 1..4 {
            left[degree] = u - self.knots[span + 1 - degree];
            right[degree] = self.knots[span + degree] - u;
            let mut saved = 0.0;
            for r in 0..degree {
                let width = right[r + 1] + left[degree - r];
                let part = if width > 0.0 { values[r] / width } else { 0.0 };
                values[r] = saved + right[r + 1] * part;
                saved = left[degree - r] * part;
            }
            values[degree] = saved;
        }
        (span - 3, values)
    }
}
