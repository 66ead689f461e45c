//! Material points, four per cell or as many as asked for, with the volume that their part of the cell has inside the
//! body.

use super::Spread;

/// Material points of an undeformed body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fill {
    /// Positions.
    pub positions: Vec<[f64; 2]>,
    /// Volumes (areas per unit thickness).
    pub volumes: Vec<f64>,
    /// Second moments over the area of what each point stands for, about the point.
    pub spreads: Vec<Spread>,
}

impl Fill {
    /// The same points in another order.
    #[must_use]
    pub fn permuted(&self, order: &[usize]) -> Self {
        Self {
            positions: order.iter().map(|&p| self.positions[p]).collect(),
            volumes: order.iter().map(|&p| self.volumes[p]).collect(),
            spreads: order.iter().map(|&p| self.spreads[p]).collect(),
        }
    }
}

/// Strips across a part of a cell that is cut by the outline.
const STRIPS: usize = 32;

/// Least share of such a part that makes a point; what smaller slivers hold is spread over all points.
const SLIVER: f64 = 0.02;

/// A disc: `across` points side by side in a cell, each at the centroid of what of its part of the cell lies inside and
/// with its area. With equal volumes instead, the outline is a staircase, which costs up to 10 % of force at small strain
/// with quarter cells. Volumes are scaled to the exact area π R².
#[must_use]
pub fn disc(centre: [f64; 2], radius: f64, spacing: f64, across: u32) -> Fill {
    let part = spacing / f64::from(across);
    let range = |axis: usize| {
        let low = ((centre[axis] - radius) / part).floor();
        let high = ((centre[axis] + radius) / part).ceil();
        #[expect(clippy::cast_possible_truncation, reason = "a body is far smaller than 2³¹ cells")]
        (low as i32, high as i32)
    };
    let mut fill = Fill::default();
    for j in range(1).0..range(1).1 {
        for i in range(0).0..range(0).1 {
            let low = [part * f64::from(i) - centre[0], part * f64::from(j) - centre[1]];
            let (area, at, spread) = inside(low, part, radius);
            if area > SLIVER * part * part {
                fill.positions.push([centre[0] + at[0], centre[1] + at[1]]);
                fill.volumes.push(area);
                fill.spreads.push(spread);
            }
        }
    }
    let scale = std::f64::consts::PI * radius * radius / fill.volumes.iter().sum::<f64>();
    fill.volumes.iter_mut().for_each(|volume| *volume *= scale);
    fill
}

/// Area, centroid and second moments of the part of a square inside a circle round the origin.
fn inside(low: [f64; 2], side: f64, radius: f64) -> (f64, [f64; 2], Spread) {
    let corner = |i: usize, j: usize| libm::hypot(low[0] + i as f64 * side, low[1] + j as f64 * side);
    if [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().all(|(i, j)| corner(i, j) <= radius) {
        return (side * side, [low[0] + 0.5 * side, low[1] + 0.5 * side], square(side));
    }
    let (mut area, mut moment, mut second) = (0.0, [0.0; 2], [0.0; 3]);
    let width = side / STRIPS as f64;
    for k in 0..STRIPS {
        let x = low[0] + (k as f64 + 0.5) * width;
        let reach = (radius * radius - x * x).max(0.0).sqrt();
        let (from, to) = (low[1].max(-reach), (low[1] + side).min(reach));
        if to > from {
            let strip = width * (to - from);
            area += strip;
            moment[0] += strip * x;
            moment[1] += strip * 0.5 * (from + to);
            second[0] += strip * (x * x + width * width / 12.0);
            second[1] += strip * x * 0.5 * (from + to);
            second[2] += strip * (from * from + from * to + to * to) / 3.0;
        }
    }
    if area > 0.0 {
        let [x, y] = moment.map(|one| one / area);
        let [xx, xy, yy] = second.map(|one| one / area);
        (area, [x, y], [xx - x * x, xy - x * y, yy - y * y])
    } else {
        (0.0, [0.0; 2], [0.0; 3])
    }
}

/// Second moments of a square.
fn square(side: f64) -> Spread {
    [side * side / 12.0, 0.0, side * side / 12.0]
}

/// A rectangle of whole cells, its corners on nodes.
#[must_use]
pub fn block(low: [i32; 2], cells: [i32; 2], spacing: f64) -> Fill {
    let mut fill = Fill::default();
    for j in 0..2 * cells[1] {
        for i in 0..2 * cells[0] {
            let at = [f64::from(low[0]) + 0.25, f64::from(low[1]) + 0.25];
            fill.positions
                .push([spacing * (at[0] + 0.5 * f64::from(i)), spacing * (at[1] + 0.5 * f64::from(j))]);
            fill.volumes.push(0.25 * spacing * spacing);
            fill.spreads.push(square(0.5 * spacing));
        }
    }
    fill
}

/// Outline markers of a disc, counter-clockwise, about half a cell apart and a multiple of four; `turn` in spacings.
#[must_use]
pub fn circle(centre: [f64; 2], radius: f64, spacing: f64, turn: f64) -> Vec<[f64; 2]> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive and small")]
    let count = 4 * (std::f64::consts::PI * radius / spacing).ceil() as usize;
    let at = |k: usize| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * (k as f64 + turn) / count as f64);
        [centre[0] + radius * cos, centre[1] + radius * sin]
    };
    (0..count).map(at).collect()
}

