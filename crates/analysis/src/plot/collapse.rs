//! The collapse, the raw void ratios, the plateau and the two power laws.

use super::axis::{Axis, Scale, plain};
use super::figure::{Dash, Dot, Figure, Fill, INK, Layer, MUTED, Marker, PALETTE, Panel, Sample};
use super::series::{Item, Key, fill_legend};
use crate::collapse::{Collapse, CollapsePoint, Role};
use crate::levels::PlateauSource;
use crate::master::MasterCurve;
use crate::{MasterFit, plateau};

const ETA_STAR: &str = "modified cohesion number η* = σc/√(p σe)";

fn fill(point: &CollapsePoint) -> Option<Fill> {
    match point.role {
        Role::Fit => Some(Fill::Full),
        Role::Outlier => Some(Fill::Ringed),
        Role::OutOfModel => Some(Fill::Open),
        Role::Variation => None,
    }
}

fn items(
    collapse: &Collapse,
    x: impl Fn(&CollapsePoint) -> f64,
    y: impl Fn(&CollapsePoint) -> f64,
    error: impl Fn(&CollapsePoint) -> Option<f64>,
) -> Vec<Item> {
    let item = |point: &CollapsePoint| {
        let fill = fill(point)?;
        Some(Item { p: point.p, sigma_e: point.sigma_e, x: x(point), y: y(point), error: error(point), fill })
    };
    collapse.points.iter().filter_map(item).collect()
}

fn key(items: &[Item]) -> Key {
    Key::new(items.iter().map(|item| (item.p, item.sigma_e)))
}

fn curve_points(items: &[Item], curve: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let positive = items.iter().map(|item| item.x).filter(|x| *x > 0.0);
    let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
    if high <= low {
        return Vec::new();
    }
    (0..=300).map(|i| low * (high / low).powf(f64::from(i) / 300.0)).map(|x| (x, curve(x))).collect()
}

const OPEN: &str = "σc/σe > 0.05 (not fitted)";
const RINGED: &str = "off the plateau (not fitted)";

/// Relative void ratio against η*, with the fitted master curve and the paper's.
#[must_use]
pub fn collapse_svg(collapse: &Collapse, master: Option<&MasterFit>) -> String {
    let spread = |point: &CollapsePoint| {
        point.e_sigma.map(|sigma| sigma / (point.e_max - collapse.e_min.estimate.value))
    };
    let items = items(collapse, |point| point.eta_star, |point| point.e_r, spread);
    let key = key(&items);
    let mut layers = key.layers(&items);
    let mut lines = Vec::new();
    layers.push(Layer::Line {
        color: MUTED,
        dash: Dash::Dashed,
        points: curve_points(&items, |x| MasterCurve::PAPER.e_r(x)),
    });
    lines.push((Sample::Line(MUTED, Dash::Dashed), "paper, eq. (31)".to_owned()));
    if let Some(fit) = master {
        let curve = fit.curve;
        layers.push(Layer::Line {
            color: INK,
            dash: Dash::Solid,
            points: curve_points(&items, |x| curve.e_r(x)),
        });
        let text = format!("fit: α = {}, β = {}", with_error(fit.alpha), with_error(fit.beta));
        lines.insert(0, (Sample::Line(INK, Dash::Solid), text));
    }
    let mut legend = key.legend();
    lines.extend(fill_legend(&items, OPEN, RINGED));
    legend.push(lines);
    Figure {
        title: "Collapse of the void ratio".to_owned(),
        panels: vec![Panel {
            x: Axis::around(ETA_STAR, Scale::Log, items.iter().map(|item| item.x)),
            y: Axis::around(
                "relative void ratio e_r",
                Scale::Linear,
                items.iter().map(|item| item.y).chain([0.0, 1.0]),
            ),
            layers,
        }],
        legend,
    }
    .svg()
}

/// s = (1 − e_r)/e_r against η* in log–log, where the two regimes are straight lines.
#[must_use]
pub fn master_svg(collapse: &Collapse, master: &MasterFit) -> String {
    let items: Vec<Item> =
        items(collapse, |point| point.eta_star, |point| (1.0 - point.e_r) / point.e_r, |_| None)
            .into_iter()
            .filter(|item| item.y > 0.0)
            .collect();
    let key = key(&items);
    let mut layers = key.layers(&items);
    let curve = master.curve;
    layers.push(Layer::Line {
        color: MUTED,
        dash: Dash::Dashed,
        points: curve_points(&items, |x| 1.0 / MasterCurve::PAPER.inverse_s(x)),
    });
    layers.push(Layer::Line {
        color: INK,
        dash: Dash::Solid,
        points: curve_points(&items, |x| 1.0 / curve.inverse_s(x)),
    });
    let mut legend = key.legend();
    let mut lines = vec![
        (
            Sample::Line(INK, Dash::Solid),
            format!("fit: α = {}, β = {}", with_error(master.alpha), with_error(master.beta)),
        ),
        (Sample::Line(MUTED, Dash::Dashed), "paper, eq. (30)".to_owned()),
    ];
    lines.extend(fill_legend(&items, OPEN, RINGED));
    legend.push(lines);
    Figure {
        title: "Two power laws of the relative void ratio".to_owned(),
        panels: vec![Panel {
            x: Axis::around(ETA_STAR, Scale::Log, items.iter().map(|item| item.x)),
            y: Axis::around("s = (1 − e_r)/e_r", Scale::Log, items.iter().map(|item| item.y)),
            layers,
        }],
        legend,
    }
    .svg()
}

