//! Consolidation curves, moduli and structure of the cohesive discs.

use plotters::style::RGBColor;

use super::axis::{Axis, Scale, plain};
use super::collapse::with_error;
use super::figure::{Dash, Dot, Figure, Fill, INK, Layer, MARKERS, MUTED, Marker, PALETTE, Panel, Sample};
use crate::discs::{Consolidation, CurvePoint, Moduli, Structure};

fn dots(points: &[CurvePoint]) -> Vec<Dot> {
    points
        .iter()
        .map(|point| Dot {
            x: point.p_star,
            y: point.mean.value,
            error: (point.mean.se > 0.0).then_some(point.mean.se),
        })
        .collect()
}

fn layer(points: &[CurvePoint], color: RGBColor, marker: Marker, fill: Fill) -> Layer {
    Layer::Points { color, marker, fill, dots: dots(points) }
}

fn name(assembly: &str, mu_r: f64) -> String {
    format!("{assembly}, μR/a = {}", plain(mu_r))
}

const P_STAR: &str = "reduced pressure P* = aP/F0";

/// 1/Φ against P* with the fits of (9), and the paper's curves where it has one.
#[must_use]
pub fn consolidation_svg(consolidation: &Consolidation) -> String {
    let mut layers = Vec::new();
    let mut names = Vec::new();
    let mut lines = Vec::new();
    let values = || consolidation.curves.iter().flat_map(|curve| &curve.inverse_phi);
    let x = Axis::around(P_STAR, Scale::Log, values().map(|point| point.p_star));
    let samples: Vec<f64> = (0..=200).map(|i| x.low * (x.high / x.low).powf(f64::from(i) / 200.0)).collect();
    let mut extra = Vec::new();
    for (i, curve) in consolidation.curves.iter().enumerate() {
        let (color, marker) = (PALETTE[i % PALETTE.len()], MARKERS[i % MARKERS.len()]);
        layers.push(layer(&curve.inverse_phi, color, marker, Fill::Full));
        names.push((Sample::Point(color, marker, Fill::Full), name(&curve.assembly, curve.mu_r)));
        let unloading: Vec<CurvePoint> = curve
            .unloading
            .iter()
            .map(|point| {
                let mut inverse = *point;
                inverse.mean.value = 1.0 / point.mean.value;
                inverse.mean.se /= point.mean.value * point.mean.value;
                inverse
            })
            .collect();
        extra.extend(unloading.iter().map(|point| point.mean.value));
        layers.push(layer(&unloading, color, marker, Fill::Open));
        if let Some(fit) = curve.fit.value() {
            let at = |p: f64| {
                crate::discs::consolidation::inverse_phi(
                    p,
                    fit.p_star_0,
                    fit.phi_0.value,
                    fit.lambda.value,
                    fit.alpha.value,
                    fit.p_star_1.value,
                )
            };
            let points = samples.iter().filter(|p| **p >= fit.straight[0]).map(|&p| (p, at(p))).collect();
            layers.push(Layer::Line { color, dash: Dash::Solid, points });
            let text = format!("(9): λ = {}, Φmax = {}", with_error(fit.lambda), with_error(fit.phi_max));
            lines.push((Sample::Line(color, Dash::Solid), text));
        }
        if let Some(paper) = &curve.paper {
            let points = samples
                .iter()
                .filter(|p| **p >= paper.p_star_0)
                .map(|&p| (p, paper.inverse_phi(p)))
                .collect();
            layers.push(Layer::Line { color, dash: Dash::Dashed, points });
        }
    }
    if consolidation.curves.iter().any(|curve| curve.paper.is_some()) {
        lines.push((Sample::Line(MUTED, Dash::Dashed), "paper, Table III".to_owned()));
    }
    if !extra.is_empty() {
        names.push((Sample::Point(INK, Marker::Circle, Fill::Open), "unloading".to_owned()));
    }
    Figure {
        title: "Consolidation".to_owned(),
        panels: vec![Panel {
            x,
            y: Axis::around("1/Φ", Scale::Linear, values().map(|point| point.mean.value).chain(extra)),
            layers,
        }],
        legend: vec![names, lines],
    }
    .svg()
}

