//! Deformable bodies: material points as vertices, outlines as closed lines.

use super::{columns, line, scalars};
use crate::{Packing, Table};

/// Tables of a packing of deformable bodies.
pub(super) struct Bodies<'a> {
    particles: &'a Table,
    points: &'a Table,
    outlines: &'a Table,
}

impl<'a> Bodies<'a> {
    /// The tables `points` and `outlines` (with `disc`, `x`, `y`) beside the particles, if they are there.
    pub(super) fn of(packing: &'a Packing, particles: &'a Table) -> Option<Self> {
        let table = |name: &str| {
            let table = packing.0.get(name)?;
            ["disc", "x", "y"].iter().all(|column| table.column(column).is_some()).then_some(table)
        };
        Some(Self { particles, points: table("points")?, outlines: table("outlines")? })
    }

    /// Points (material points, then markers), vertices, one closed line per outline; the columns of the material
    /// points as point data (0 on markers, where `outline` is 1), those of the particles as cell data of the lines.
    pub(super) fn write(&self, text: &mut String) {
        let column = |table: &Table, name: &str| table.column(name).unwrap_or_default();
        let places = |table: &Table| -> Vec<(f64, f64)> {
            column(table, "x").into_iter().zip(column(table, "y")).collect()
        };
        let (inside, markers) = (places(self.points), places(self.outlines));
        let n = inside.len();
        line(text, format_args!("POINTS {} double", n + markers.len()));
        for (x, y) in inside.iter().chain(&markers) {
            line(text, format_args!("{x:?} {y:?} 0.0"));
        }
        line(text, format_args!("VERTICES {n} {}", 2 * n));
        for point in 0..n {
            line(text, format_args!("1 {point}"));
        }
        let discs = column(self.outlines, "disc");
        let rings: Vec<&[f64]> = discs.chunk_by(|a, b| a.to_bits() == b.to_bits()).collect();
        line(text, format_args!("LINES {} {}", rings.len(), markers.len() + 2 * rings.len()));
        let mut first = n;
        for ring in &rings {
            let mut numbers: Vec<String> =
                (first..first + ring.len()).map(|point| point.to_string()).collect();
            numbers.push(first.to_string());
            line(text, format_args!("{} {}", numbers.len(), numbers.join(" ")));
            first += ring.len();
        }
        line(text, format_args!("POINT_DATA {}", n + markers.len()));
        scalars(text, "outline", std::iter::repeat_n(0.0, n).chain(std::iter::repeat_n(1.0, markers.len())));
        scalars(text, "disc", column(self.points, "disc").into_iter().chain(discs.iter().copied()));
        for one in columns(self.points, &["disc", "x", "y"]) {
            let values = one.values.iter().map(|value| value.get());
            scalars(text, &one.name, values.chain(std::iter::repeat_n(0.0, markers.len())));
        }
        if self.particles.rows() == rings.len() {
            line(text, format_args!("CELL_DATA {}", n + rings.len()));
            for one in columns(self.particles, &["x", "y", "z"]) {
                let values = one.values.iter().map(|value| value.get());
                scalars(text, &one.name, std::iter::repeat_n(0.0, n).chain(values));
            }
        }
    }
}