/// Outline markers of a rectangle of whole cells, two per cell.
#[must_use]
pub fn rim(low: [i32; 2], cells: [i32; 2], spacing: f64) -> Vec<[f64; 2]> {
    let (w, h) = (2 * cells[0], 2 * cells[1]);
    let way = (0..w).map(|i| (i, 0)).chain((0..h).map(|j| (w, j)));
    let back = (0..w).map(|i| (w - i, h)).chain((0..h).map(|j| (0, h - j)));
    way.chain(back)
        .map(|(i, j)| {
            [
                spacing * (f64::from(low[0]) + 0.5 * f64::from(i)),
                spacing * (f64::from(low[1]) + 0.5 * f64::from(j)),
            ]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_quarter_has_the_area_and_the_centroid_inside() {
        // a quarter circle of radius 1 in its square: π/4 and 4/(3π)
        let (area, at, spread) = inside([0.0, 0.0], 1.0, 1.0);
        assert!((area / std::f64::consts::FRAC_PI_4 - 1.0).abs() < 1e-3, "{area}");
        let exact = 4.0 / (3.0 * std::f64::consts::PI);
        assert!((at[0] / exact - 1.0).abs() < 1e-3 && (at[1] / exact - 1.0).abs() < 1e-3, "{at:?}");
        // ∫ x² = π/16 and ∫ x y = 1/8 over the quarter circle
        let about = [0.25 - exact * exact, 0.5 / std::f64::consts::PI - exact * exact];
        assert!(
            (spread[0] / about[0] - 1.0).abs() < 3e-3 && (spread[2] / about[0] - 1.0).abs() < 3e-3,
            "{spread:?}"
        );
        assert!((spread[1] / about[1] - 1.0).abs() < 1e-2, "{spread:?}");
        assert_eq!(inside([0.8, 0.8], 1.0, 1.0).0, 0.0);
    }

    #[test]
    fn a_disc_has_its_moments_wherever_it_lies_on_the_grid() {
        for (centre, across) in
            [[0.0, 0.0], [0.03, -0.41]].into_iter().flat_map(|c| (2..5).map(move |k| (c, k)))
        {
            let fill = disc(centre, 0.5, 1.0 / 12.0, across);
            let sum = |of: &dyn Fn([f64; 2]) -> f64| -> f64 {
                fill.positions.iter().zip(&fill.volumes).map(|(&x, v)| v * of(x)).sum()
            };
            let area = std::f64::consts::FRAC_PI_4;
            assert!((sum(&|_| 1.0) - area).abs() < 1e-12);
            // as many as parts of cells fit into the area, and some of those that the outline cuts
            let (parts, rim) = (area * f64::from(144 * across * across), f64::from(48 * across));
            let more = fill.positions.len() as f64 - parts;
            assert!(more > 0.0 && more < rim, "{across} across: {more} more than {parts}");
            let first = [0, 1].map(|axis| sum(&|x| x[axis] - centre[axis]));
            // 75 k/2 cut parts of mean area (h/k)²/2, each right to 1e-3, at a distance of 1/2
            assert!(
                first.iter().all(|moment| moment.abs() < 6.6e-5 / f64::from(across)),
                "{across} across: {first:?}"
            );
            // ∫ x² = π R⁴/4, with the moments of what each point stands for
            let second = sum(&|x| (x[0] - centre[0]) * (x[0] - centre[0]));
            let own: f64 = fill.spreads.iter().zip(&fill.volumes).map(|(spread, v)| v * spread[0]).sum();
            assert!(((second + own) / (area / 16.0) - 1.0).abs() < 5e-4, "{second} {own}");
        }
    }
}
