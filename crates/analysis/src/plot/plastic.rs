//! Compaction and coordination of the plastic discs.

use plotters::style::RGBColor;

use super::axis::{Axis, Scale};
use super::collapse::with_error;
use super::figure::{Dash, Dot, Figure, Fill, INK, Layer, MARKERS, MUTED, Marker, PALETTE, Panel, Sample};
use crate::Estimate;
use crate::estimate::mean_of;
use crate::plastic::{Compaction, Coordination, PlasticCurve, PlasticState};

/// Colour and marker of each material: runs that differ in their packing alone look alike and share a line of the legend.
struct Styles(Vec<(String, usize)>);

impl Styles {
    /// In the order in which materials first come.
    fn new(names: impl Iterator<Item = String>) -> Self {
        let mut materials: Vec<(String, usize)> = Vec::new();
        for name in names {
            match materials.iter_mut().find(|(known, _)| *known == name) {
                Some((_, runs)) => *runs += 1,
                None => materials.push((name, 1)),
            }
        }
        Self(materials)
    }

    fn of(&self, name: &str) -> (RGBColor, Marker) {
        let place = self.0.iter().position(|(known, _)| known == name).unwrap_or_default();
        (PALETTE[place % PALETTE.len()], MARKERS[place % MARKERS.len()])
    }

    /// One entry per material, named by the material, the number of its runs and what `more` has to say.
    fn legend(
        &self,
        sample: impl Fn((RGBColor, Marker)) -> Sample,
        more: impl Fn(&str) -> Option<String>,
    ) -> Vec<(Sample, String)> {
        let entry = |(name, runs): &(String, usize)| {
            let several = if *runs > 1 { format!(" ({runs} runs)") } else { String::new() };
            let more = more(name).map_or_else(String::new, |more| format!(": {more}"));
            (sample(self.of(name)), format!("{name}{several}{more}"))
        };
        self.0.iter().map(entry).collect()
    }
}

/// Stress against Φ (left) and excess strain (right), points with the fitted model (lines) and the paper's constants.
#[must_use]
pub fn compaction_svg(compaction: &Compaction) -> String {
    let styles = Styles::new(compaction.curves.iter().map(|curve| curve.name.clone()));
    let (mut by_phi, mut by_strain) = (Vec::new(), Vec::new());
    let (mut phis, mut strains, mut stresses) = (Vec::new(), Vec::new(), Vec::new());
    for curve in &compaction.curves {
        let (color, marker) = styles.of(&curve.name);
        let start = curve.jamming.value().and_then(|jamming| jamming.strain_c);
        let dots = |x: &dyn Fn(&PlasticState) -> Option<f64>| -> Vec<Dot> {
            curve
                .states
                .iter()
                .filter_map(|state| Some(Dot { x: x(state)?, y: state.sigma / 1e6, error: None }))
                .collect()
        };
        let left = dots(&|state| Some(state.phi));
        let right = dots(&|state| Some(state.strain? - start?).filter(|excess| *excess >= 0.0));
        phis.extend(left.iter().map(|dot| dot.x));
        strains.extend(right.iter().map(|dot| dot.x));
        stresses.extend(left.iter().map(|dot| dot.y));
        by_phi.push(Layer::Points { color, marker, fill: Fill::Open, dots: left });
        by_strain.push(Layer::Points { color, marker, fill: Fill::Open, dots: right });
        let line =
            |dash: Dash, get: &dyn Fn(&crate::plastic::compaction::ModelSample) -> Option<f64>| Layer::Line {
                color,
                dash,
                points: curve
                    .model
                    .iter()
                    .filter_map(|sample| Some((sample.phi, get(sample)? / 1e6)))
                    .collect(),
            };
        by_phi.push(line(Dash::Solid, &|sample| sample.fitted));
        by_phi.push(line(Dash::Dashed, &|sample| Some(sample.paper)));
        let strain_line =
            curve.model.iter().filter_map(|sample| Some((sample.excess_strain?, sample.by_strain? / 1e6)));
        // Where nothing could be fitted the model has the paper's constants.
        let fitted = curve.model.iter().any(|sample| sample.fitted.is_some());
        let dash = if fitted { Dash::Solid } else { Dash::Dashed };
        by_strain.push(Layer::Line { color, dash, points: strain_line.collect() });
    }
    let stress = |label: &str| Axis::around(label, Scale::Linear, stresses.iter().copied());
    Figure {
        title: "Compaction".to_owned(),
        panels: vec![
            Panel {
                x: Axis::around("solid fraction Φ", Scale::Linear, phis.into_iter()),
                y: stress("stress σ [MPa]"),
                layers: by_phi,
            },
            Panel {
                x: Axis::around("excess strain ε − εc", Scale::Linear, strains.into_iter()),
                y: stress("stress σ [MPa]"),
                layers: by_strain,
            },
        ],
        legend: vec![
            styles.legend(|(color, marker)| Sample::Point(color, marker, Fill::Open), |_| None),
            vec![
                (Sample::Line(MUTED, Dash::Solid), "model, fitted constants".to_owned()),
                (Sample::Line(MUTED, Dash::Dashed), "model, paper's constants".to_owned()),
            ],
        ],
    }
    .svg()
}