/// Value ± standard error with two digits of the error.
pub(super) fn with_error(estimate: crate::Estimate) -> String {
    if estimate.se <= 0.0 || !estimate.se.is_finite() {
        return plain(estimate.value);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number of digits")]
    let digits = (1.0 - estimate.se.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{:.digits$} ± {:.digits$}", estimate.value, estimate.se).replace('-', "−")
}

/// Void ratio as measured against the cohesive stress.
#[must_use]
pub fn raw_svg(collapse: &Collapse) -> String {
    let items = items(collapse, |point| point.sigma_c / 1e6, |point| point.e, |point| point.e_sigma);
    let key = key(&items);
    let mut legend = key.legend();
    legend.push(fill_legend(&items, OPEN, RINGED));
    Figure {
        title: "Void ratio".to_owned(),
        panels: vec![Panel {
            x: Axis::around("cohesive stress σc [MPa]", Scale::Log, items.iter().map(|item| item.x)),
            y: Axis::around("void ratio e", Scale::Linear, items.iter().map(|item| item.y)),
            layers: key.layers(&items),
        }],
        legend,
    }
    .svg()
}

/// Plateau of each pressure with the fit of (15) and the paper's curve.
#[must_use]
pub fn plateau_svg(collapse: &Collapse) -> String {
    let dots = |source: PlateauSource| -> Vec<Dot> {
        collapse
            .plateaus
            .iter()
            .filter(|plateau| plateau.source == source)
            .map(|l| Dot { x: l.p / 1e6, y: l.e_max.value, error: Some(l.e_max.ci95[1] - l.e_max.value) })
            .collect()
    };
    let values = || collapse.plateaus.iter().map(|plateau| plateau.p / 1e6);
    let x = Axis::around("confining pressure p [MPa]", Scale::Log, values());
    let e_min = collapse.e_min.estimate.value;
    let samples: Vec<f64> = (0..=200).map(|i| x.low * (x.high / x.low).powf(f64::from(i) / 200.0)).collect();
    let paper: Vec<(f64, f64)> = samples
        .iter()
        .filter_map(|&p| Some((p, plateau::e_max(p * 1e6, 0.76, 1.0, 0.24, plateau::P0).ok()?)))
        .collect();
    let mut layers = vec![
        Layer::Line { color: MUTED, dash: Dash::Dashed, points: paper.clone() },
        Layer::Line {
            color: PALETTE[2],
            dash: Dash::Dashed,
            points: samples.iter().map(|p| (*p, e_min)).collect(),
        },
    ];
    let mut row = vec![
        (
            Sample::Point(PALETTE[0], Marker::Circle, Fill::Full),
            "runs around η* = 1, 95 % interval".to_owned(),
        ),
        (Sample::Line(MUTED, Dash::Dashed), "paper, eq. (15)".to_owned()),
        (Sample::Line(PALETTE[2], Dash::Dashed), format!("e_min = {}", with_error(collapse.e_min.estimate))),
    ];
    if let Some(fit) = collapse.plateau_fit.value() {
        let points =
            samples.iter().filter_map(|&p| Some((p, fit.predict(p * 1e6).ok()?.value))).collect::<Vec<_>>();
        layers.push(Layer::Line { color: INK, dash: Dash::Solid, points });
        row.push((Sample::Line(INK, Dash::Solid), format!("fit of (15): C = {}", with_error(fit.c))));
    }
    layers.push(Layer::Points {
        color: PALETTE[0],
        marker: Marker::Circle,
        fill: Fill::Full,
        dots: dots(PlateauSource::Runs),
    });
    let from_fit = dots(PlateauSource::Fit);
    if !from_fit.is_empty() {
        row.push((Sample::Point(PALETTE[0], Marker::Circle, Fill::Open), "no runs: from the fit".to_owned()));
        layers.push(Layer::Points {
            color: PALETTE[0],
            marker: Marker::Circle,
            fill: Fill::Open,
            dots: from_fit,
        });
    }
    let levels = collapse.plateaus.iter().flat_map(|plateau| plateau.e_max.ci95).chain([e_min]);
    Figure {
        title: "Plateau of the void ratio".to_owned(),
        panels: vec![Panel {
            y: Axis::around("plateau e_max", Scale::Linear, levels.chain(paper.iter().map(|point| point.1))),
            x,
            layers,
        }],
        legend: vec![row],
    }
    .svg()
}
