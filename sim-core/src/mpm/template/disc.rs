//! Body-fitted cells of a disc: a square core inside rings (O-grid).

use super::{Parts, Reach, Scatter, Template, cell_order, spline};
use crate::mpm::spline as functions;

/// A unit disc with `across` cells along a diameter (even, at least 2): a core of 2a × 2a cells inside r rings with
/// 2(a + r) = `across`, a ≈ 0.4 `across`. Markers lie on the nodes and on the middles of the outer edges, interpolated
/// by cubics through four neighbouring boundary nodes: with 40 edges the outline is a circle to 2·10⁻⁵ of its radius,
/// not a polygon.
///
/// The mesh is turned by a quarter of an edge: outline markers then meet a flat partner one after the other, not in
/// pairs, which halves the steps of the force as contacts grow.
#[must_use]
pub fn disc(across: usize) -> Template {
    turned(across, 0.25)
}

/// The same mesh with nodes on both axes, for scenes with planes of symmetry.
#[must_use]
pub fn symmetric_disc(across: usize) -> Template {
    turned(across, 0.0)
}

/// A unit disc on a regular grid of cubic splines, `across` cells along a diameter (even), a node in the centre,
/// `points` material points across a cell;
/// cells that the outline cuts have points for what lies inside.
#[must_use]
pub fn cubic_disc(across: usize, points: u32) -> Template {
    gridded(across, points, 0.25)
}

/// The same with markers that are symmetric about both axes.
#[must_use]
pub fn symmetric_cubic_disc(across: usize, points: u32) -> Template {
    gridded(across, points, 0.0)
}

fn gridded(across: usize, points: u32, turn: f64) -> Template {
    assert!(across >= 2 && across.is_multiple_of(2), "cells across the diameter: even, at least 2");
    let spacing = 2.0 / across as f64;
    let fill = functions::disc([0.0; 2], 1.0, spacing, points);
    let fill = fill.permuted(&cell_order(&fill.positions, spacing));
    let markers = functions::circle([0.0; 2], 1.0, spacing, turn);
    let scatter = Scatter {
        spacing,
        origin: [0.0; 2],
        size: 1.0,
        points: &fill.positions,
        volumes: &fill.volumes,
        spreads: &fill.spreads,
        markers: &markers,
    };
    spline(&scatter, &Reach::All)
}

/// `turn` in edges of the outline.
fn turned(across: usize, turn: f64) -> Template {
    assert!(across >= 2 && across.is_multiple_of(2), "cells across the diameter: even, at least 2");
    let half = ((0.4 * across as f64).round() as usize).clamp(1, (across / 2 - 1).max(1));
    let rings = across / 2 - half;
    let side = 2 * half + 1;
    let edges = 8 * half;
    let mut nodes = Vec::with_capacity(side * side + rings * edges);
    for j in 0..side {
        for i in 0..side {
            let unit = |index: usize| index as f64 / half as f64 - 1.0;
            nodes.push(rounded_square(unit(i), unit(j), half as f64 / (half + rings) as f64));
        }
    }
    let core = |i: usize, j: usize| (j * side + i) as u32;
    let perimeter: Vec<u32> = (0..2 * half)
        .map(|i| core(i, 0))
        .chain((0..2 * half).map(|j| core(2 * half, j)))
        .chain((0..2 * half).map(|i| core(2 * half - i, 2 * half)))
        .chain((0..2 * half).map(|j| core(0, 2 * half - j)))
        .collect();
    let ring = |level: usize, j: usize| match level {
        0 => perimeter[j % edges],
        _ => (side * side + (level - 1) * edges + j % edges) as u32,
    };
    let on_circle = |j: usize| {
        let angle = std::f64::consts::TAU * (j as f64 / edges as f64 - 0.375);
        [libm::cos(angle), libm::sin(angle)]
    };
    for level in 1..=rings {
        for j in 0..edges {
            let (inner, outer) = (nodes[perimeter[j] as usize], on_circle(j));
            let share = level as f64 / rings as f64;
            nodes.push([0, 1].map(|axis| inner[axis] * (1.0 - share) + outer[axis] * share));
        }
    }
    for j in 0..edges {
        nodes[ring(rings, j) as usize] = on_circle(j);
    }
    let mut cells = Vec::new();
    for j in 0..2 * half {
        for i in 0..2 * half {
            cells.push([core(i, j), core(i + 1, j), core(i + 1, j + 1), core(i, j + 1)]);
        }
    }
    for level in 0..rings {
        for j in 0..edges {
            cells.push([ring(level, j), ring(level + 1, j), ring(level + 1, j + 1), ring(level, j + 1)]);
        }
    }
    let boundary: Vec<u32> = (0..edges).map(|j| ring(rings, j)).collect();
    smooth(&mut nodes, &cells, &boundary);
    let (sin, cos) = libm::sincos(turn * std::f64::consts::TAU / edges as f64);
    nodes.iter_mut().for_each(|x| *x = [x[0] * cos - x[1] * sin, x[0] * sin + x[1] * cos]);
    let markers = (0..edges)
        .flat_map(|j| {
            let node = |shift: usize| boundary[(j + edges + shift - 1) % edges];
            let middle = vec![
                (node(0), -1.0 / 16.0),
                (node(1), 9.0 / 16.0),
                (node(2), 9.0 / 16.0),
                (node(3), -1.0 / 16.0),
            ];
            [vec![(node(1), 1.0)], middle]
        })
        .collect();
    Template::bilinear(Parts { nodes, cells, markers, area: std::f64::consts::PI, cell: 2.0 / across as f64 })
}

