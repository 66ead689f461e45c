//! The discretisation of a body in its reference configuration, at unit size: cells, material points with their
//! weights and gradients, the outline markers, the elimination order. Computed once, shared by all bodies of a shape.

mod block;
mod disc;
mod order;
mod spline;

pub use block::block;
pub use disc::{cubic_disc, disc, symmetric_cubic_disc, symmetric_disc};
pub use spline::{Reach, Scatter, nodes, order as cell_order, spline};

use super::real::Quad;
use super::skyline::Profile;

/// A body's discretisation. Lengths are in units of the body's size (the radius of a disc).
#[derive(Clone, Debug)]
pub struct Template {
    /// Reference positions of the nodes.
    pub nodes: Vec<[f64; 2]>,
    /// Nodes per cell: 4 (bilinear) or 16 (cubic splines).
    pub nodes_per_cell: usize,
    /// Nodes of each cell, `nodes_per_cell` at a time.
    pub cells: Vec<u32>,
    /// First material point of each cell, and the number of points at the end.
    pub first_point: Vec<u32>,
    /// Reference gradients ∇_X N_a at each point, `nodes_per_cell` at a time.
    pub gradients: Vec<[f64; 2]>,
    /// Shape functions N_a at each point, `nodes_per_cell` at a time.
    pub values: Vec<f64>,
    /// Reference volume of each point (area per unit thickness).
    pub volumes: Vec<f64>,
    /// Lumped Σ_p N_a V_p of each node.
    pub lumped: Vec<f64>,
    /// Outline markers, counter-clockwise.
    pub markers: Vec<Marker>,
    /// The nodes that markers hang on or contact acts on; markers name them by their place in this list.
    pub contact_nodes: Vec<u32>,
    /// Elimination order of the degrees of freedom and fill of the factor; contact nodes come last.
    pub profile: Profile,
    /// Place in the matrix of every entry of a cell's lower triangle, row by row.
    pub entries: Vec<u32>,
    /// Place in the contact block of component x of each contact node; y follows. [`OUT_OF_REACH`] for nodes that
    /// contact does not act on.
    pub contact_rows: Vec<u32>,
    /// Rows of three neighbouring nodes with a weak one among them, for the ghost penalty; empty where cells fit.
    pub ghost: Vec<[u32; 3]>,
    /// Grid indices of the nodes, sorted by (j, i); empty where the mesh is not a regular grid.
    pub grid: Vec<[i32; 2]>,
    /// Typical cell width.
    pub cell: f64,
    /// Gradients and volumes of bilinear cells, four points side by side; empty for other functions.
    pub lanes: Vec<Lanes>,
}

/// Contact row of a node that contact does not act on.
pub const OUT_OF_REACH: u32 = u32::MAX;

/// A bilinear cell with its points side by side.
#[derive(Clone, Copy, Debug)]
pub struct Lanes {
    /// ∇_X N_a of each node, by component.
    pub gradients: [[Quad; 2]; 4],
    /// Reference volumes.
    pub volumes: Quad,
}

/// A point of the outline, carried by a few nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Index into [`Template::contact_nodes`] and weight; the weights sum to one.
    pub weights: Vec<(u32, f64)>,
}

/// What every family of functions provides; the rest follows.
struct Raw {
    nodes: Vec<[f64; 2]>,
    nodes_per_cell: usize,
    cells: Vec<u32>,
    first_point: Vec<u32>,
    gradients: Vec<[f64; 2]>,
    values: Vec<f64>,
    volumes: Vec<f64>,
    /// Markers as node weights, node numbers still global.
    outline: Vec<Vec<(u32, f64)>>,
    cell: f64,
    elimination: Elimination,
}

/// Order of elimination.
enum Elimination {
    /// From the far inside outwards; contact acts on every node of a marker.
    InteriorFirst,
    /// By number, row after row of a grid, the nodes that contact acts on last.
    AsNumbered(Vec<bool>),
}

/// Parts of a template that a shape must provide; the rest follows.
struct Parts {
    nodes: Vec<[f64; 2]>,
    cells: Vec<[u32; 4]>,
    /// Outline as loops of node weights, node numbers still global.
    markers: Vec<Vec<(u32, f64)>>,
    area: f64,
    cell: f64,
}

