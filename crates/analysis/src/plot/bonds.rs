//! Z+ and Z− against η and η*.

use super::axis::{Axis, Scale};
use super::figure::{Figure, Fill, Layer, MUTED, Marker, Panel, Sample};
use super::series::{Item, Key};
use crate::bonds::{BondPoint, Bonds};

/// Compressive (full) and tensile (open) coordination numbers, against η on the left and η* on the right.
#[must_use]
pub fn bonds_svg(bonds: &Bonds) -> String {
    let key = Key::new(bonds.points.iter().map(|point| (point.p, point.sigma_e)));
    let panel = |label: &str, name: &str, x: fn(&BondPoint) -> f64| {
        let item = |point: &BondPoint, y: f64, fill: Fill| Item {
            p: point.p,
            sigma_e: point.sigma_e,
            x: x(point),
            y,
            error: None,
            fill,
        };
        let items: Vec<Item> = bonds
            .points
            .iter()
            .flat_map(|point| [item(point, point.z_plus, Fill::Full), item(point, point.z_minus, Fill::Open)])
            .collect();
        let layers: Vec<Layer> = key.layers(&items);
        Panel {
            x: Axis::around(label, Scale::Log, items.iter().map(|item| item.x)),
            y: Axis::around(name, Scale::Linear, items.iter().map(|item| item.y).chain([0.0, 4.0])),
            layers,
        }
    };
    let mut legend = key.legend();
    legend.push(vec![
        (Sample::Point(MUTED, Marker::Circle, Fill::Full), "compressive Z+".to_owned()),
        (Sample::Point(MUTED, Marker::Circle, Fill::Open), "tensile Z−".to_owned()),
    ]);
    let share = bonds.comparisons.iter().filter_map(|c| c.value()).find(|c| c.quantity == "tensile_share");
    let verdict = share.map_or(String::new(), |c| {
        format!(" — scatter of Z−/Z against η* over that against η: {:.2}", c.ratio)
    });
    Figure {
        title: format!("Bonds{verdict}"),
        panels: vec![
            panel("η = σc/p", "coordination numbers Z+, Z−", |point| point.eta),
            panel("η* = σc/√(p σe)", "coordination numbers Z+, Z−", |point| point.eta_star),
        ],
        legend,
    }
    .svg()
}
