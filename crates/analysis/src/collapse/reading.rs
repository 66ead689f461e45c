//! Whose e_max: of the pressure, or of the critical pressure σc²/σe. The paper can be read both ways.

use serde::{Deserialize, Serialize};

use super::Collapse;
use crate::cost::{Shape, scatter};
use crate::plateau::{self, Level, PlateauFit};
use crate::point::{Point, count};
use crate::{FitError, Run};

/// Which e_max enters e_r.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Reading {
    /// The plateau reached at η* ≈ 1 on the curve of this pressure, where p_crit = p. The default.
    PerPressure,
    /// The plateau of e(p) for p < p_crit at this (σc, σe), by (15) at p_crit = σc²/σe. Refused outside the range
    /// of its fit: far below p0 the formula diverges.
    PerCriticalPressure,
}

/// How well the two readings collapse the same points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ReadingComparison {
    /// Scatter of e_r about its smooth curve with e_max(p) [1].
    pub per_pressure: f64,
    /// The same with e_max(σc²/σe) [1].
    pub per_critical_pressure: f64,
    /// Points both were computed on.
    pub points: usize,
    /// Points the second reading refuses: p_crit outside the range of its plateau fit.
    pub refused: usize,
    /// The one with the smaller scatter.
    pub better: Reading,
    /// Fit of (15) in the second reading: abscissa p_crit [Pa].
    pub critical_fit: PlateauFit,
}

pub(super) struct Both {
    pub summary: ReadingComparison,
    range: [f64; 2],
}

impl Both {
    /// e_max of the second reading; nothing outside its range.
    pub fn e_max(&self, scene: &Run) -> Option<f64> {
        let p_crit = scene.sigma_c * scene.sigma_c / scene.sigma_e;
        let inside = (self.range[0]..=self.range[1]).contains(&p_crit);
        inside
            .then(|| self.summary.critical_fit.predict(p_crit).ok())
            .flatten()
            .map(|estimate| estimate.value)
    }
}

pub(super) fn compare(base: &[&Point], off: &[&Point], collapse: &Collapse) -> Result<Both, FitError> {
    let kept: Vec<&Point> =
        base.iter().copied().filter(|point| !off.iter().any(|other| std::ptr::eq(*other, *point))).collect();
    let levels = levels(&kept);
    let e_min = collapse.e_min.estimate;
    let critical_fit = plateau::fit(&levels, e_min.value, e_min.se, collapse.options.p_delta)?;
    let range = [levels[0].p, levels[levels.len() - 1].p];
    let draft = ReadingComparison {
        per_pressure: 0.0,
        per_critical_pressure: 0.0,
        points: 0,
        refused: 0,
        better: Reading::PerPressure,
        critical_fit,
    };
    let mut both = Both { summary: draft, range };
    let (mut u, mut first, mut second) = (Vec::new(), Vec::new(), Vec::new());
    for point in &kept {
        let scene = &point.scene;
        let Some(plateau) = collapse.plateaus.iter().find(|plateau| plateau.p == scene.p) else { continue };
        let Some(critical) = both.e_max(scene).filter(|e_max| *e_max > e_min.value) else {
            both.summary.refused += 1;
            continue;
        };
        u.push(scene.eta_star().ln());
        first.push((point.e - e_min.value) / (plateau.e_max.value - e_min.value));
        second.push((point.e - e_min.value) / (critical - e_min.value));
    }
    let weights = vec![1.0; u.len()];
    let cost = |y: &[f64]| scatter("readings of e_max", &u, y, &weights, Shape::Increasing).map(|s| s.rms);
    both.summary.per_pressure = cost(&first)?;
    both.summary.per_critical_pressure = cost(&second)?;
    both.summary.points = u.len();
    if both.summary.per_critical_pressure < both.summary.per_pressure {
        both.summary.better = Reading::PerCriticalPressure;
    }
    Ok(both)
}

/// Mean e of the runs with p ≤ p_crit for each (σc, σe), in rising p_crit.
fn levels(points: &[&Point]) -> Vec<Level> {
    let mut below: Vec<(f64, f64)> = points
        .iter()
        .map(|point| (point.scene.sigma_c * point.scene.sigma_c / point.scene.sigma_e, point))
        .filter(|(p_crit, point)| point.scene.p <= *p_crit)
        .map(|(p_crit, point)| (p_crit, point.e))
        .collect();
    below.sort_by(|a, b| a.0.total_cmp(&b.0));
    below
        .chunk_by(|a, b| (a.0 / b.0 - 1.0).abs() < 1e-9)
        .map(|same| {
            let mean = same.iter().map(|(_, e)| e).sum::<f64>() / count(same.len());
            Level { p: same[0].0, e_max: mean, se: 0.0 }
        })
        .collect()
}