/// A point of the core: between a square and the disc it would fill.
fn rounded_square(x: f64, y: f64, size: f64) -> [f64; 2] {
    let round = [x * (1.0 - 0.5 * y * y).sqrt(), y * (1.0 - 0.5 * x * x).sqrt()];
    [0.5 * size * (0.85 * x + round[0]), 0.5 * size * (0.85 * y + round[1])]
}

/// Moves inner nodes towards the mean of their neighbours, all at once so that the symmetry of the disc is kept.
fn smooth(nodes: &mut [[f64; 2]], cells: &[[u32; 4]], fixed: &[u32]) {
    let mut free = vec![true; nodes.len()];
    fixed.iter().for_each(|&node| free[node as usize] = false);
    for _ in 0..200 {
        let mut sum = vec![[0.0; 3]; nodes.len()];
        for corners in cells {
            for k in 0..4 {
                let (a, b) = (corners[k] as usize, corners[(k + 1) % 4] as usize);
                for (to, from) in [(a, b), (b, a)] {
                    sum[to][0] += nodes[from][0];
                    sum[to][1] += nodes[from][1];
                    sum[to][2] += 1.0;
                }
            }
        }
        for ((node, sum), _) in nodes.iter_mut().zip(&sum).zip(&free).filter(|(_, free)| **free) {
            *node = [0.5 * (node[0] + sum[0] / sum[2]), 0.5 * (node[1] + sum[1] / sum[2])];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn area_counts_and_shape() {
        for across in [2, 4, 6, 8, 12, 16, 24] {
            let t = disc(across);
            assert!((t.volumes.iter().sum::<f64>() - std::f64::consts::PI).abs() < 1e-12);
            assert!((t.lumped.iter().sum::<f64>() - std::f64::consts::PI).abs() < 1e-12);
            let (least, most) = t.volumes.iter().fold((f64::MAX, 0.0_f64), |(a, b), &v| (a.min(v), b.max(v)));
            assert!(least > 0.0 && most / least < 12.0, "{across}: {least} {most}");
            let furthest = t
                .markers
                .iter()
                .map(|marker| {
                    let x = [0, 1].map(|axis| {
                        let at =
                            |&(n, w): &(u32, f64)| w * t.nodes[t.contact_nodes[n as usize] as usize][axis];
                        marker.weights.iter().map(at).sum::<f64>()
                    });
                    (libm::hypot(x[0], x[1]) - 1.0).abs()
                })
                .fold(0.0, f64::max);
            assert!(furthest < 0.6 / (across as f64).powi(4) * 16.0, "{across}: {furthest}");
        }
        let t = disc(12);
        assert_eq!((t.cell_count(), t.point_count(), t.nodes.len(), t.markers.len()), (140, 560, 161, 80));
    }

    #[test]
    fn functions_sum_to_one_and_reproduce_linear_fields() {
        let t = disc(12);
        for (cell, corners) in t.cells.chunks_exact(4).enumerate() {
            for p in t.first_point[cell] as usize..t.first_point[cell + 1] as usize {
                let mut gradient = [[0.0; 2]; 2];
                for (a, &node) in corners.iter().enumerate() {
                    let (g, x) = (t.gradients[4 * p + a], t.nodes[node as usize]);
                    for i in 0..2 {
                        for j in 0..2 {
                            gradient[i][j] += x[i] * g[j];
                        }
                    }
                }
                assert!((t.values[4 * p..4 * p + 4].iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!((gradient[0][0] - 1.0).abs() < 1e-12 && gradient[0][1].abs() < 1e-12);
                assert!((gradient[1][1] - 1.0).abs() < 1e-12 && gradient[1][0].abs() < 1e-12);
            }
        }
    }
}