/// Bulk (left) and shear modulus (right) against P* with their estimates.
#[must_use]
pub fn moduli_svg(moduli: &Moduli) -> String {
    let mut row = Vec::new();
    let (mut bulk, mut shear) = (Vec::new(), Vec::new());
    let line = |points: &[CurvePoint], color: RGBColor, dash: Dash| Layer::Line {
        color,
        dash,
        points: points.iter().map(|point| (point.p_star, point.mean.value)).collect(),
    };
    for (i, curve) in moduli.curves.iter().enumerate() {
        let (color, marker) = (PALETTE[i % PALETTE.len()], MARKERS[i % MARKERS.len()]);
        bulk.push(layer(&curve.bulk, color, marker, Fill::Full));
        bulk.push(line(&curve.bulk_voigt, color, Dash::Solid));
        bulk.push(line(&curve.bulk_reuss, color, Dash::Dashed));
        shear.push(layer(&curve.shear, color, marker, Fill::Full));
        shear.push(line(&curve.shear_voigt, color, Dash::Solid));
        row.push((Sample::Point(color, marker, Fill::Full), name(&curve.assembly, curve.mu_r)));
    }
    let all = |get: fn(&crate::discs::moduli::ModuliCurve) -> [&Vec<CurvePoint>; 3]| {
        moduli.curves.iter().flat_map(get).flatten().copied().collect::<Vec<CurvePoint>>()
    };
    let panel = |label: &str, points: &[CurvePoint], layers: Vec<Layer>| Panel {
        x: Axis::around(P_STAR, Scale::Log, points.iter().map(|point| point.p_star)),
        y: Axis::around(label, Scale::Log, points.iter().map(|point| point.mean.value)),
        layers,
    };
    Figure {
        title: "Elastic moduli".to_owned(),
        panels: vec![
            panel("bulk modulus B [K_N]", &all(|c| [&c.bulk, &c.bulk_voigt, &c.bulk_reuss]), bulk),
            panel("shear modulus G [K_N]", &all(|c| [&c.shear, &c.shear_voigt, &c.shear]), shear),
        ],
        legend: vec![
            row,
            vec![
                (Sample::Line(MUTED, Dash::Solid), "Voigt".to_owned()),
                (Sample::Line(MUTED, Dash::Dashed), "Reuss".to_owned()),
            ],
        ],
    }
    .svg()
}

/// Correlation length and pore radius (left), fractal dimension (right) against P*.
#[must_use]
pub fn structure_svg(structure: &Structure) -> String {
    let mut row = Vec::new();
    let (mut lengths, mut dimensions) = (Vec::new(), Vec::new());
    for (i, curve) in structure.curves.iter().enumerate() {
        let (color, marker) = (PALETTE[i % PALETTE.len()], MARKERS[i % MARKERS.len()]);
        lengths.push(layer(&curve.correlation_length, color, marker, Fill::Full));
        lengths.push(layer(&curve.pore_radius, color, marker, Fill::Open));
        dimensions.push(layer(&curve.fractal_dimension, color, marker, Fill::Full));
        row.push((Sample::Point(color, marker, Fill::Full), name(&curve.assembly, curve.mu_r)));
    }
    let curves = &structure.curves;
    let length_points: Vec<CurvePoint> =
        curves.iter().flat_map(|c| [&c.correlation_length, &c.pore_radius]).flatten().copied().collect();
    let dimension_points: Vec<CurvePoint> =
        curves.iter().flat_map(|c| &c.fractal_dimension).copied().collect();
    let x = |points: &[CurvePoint]| Axis::around(P_STAR, Scale::Log, points.iter().map(|point| point.p_star));
    Figure {
        title: "Structure".to_owned(),
        panels: vec![
            Panel {
                x: x(&length_points),
                y: Axis::around("lengths ξ, ξ' [a]", Scale::Log, length_points.iter().map(|p| p.mean.value)),
                layers: lengths,
            },
            Panel {
                x: x(&dimension_points),
                y: Axis::around(
                    "fractal dimension d_F",
                    Scale::Linear,
                    dimension_points.iter().map(|p| p.mean.value).chain([1.0, 2.0]),
                ),
                layers: dimensions,
            },
        ],
        legend: vec![
            row,
            vec![
                (Sample::Point(MUTED, Marker::Circle, Fill::Full), "correlation length ξ".to_owned()),
                (Sample::Point(MUTED, Marker::Circle, Fill::Open), "pore radius ξ'".to_owned()),
            ],
        ],
    }
    .svg()
}