/// Excess coordination number against excess solid fraction in log–log.
#[must_use]
pub fn coordination_svg(coordination: &Coordination) -> String {
    let styles = Styles::new(coordination.curves.iter().map(|curve| curve.name.clone()));
    let mut layers = Vec::new();
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    for curve in &coordination.curves {
        let (color, marker) = styles.of(&curve.name);
        let dots: Vec<Dot> = curve
            .points
            .iter()
            .filter(|point| point.excess_phi > 1e-4 && point.excess_z > 1e-2)
            .map(|point| Dot { x: point.excess_phi, y: point.excess_z, error: None })
            .collect();
        xs.extend(dots.iter().map(|dot| dot.x));
        ys.extend(dots.iter().map(|dot| dot.y));
        layers.push(Layer::Points { color, marker, fill: Fill::Full, dots });
    }
    let gamma = |name: &str| {
        let runs = coordination.curves.iter().filter(|curve| curve.name == name);
        let fits: Vec<Estimate> = runs.filter_map(|curve| curve.free.value()?.parameter("gamma")).collect();
        let values: Vec<f64> = fits.iter().map(|gamma| gamma.value).collect();
        let gamma = if values.len() > 1 { mean_of(&values)? } else { *fits.first()? };
        Some(format!("γ = {}", with_error(gamma)))
    };
    let mut row = styles.legend(|(color, marker)| Sample::Point(color, marker, Fill::Full), gamma);
    let slopes: Vec<f64> =
        coordination.curves.iter().filter_map(|curve| Some(curve.square_root.value()?.values()[1])).collect();
    let x = Axis::around("excess solid fraction Φ − Φc", Scale::Log, xs.into_iter());
    if !slopes.is_empty() {
        let psi = slopes.iter().sum::<f64>() / crate::point::count(slopes.len());
        let points = (0..=100)
            .map(|i| x.low * (x.high / x.low).powf(f64::from(i) / 100.0))
            .map(|excess| (excess, psi * excess.sqrt()))
            .collect();
        layers.push(Layer::Line { color: INK, dash: Dash::Dashed, points });
        row.push((Sample::Line(INK, Dash::Dashed), "slope 1/2, eq. (17)".to_owned()));
    }
    Figure {
        title: "Coordination number above jamming".to_owned(),
        panels: vec![Panel {
            x,
            y: Axis::around("excess coordination number Z − Zc", Scale::Log, ys.into_iter()),
            layers,
        }],
        legend: vec![row],
    }
    .svg()
}

