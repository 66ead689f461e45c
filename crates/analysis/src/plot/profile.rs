//! Profiles of the void ratio, and e against a varied key.

use super::axis::{Axis, Scale, plain};
use super::figure::{Dash, Dot, Figure, Fill, Layer, MARKERS, Marker, PALETTE, Panel, Sample};
use crate::profile::Profile;
use crate::variation::{Variation, Varied};

/// e inside a centred cube of side 2r against r/L, one curve per packing with its name.
#[must_use]
pub fn profile_svg(profiles: &[(String, &Profile)]) -> String {
    let mut layers = Vec::new();
    let mut row = Vec::new();
    for (i, (name, profile)) in profiles.iter().enumerate() {
        let color = PALETTE[i % PALETTE.len()];
        let points = profile.points.iter().map(|point| (point.r_over_l, point.e)).collect();
        layers.push(Layer::Line { color, dash: Dash::Solid, points });
        row.push((Sample::Line(color, Dash::Solid), name.clone()));
    }
    let values = || profiles.iter().flat_map(|(_, profile)| &profile.points);
    Figure {
        title: "Void ratio inside a centred cube of side 2r".to_owned(),
        panels: vec![Panel {
            x: Axis::around("r/L", Scale::Linear, values().map(|point| point.r_over_l)),
            y: Axis::around("void ratio e", Scale::Linear, values().map(|point| point.e)),
            layers,
        }],
        legend: vec![row],
    }
    .svg()
}

/// e against the varied key, one line per block.
#[must_use]
pub fn variation_svg(variation: &Variation) -> String {
    let (label, symbol) = match variation.varied {
        Varied::AlphaN => ("damping ratio αn", "αn"),
        Varied::Mw => ("wall mass mw/m", "mw/m"),
        Varied::Ei => ("initial void ratio ei", "ei"),
    };
    let mut layers = Vec::new();
    let mut row = Vec::new();
    for (i, block) in variation.blocks.iter().enumerate() {
        let color = PALETTE[i % PALETTE.len()];
        let marker: Marker = MARKERS[(i / PALETTE.len()) % MARKERS.len()];
        let points: Vec<(f64, f64)> = block.levels.iter().map(|level| (level.value, level.e)).collect();
        let dots = points.iter().map(|&(x, y)| Dot { x, y, error: None }).collect();
        layers.push(Layer::Line { color, dash: Dash::Dashed, points });
        layers.push(Layer::Points { color, marker, fill: Fill::Full, dots });
        let text = format!(
            "p, σc, σe = {}, {}, {} MPa",
            plain(block.p / 1e6),
            plain(block.sigma_c / 1e6),
            plain(block.sigma_e / 1e6)
        );
        row.push((Sample::Point(color, marker, Fill::Full), text));
    }
    let verdict = match variation.significance.value() {
        Some(test) if test.p_value < 1e-10 => format!("{symbol} changes e (p < 10⁻¹⁰)"),
        Some(test) if test.significant => format!("{symbol} changes e (p = {})", plain(test.p_value)),
        Some(test) => format!("no significant effect of {symbol} on e (p = {:.2})", test.p_value),
        None => format!("effect of {symbol} on e: not determined"),
    };
    let levels = || variation.blocks.iter().flat_map(|block| &block.levels);
    let scale = if variation.varied == Varied::Ei { Scale::Linear } else { Scale::Log };
    Figure {
        title: verdict,
        panels: vec![Panel {
            x: Axis::around(label, scale, levels().map(|level| level.value)),
            y: Axis::around("void ratio e", Scale::Linear, levels().map(|level| level.e)),
            layers,
        }],
        legend: vec![row],
    }
    .svg()
}
