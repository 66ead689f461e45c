//! Runs of a sweep as layers: colour by pressure, marker by elastic stress.

use plotters::style::RGBColor;

use super::axis::plain;
use super::figure::{Dot, Fill, INK, Layer, MARKERS, MUTED, Marker, PALETTE, Sample};

/// One run to draw.
pub(super) struct Item {
    pub p: f64,
    pub sigma_e: f64,
    pub x: f64,
    pub y: f64,
    pub error: Option<f64>,
    pub fill: Fill,
}

/// Distinct values in rising order.
pub(super) fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    sorted
}

/// Colours and markers of the pressures and elastic stresses of a sweep.
pub(super) struct Key {
    pressures: Vec<f64>,
    stiffnesses: Vec<f64>,
}

impl Key {
    pub fn new(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        Self {
            pressures: distinct(pairs.clone().map(|(p, _)| p)),
            stiffnesses: distinct(pairs.map(|(_, sigma_e)| sigma_e)),
        }
    }

    pub fn color(&self, p: f64) -> RGBColor {
        let index = self.pressures.iter().position(|other| *other == p).unwrap_or(0);
        PALETTE[index % PALETTE.len()]
    }

    pub fn marker(&self, sigma_e: f64) -> Marker {
        let index = self.stiffnesses.iter().position(|other| *other == sigma_e).unwrap_or(0);
        MARKERS[index % MARKERS.len()]
    }

    /// One layer per colour, marker and fill.
    pub fn layers(&self, items: &[Item]) -> Vec<Layer> {
        let mut layers = Vec::new();
        for &p in &self.pressures {
            for &sigma_e in &self.stiffnesses {
                for fill in [Fill::Open, Fill::Full, Fill::Ringed] {
                    let dots: Vec<Dot> = items
                        .iter()
                        .filter(|item| item.p == p && item.sigma_e == sigma_e && item.fill == fill)
                        .map(|item| Dot { x: item.x, y: item.y, error: item.error })
                        .collect();
                    if !dots.is_empty() {
                        layers.push(Layer::Points {
                            color: self.color(p),
                            marker: self.marker(sigma_e),
                            fill,
                            dots,
                        });
                    }
                }
            }
        }
        layers
    }

    /// Legend rows: pressures as colours, stiffnesses as markers.
    pub fn legend(&self) -> Vec<Vec<(Sample, String)>> {
        let pressures = self.pressures.iter().map(|&p| {
            (Sample::Point(self.color(p), Marker::Circle, Fill::Full), format!("p = {} MPa", plain(p / 1e6)))
        });
        let stiffnesses = self.stiffnesses.iter().map(|&sigma_e| {
            (
                Sample::Point(MUTED, self.marker(sigma_e), Fill::Full),
                format!("σe = {} MPa", plain(sigma_e / 1e6)),
            )
        });
        vec![pressures.collect(), stiffnesses.collect()]
    }
}

/// Legend entries for the fills in use.
pub(super) fn fill_legend(items: &[Item], open: &str, ringed: &str) -> Vec<(Sample, String)> {
    let has = |fill: Fill| items.iter().any(|item| item.fill == fill);
    let mut row = Vec::new();
    if has(Fill::Open) {
        row.push((Sample::Point(INK, Marker::Circle, Fill::Open), open.to_owned()));
    }
    if has(Fill::Ringed) {
        row.push((Sample::Point(MUTED, Marker::Circle, Fill::Ringed), ringed.to_owned()));
    }
    row
}
