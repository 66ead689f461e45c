//! Collapse cost against each exponent.

use super::axis::{Axis, Scale};
use super::collapse::with_error;
use super::figure::{Dash, Figure, INK, Layer, MUTED, PALETTE, Panel, Sample};
use crate::exponents::Exponents;

/// Scatter of e_r about a smooth curve against b, c and q; vertical lines at the best values and at the paper's.
#[must_use]
pub fn exponents_svg(exponents: &Exponents) -> String {
    let mut layers = Vec::new();
    let mut row = Vec::new();
    let costs = || exponents.scans.iter().flat_map(|scan| scan.cost.iter().copied());
    let y = Axis::around("collapse cost: scatter of e_r", Scale::Log, costs());
    let vertical = |x: f64| vec![(x, y.low * 1.0001), (x, y.high * 0.9999)];
    for (scan, color) in exponents.scans.iter().zip(PALETTE) {
        let (found, paper, meaning) = match scan.exponent.as_str() {
            "b" => (&exponents.b, 0.5, "b of p/σe"),
            "c" => (&exponents.c, 0.0, "c of mw/m"),
            _ => (&exponents.q, 0.25, "q of αn"),
        };
        layers.push(Layer::Line {
            color,
            dash: Dash::Solid,
            points: scan.values.iter().copied().zip(scan.cost.iter().copied()).collect(),
        });
        layers.push(Layer::Line { color: MUTED, dash: Dash::Dashed, points: vertical(paper) });
        let text = match found.value() {
            Some(estimate) => {
                layers.push(Layer::Line { color: INK, dash: Dash::Solid, points: vertical(estimate.value) });
                format!("{meaning}: {}", with_error(*estimate))
            }
            None => format!("{meaning}: not determined"),
        };
        row.push((Sample::Line(color, Dash::Solid), text));
    }
    row.push((Sample::Line(INK, Dash::Solid), "best".to_owned()));
    row.push((Sample::Line(MUTED, Dash::Dashed), "paper".to_owned()));
    let values = exponents.scans.iter().flat_map(|scan| scan.values.iter().copied());
    Figure {
        title: "Exponents of the scaling variable (σc/p)(p/σe)ᵇ (mw/m)ᶜ αn^q".to_owned(),
        panels: vec![Panel { x: Axis::around("exponent", Scale::Linear, values), y, layers }],
        legend: vec![row],
    }
    .svg()
}
