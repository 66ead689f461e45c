//! A body on a regular grid with cubic splines: from points and markers to cells, functions and weak nodes.

use super::{Elimination, Raw, Template};
use crate::mpm::spline::{Spread, cell_of, functions, mean_gradients};

/// Nodes with less volume than this share of a cell, Σ_p N_i V_p < 0.3 h², are weak: hardly any point holds them.
const WEAK: f64 = 0.3;

/// What is put on the grid.
pub struct Scatter<'a> {
    /// Distance of neighbouring nodes; nodes lie at its integer multiples.
    pub spacing: f64,
    /// What becomes the origin of the template.
    pub origin: [f64; 2],
    /// Size of the body, the template's unit of length.
    pub size: f64,
    /// Material points in the order of [`order`].
    pub points: &'a [[f64; 2]],
    /// Their volumes.
    pub volumes: &'a [f64],
    /// Second moments of what they stand for.
    pub spreads: &'a [Spread],
    /// Outline markers.
    pub markers: &'a [[f64; 2]],
}

/// Which nodes contact may act on.
pub enum Reach<'a> {
    /// Those of every marker.
    All,
    /// Those of the markers that are near something.
    Markers(&'a [bool]),
    /// These grid nodes, sorted by (j, i).
    Nodes(&'a [[i32; 2]]),
}

/// Points sorted by cell, stable: which point comes at each place.
#[must_use]
pub fn order(points: &[[f64; 2]], spacing: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|&p| swapped(cell_of(points[p], spacing)));
    order
}

/// The grid nodes of a body, sorted by (j, i).
#[must_use]
pub fn nodes(scatter: &Scatter) -> Vec<[i32; 2]> {
    sorted(cells(scatter).iter().flat_map(|&cell| support(cell)).collect())
}

/// Cells with a point or a marker, sorted by (j, i).
fn cells(scatter: &Scatter) -> Vec<[i32; 2]> {
    let all = scatter.points.iter().chain(scatter.markers);
    sorted(all.map(|&x| cell_of(x, scatter.spacing)).collect())
}

fn swapped([i, j]: [i32; 2]) -> [i32; 2] {
    [j, i]
}

fn sorted(mut list: Vec<[i32; 2]>) -> Vec<[i32; 2]> {
    list.sort_unstable_by_key(|&at| swapped(at));
    list.dedup();
    list
}

fn support([i, j]: [i32; 2]) -> [[i32; 2]; 16] {
    std::array::from_fn(|k| [i - 1 + (k % 4) as i32, j - 1 + (k / 4) as i32])
}

/// The discretisation of a body with cubic splines.
#[must_use]
pub fn spline(scatter: &Scatter, reach: &Reach) -> Template {
    let Scatter { spacing, origin, size, points, volumes, spreads, markers } = *scatter;
    let grid = nodes(scatter);
    let place = |at: [i32; 2]| {
        let found = grid.binary_search_by_key(&swapped(at), |&node| swapped(node));
        found.expect("the support of a cell is in the grid") as u32
    };
    let occupied = cells(scatter);
    let corners: Vec<u32> = occupied.iter().flat_map(|&cell| support(cell)).map(place).collect();
    let mut first_point = vec![0_u32];
    let (mut values, mut gradients) = (Vec::new(), Vec::new());
    let mut next = 0;
    for &cell in &occupied {
        while next < points.len() && cell_of(points[next], spacing) == cell {
            values.extend(functions(points[next], spacing).1);
            let g = mean_gradients(points[next], spreads[next], spacing);
            gradients.extend(g.map(|g| [g[0] * size, g[1] * size]));
            next += 1;
        }
        first_point.push(next as u32);
    }
    assert!(next == points.len(), "points come in the order of their cells");
    let outline: Vec<Vec<(u32, f64)>> = markers
        .iter()
        .map(|&x| {
            let (low, n, _) = functions(x, spacing);
            let at = |k: usize| place([low[0] + (k % 4) as i32, low[1] + (k / 4) as i32]);
            (0..16).map(|k| (at(k), n[k])).collect()
        })
        .collect();
    let mut touched = vec![false; grid.len()];
    match reach {
        Reach::All => mark(&mut touched, outline.iter()),
        Reach::Markers(near) => {
            mark(
                &mut touched,
                outline.iter().zip(*near).filter(|(_, near)| **near).map(|(weights, _)| weights),
            );
        }
        Reach::Nodes(list) => {
            for at in *list {
                if let Ok(node) = grid.binary_search_by_key(&swapped(*at), |&node| swapped(node)) {
                    touched[node] = true;
                }
            }
        }
    }
    let unit = 1.0 / (size * size);
    let mut template = Template::assemble(Raw {
        nodes: grid
            .iter()
            .map(|at| [0, 1].map(|axis| (spacing * f64::from(at[axis]) - origin[axis]) / size))
            .collect(),
        nodes_per_cell: 16,
        cells: corners,
        first_point,
        gradients,
        values,
        volumes: volumes.iter().map(|volume| volume * unit).collect(),
        outline,
        cell: spacing / size,
        elimination: Elimination::AsNumbered(touched),
    });
    template.ghost = weak_triples(&template);
    template.grid = grid;
    template
}

fn mark<'a>(touched: &mut [bool], outline: impl Iterator<Item = &'a Vec<(u32, f64)>>) {
    outline.flatten().for_each(|&(node, _)| touched[node as usize] = true);
}

/// Three neighbours in a row, along the axes and both diagonals, with a weak node among them.
fn weak_triples(template: &Template) -> Vec<[u32; 3]> {
    let limit = WEAK * template.cell * template.cell;
    let weak: Vec<bool> = template.lumped.iter().map(|&volume| volume < limit).collect();
    let mut triples = Vec::new();
    for corners in template.cells.as_chunks::<16>().0 {
        let node = |i: usize, j: usize| corners[4 * j + i];
        for line in 0..4 {
            for start in 0..2 {
                triples.push([0, 1, 2].map(|k| node(start + k, line)));
                triples.push([0, 1, 2].map(|k| node(line, start + k)));
            }
        }
        for j in 0..2 {
            for i in 0..2 {
                triples.push([0, 1, 2].map(|k| node(i + k, j + k)));
                triples.push([0, 1, 2].map(|k| node(i + 2 - k, j + k)));
            }
        }
    }
    triples.retain(|triple| triple.iter().any(|&node| weak[node as usize]));
    triples.sort_unstable();
    triples.dedup();
    triples
}