impl Template {
    /// Number of cells.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.first_point.len() - 1
    }

    /// Number of material points.
    #[must_use]
    pub fn point_count(&self) -> usize {
        self.volumes.len()
    }

    /// Bilinear cells with 2 × 2 Gauss points; volumes are scaled so that their sum is the exact area.
    fn bilinear(parts: Parts) -> Self {
        let Parts { nodes, cells, markers, area, cell } = parts;
        let (mut gradients, mut values, mut volumes) = (Vec::new(), Vec::new(), Vec::new());
        for corners in &cells {
            let x = corners.map(|node| nodes[node as usize]);
            for (xi, eta) in GAUSS {
                let (n, g, jacobian) = isoparametric(&x, xi, eta);
                values.extend(n);
                gradients.extend(g);
                volumes.push(jacobian);
            }
        }
        let scale = area / volumes.iter().sum::<f64>();
        volumes.iter_mut().for_each(|volume| *volume *= scale);
        let first_point = (0..=cells.len()).map(|cell| 4 * cell as u32).collect();
        let cells: Vec<u32> = cells.into_iter().flatten().collect();
        Self::assemble(Raw {
            nodes,
            nodes_per_cell: 4,
            cells,
            first_point,
            gradients,
            values,
            volumes,
            outline: markers,
            cell,
            elimination: Elimination::InteriorFirst,
        })
    }

    /// Whether contact can act on all nodes of a marker.
    #[must_use]
    pub fn reaches(&self, marker: u32) -> bool {
        let weights = &self.markers[marker as usize].weights;
        weights.iter().all(|&(place, _)| self.contact_rows[place as usize] != OUT_OF_REACH)
    }

    fn assemble(raw: Raw) -> Self {
        let Raw { nodes, nodes_per_cell, cells, first_point, gradients, values, volumes, .. } = raw;
        let Raw { outline, cell, elimination, .. } = raw;
        let mut lumped = vec![0.0; nodes.len()];
        for (index, corners) in cells.chunks_exact(nodes_per_cell).enumerate() {
            for point in first_point[index] as usize..first_point[index + 1] as usize {
                for (a, &node) in corners.iter().enumerate() {
                    lumped[node as usize] += values[point * nodes_per_cell + a] * volumes[point];
                }
            }
        }
        let mut contact_nodes: Vec<u32> = outline.iter().flatten().map(|&(node, _)| node).collect();
        if let Elimination::AsNumbered(touched) = &elimination {
            contact_nodes.extend((0..nodes.len() as u32).filter(|&node| touched[node as usize]));
        }
        contact_nodes.sort_unstable();
        contact_nodes.dedup();
        let markers = outline
            .into_iter()
            .map(|weights| Marker {
                weights: weights
                    .into_iter()
                    .map(|(node, weight)| {
                        let place = contact_nodes.binary_search(&node).expect("collected just above");
                        (place as u32, weight)
                    })
                    .collect(),
            })
            .collect();
        let (order, contact) = match &elimination {
            Elimination::InteriorFirst => {
                let order = order::interior_first(&nodes, &cells, nodes_per_cell, &contact_nodes);
                (order, contact_nodes.len())
            }
            Elimination::AsNumbered(touched) => order::as_numbered(touched),
        };
        let profile = Profile::new(&order, &cells, nodes_per_cell, contact);
        let mut entries = Vec::new();
        for corners in cells.chunks_exact(nodes_per_cell) {
            for row in 0..2 * nodes_per_cell {
                for column in 0..=row {
                    let unknown = |local: usize| 2 * corners[local / 2] as usize + local % 2;
                    entries.push(profile.entry(unknown(row), unknown(column)) as u32);
                }
            }
        }
        let inner = profile.size() - profile.contact_size();
        let row = |&node: &u32| {
            let row = profile.row_of(2 * node as usize);
            row.checked_sub(inner).map_or(OUT_OF_REACH, |row| row as u32)
        };
        let contact_rows = contact_nodes.iter().map(row).collect();
        Self {
            ghost: Vec::new(),
            grid: Vec::new(),
            lanes: if nodes_per_cell == 4 { lanes(&gradients, &volumes) } else { Vec::new() },
            entries,
            contact_rows,
            nodes,
            nodes_per_cell,
            cells,
            first_point,
            gradients,
            values,
            volumes,
            lumped,
            markers,
            contact_nodes,
            profile,
            cell,
        }
    }
}

fn lanes(gradients: &[[f64; 2]], volumes: &[f64]) -> Vec<Lanes> {
    let cells = gradients.as_chunks::<16>().0.iter().zip(volumes.as_chunks::<4>().0);
    let of = |(g, v): (&[[f64; 2]; 16], &[f64; 4])| Lanes {
        gradients: [0, 1, 2, 3].map(|a| [0, 1].map(|axis| Quad([0, 1, 2, 3].map(|p| g[4 * p + a][axis])))),
        volumes: Quad(*v),
    };
    cells.map(of).collect()
}

const HALF_GAUSS: f64 = 0.577_350_269_189_625_8;
/// 2 × 2 Gauss points of the unit square [−1, 1]².
const GAUSS: [(f64, f64); 4] = [
    (-HALF_GAUSS, -HALF_GAUSS),
    (HALF_GAUSS, -HALF_GAUSS),
    (HALF_GAUSS, HALF_GAUSS),
    (-HALF_GAUSS, HALF_GAUSS),
];

/// Bilinear functions, their gradients in space and the Jacobian of the map, at (ξ, η) of a cell with corners `x`.
fn isoparametric(x: &[[f64; 2]; 4], xi: f64, eta: f64) -> ([f64; 4], [[f64; 2]; 4], f64) {
    let corner = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let n = corner.map(|(a, b): (f64, f64)| 0.25 * (1.0 + a * xi) * (1.0 + b * eta));
    let local = corner.map(|(a, b): (f64, f64)| [0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi)]);
    let mut j = [[0.0; 2]; 2];
    for (position, slope) in x.iter().zip(&local) {
        for (row, component) in j.iter_mut().zip(position) {
            row[0] += component * slope[0];
            row[1] += component * slope[1];
        }
    }
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    let g = local.map(|slope| {
        [(slope[0] * j[1][1] - slope[1] * j[1][0]) / det, (slope[1] * j[0][0] - slope[0] * j[0][1]) / det]
    });
    (n, g, det)
}
