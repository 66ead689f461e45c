//! β± of a sweep, and the force distribution of one packing.

use super::axis::{Axis, Scale};
use super::collapse::with_error;
use super::figure::{Dash, Dot, Figure, Fill, INK, Layer, MUTED, Marker, PALETTE, Panel, Sample};
use super::series::{Item, Key};
use crate::forces::distribution::{COMPRESSIVE_END, TENSILE_END};
use crate::forces::{ForceDistribution, ForcePoint, Forces};

/// β+ (full) and β− (open) against η on the left and η* on the right, with β+ = η.
#[must_use]
pub fn forces_svg(forces: &Forces) -> String {
    let key = Key::new(forces.points.iter().map(|point| (point.p, point.sigma_e)));
    let panel = |label: &str, x: fn(&ForcePoint) -> f64, slope: bool| {
        let items: Vec<Item> = forces
            .points
            .iter()
            .flat_map(|point| {
                let item = |y: Option<f64>, error: Option<f64>, fill: Fill| {
                    Some(Item { p: point.p, sigma_e: point.sigma_e, x: x(point), y: y?, error, fill })
                };
                [
                    item(point.beta_plus, point.beta_plus_se, Fill::Full),
                    item(point.beta_minus, point.beta_minus_se, Fill::Open),
                ]
            })
            .flatten()
            .filter(|item| item.y > 0.0)
            .collect();
        let mut layers = key.layers(&items);
        let axis = Axis::around(label, Scale::Log, items.iter().map(|item| item.x));
        let y = Axis::around("exponents β+, β−", Scale::Log, items.iter().map(|item| item.y));
        if slope {
            let points = (0..=100)
                .map(|i| y.low * (y.high / y.low).powf(f64::from(i) / 100.0))
                .map(|v| (v, v))
                .collect();
            layers.push(Layer::Line { color: MUTED, dash: Dash::Dashed, points });
        }
        Panel { x: axis, y, layers }
    };
    let mut legend = key.legend();
    legend.push(vec![
        (Sample::Point(MUTED, Marker::Circle, Fill::Full), "compressive β+".to_owned()),
        (Sample::Point(MUTED, Marker::Circle, Fill::Open), "tensile β−".to_owned()),
        (Sample::Line(MUTED, Dash::Dashed), "β+ = η".to_owned()),
    ]);
    let plus = forces.comparisons.iter().filter_map(|c| c.value()).find(|c| c.quantity == "beta_plus");
    let verdict = plus.map_or(String::new(), |c| {
        format!(" — scatter of β+ against η* over that against η: {:.2}", c.ratio)
    });
    Figure {
        title: format!("Force exponents{verdict}"),
        panels: vec![panel("η = σc/p", |p| p.eta, true), panel("η* = σc/√(p σe)", |p| p.eta_star, false)],
        legend,
    }
    .svg()
}

/// Probability density of fn/fc with both exponentials over the ranges they were fitted in.
#[must_use]
pub fn distribution_svg(forces: &ForceDistribution) -> String {
    let dots: Vec<Dot> = forces
        .bins
        .iter()
        .filter(|bin| bin.contacts > 0)
        .map(|bin| Dot { x: bin.x, y: bin.density, error: Some(bin.se) })
        .collect();
    let y = Axis::around("probability density", Scale::Log, dots.iter().map(|dot| dot.y));
    let x =
        Axis::around("normal force over adhesion fn/fc", Scale::Linear, forces.bins.iter().map(|bin| bin.x));
    let mut layers = Vec::new();
    let mut row = vec![(Sample::Point(PALETTE[0], Marker::Circle, Fill::Full), "contacts".to_owned())];
    let carrying = crate::point::count(forces.contacts - forces.zero_contacts);
    let sides = [
        (forces.beta_plus.value(), 1.0, COMPRESSIVE_END, INK, "β+"),
        (forces.beta_minus.value(), -1.0, TENSILE_END, PALETTE[1], "β−"),
    ];
    for (side, sign, end, color, name) in sides {
        let Some(side) = side else { continue };
        let beta = side.beta.value;
        let norm = if (beta * end).abs() < 1e-9 { end } else { -(-beta * end).exp_m1() / beta };
        let share = crate::point::count(side.contacts) / carrying;
        let points = (0..=60)
            .map(|i| end * f64::from(i) / 60.0)
            .map(|v| (sign * v, share * (-beta * v).exp() / norm))
            .collect();
        layers.push(Layer::Line { color, dash: Dash::Solid, points });
        row.push((Sample::Line(color, Dash::Solid), format!("{name} = {}", with_error(side.beta))));
    }
    layers.push(Layer::Points { color: PALETTE[0], marker: Marker::Circle, fill: Fill::Full, dots });
    Figure {
        title: format!(
            "Normal forces: {} contacts, {} of them without force",
            forces.contacts, forces.zero_contacts
        ),
        panels: vec![Panel { x, y, layers }],
        legend: vec![row],
    }
    .svg()
}