/// κ⟨d⟩ (left) and Φ (right) against stress.
#[must_use]
pub fn curvature_svg(compaction: &Compaction) -> String {
    let styles = Styles::new(compaction.curves.iter().map(|curve| curve.name.clone()));
    let (mut kappas, mut phis) = (Vec::new(), Vec::new());
    let (mut stresses, mut sharpest, mut densest) = (Vec::new(), Vec::new(), Vec::new());
    for curve in &compaction.curves {
        let (color, marker) = styles.of(&curve.name);
        let dots = |y: &dyn Fn(&PlasticState) -> Option<f64>| -> Vec<Dot> {
            let dot = |state: &PlasticState| Some(Dot { x: state.sigma / 1e6, y: y(state)?, error: None });
            curve.states.iter().filter(|state| state.sigma > 0.0).filter_map(dot).collect()
        };
        let (kappa, phi) = (dots(&|state| state.kappa_d), dots(&|state| Some(state.phi)));
        stresses.extend(phi.iter().map(|dot| dot.x));
        sharpest.extend(kappa.iter().map(|dot| dot.y));
        densest.extend(phi.iter().map(|dot| dot.y));
        kappas.push(Layer::Points { color, marker, fill: Fill::Open, dots: kappa });
        phis.push(Layer::Points { color, marker, fill: Fill::Open, dots: phi });
    }
    let row = styles.legend(|(color, marker)| Sample::Point(color, marker, Fill::Open), |_| None);
    let stress = || Axis::around("stress σ [MPa]", Scale::Linear, stresses.iter().copied());
    Figure {
        title: "Shape and solid fraction under stress".to_owned(),
        panels: vec![
            Panel {
                x: stress(),
                y: Axis::around("mean largest curvature κ⟨d⟩", Scale::Linear, sharpest.into_iter()),
                layers: kappas,
            },
            Panel {
                x: stress(),
                y: Axis::around("solid fraction Φ", Scale::Linear, densest.into_iter()),
                layers: phis,
            },
        ],
        legend: vec![row],
    }
    .svg()
}

/// Four definitions of stress of single discs against nominal strain.
#[must_use]
pub fn stress_strain_svg(curves: &[PlasticCurve]) -> String {
    type Stress = fn(&PlasticState) -> Option<f64>;
    const DEFINITIONS: [(&str, Stress); 4] = [
        ("F/D [MPa]", |state| Some(state.sigma)),
        ("F/contact width [MPa]", |state| state.sigma_contact),
        ("volume mean of −σyy [MPa]", |state| state.sigma_volume),
        ("−σyy at the centre [MPa]", |state| state.sigma_centre),
    ];
    let styles = Styles::new(curves.iter().map(PlasticCurve::name));
    let panel = |(label, stress): (&str, Stress)| {
        let (mut xs, mut ys, mut layers) = (Vec::new(), Vec::new(), Vec::new());
        for curve in curves {
            let points: Vec<(f64, f64)> = curve
                .states
                .iter()
                .filter_map(|state| Some((state.strain_nominal?, stress(state)? / 1e6)))
                .collect();
            xs.extend(points.iter().map(|point| point.0));
            ys.extend(points.iter().map(|point| point.1));
            layers.push(Layer::Line { color: styles.of(&curve.name()).0, dash: Dash::Solid, points });
        }
        let x = Axis::around("strain 1 − h/D", Scale::Linear, xs.into_iter().chain([0.0]));
        Panel { x, y: Axis::around(label, Scale::Linear, ys.into_iter().chain([0.0])), layers }
    };
    Figure {
        title: "One disc between walls: four definitions of stress".to_owned(),
        panels: DEFINITIONS.map(panel).into(),
        legend: vec![styles.legend(|(color, _)| Sample::Line(color, Dash::Solid), |_| None)],
    }
    .svg()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_one_material_share_a_colour_and_a_line_of_the_legend() {
        let names = ["elastic", "elastic", "H = 1 MPa", "elastic", "H = 1 MPa"];
        let styles = Styles::new(names.into_iter().map(str::to_owned));
        assert_eq!(styles.of("elastic").0, PALETTE[0]);
        assert_eq!(styles.of("H = 1 MPa").0, PALETTE[1]);
        let legend = styles.legend(
            |(color, marker)| Sample::Point(color, marker, Fill::Open),
            |name| (name == "elastic").then(|| "γ = 0.5".to_owned()),
        );
        let texts: Vec<&str> = legend.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(texts, ["elastic (3 runs): γ = 0.5", "H = 1 MPa (2 runs)"]);
    }
}
