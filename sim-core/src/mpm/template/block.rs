//! A rectangular block of equal bilinear cells, for patch, wave and friction tests.

use super::{Parts, Template};

/// A block [0, width] × [0, height] of `columns` × `rows` cells, markers on its boundary nodes.
#[must_use]
pub fn block(width: f64, height: f64, columns: usize, rows: usize) -> Template {
    let node = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
    let mut nodes = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            nodes.push([width * i as f64 / columns as f64, height * j as f64 / rows as f64]);
        }
    }
    let mut cells = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            cells.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
        }
    }
    let outline = (0..columns)
        .map(|i| node(i, 0))
        .chain((0..rows).map(|j| node(columns, j)))
        .chain((0..columns).map(|i| node(columns - i, rows)))
        .chain((0..rows).map(|j| node(0, rows - j)));
    let markers = outline.map(|node| vec![(node, 1.0)]).collect();
    let cell = (width / columns as f64).min(height / rows as f64);
    Template::bilinear(Parts { nodes, cells, markers, area: width * height, cell })
}
