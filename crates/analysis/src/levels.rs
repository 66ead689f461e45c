//! e_min and the plateau of each pressure, read from the runs.

use serde::{Deserialize, Serialize};

use crate::estimate::{mean_of, median};
use crate::point::{Point, count};
use crate::{CollapseOptions, Estimate, FitError};

/// The dense limit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct EMin {
    /// e_min used in e_r [1]: the mean over the dense limit, freed by least squares from what the master curve still
    /// predicts there; the plain mean where no master curve can be fitted.
    pub estimate: Estimate,
    /// The plain mean of e over the same points [1].
    pub dense_mean: f64,
    /// Number of points in the dense limit.
    pub points: usize,
    /// Largest η* among them [1].
    pub largest_eta_star: f64,
}

/// Where a plateau comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum PlateauSource {
    /// Mean over the runs of this pressure around and above η* = 1.
    Runs,
    /// The fit of (15): this pressure has no such run.
    Fit,
}

/// The plateau of one pressure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Plateau {
    /// Pressure p [Pa].
    pub p: f64,
    /// e_max used in e_r [1]: the mean over its runs, freed by least squares from what they still lack at their η*.
    pub e_max: Estimate,
    /// The plain mean of e over its runs [1]; absent from the fit.
    pub mean: Option<f64>,
    /// Where it comes from.
    pub source: PlateauSource,
    /// Number of points it is the mean of; 0 from the fit.
    pub points: usize,
}

/// Why a run lies off the plateau of its pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum OutlierReason {
    /// Above the plateau at p ≤ 0.05 MPa: ballistic aggregation before the walls press (finite size).
    BallisticAggregation,
    /// Below the plateau at p ≥ 0.5 MPa: dynamic jamming at the walls screens the inside.
    DynamicJamming,
    /// Above the plateau at another pressure: none of the paper's two reasons applies.
    AbovePlateau,
    /// Below the plateau at another pressure: none of the paper's two reasons applies.
    BelowPlateau,
}

impl OutlierReason {
    /// The reason as a sentence.
    #[must_use]
    pub fn explain(self) -> &'static str {
        match self {
            Self::BallisticAggregation => {
                "above the plateau at low pressure: particles aggregate before the walls press (finite size)"
            }
            Self::DynamicJamming => {
                "below the plateau at high pressure: dynamic jamming at the walls screens the inside"
            }
            Self::AbovePlateau => "above the plateau at a pressure where the paper knows no such deviation",
            Self::BelowPlateau => "below the plateau at a pressure where the paper knows no such deviation",
        }
    }
}

/// Up to this pressure runs above the plateau are ballistic aggregation [Pa].
const LOW_PRESSURE: f64 = 5.0e4;
/// From this pressure runs below the plateau are dynamic jamming [Pa].
const HIGH_PRESSURE: f64 = 5.0e5;
/// When nothing lies below the dense threshold, at most this many points of lowest η* serve, up to η* = 0.01.
const FALLBACK_DENSE: (usize, f64) = (3, 0.01);

pub(crate) struct Levels {
    pub e_min: EMin,
    pub plateaus: Vec<Plateau>,
    /// Index of the point, deviation e − e_expected [1], reason.
    pub outliers: Vec<(usize, f64, OutlierReason)>,
}

/// Reads e_min, the plateaus and the outliers by plain means.
pub(crate) fn read(points: &[&Point], options: &CollapseOptions) -> Result<Levels, FitError> {
    let e_min = read_e_min(points, options)?;
    let mut pressures: Vec<f64> = points.iter().map(|point| point.scene.p).collect();
    pressures.sort_by(f64::total_cmp);
    pressures.dedup();

    let [low, high] = options.plateau_eta_star;
    let mut groups: Vec<(f64, Vec<usize>, f64)> = Vec::new();
    for &p in &pressures {
        let members: Vec<usize> = (0..points.len())
            .filter(|&i| points[i].scene.p == p && points[i].scene.eta_star() >= low)
            .collect();
        if members.is_empty() {
            continue;
        }
        let core: Vec<f64> =
            members.iter().filter(|&&i| points[i].scene.eta_star() <= high).map(|&i| points[i].e).collect();
        let all: Vec<f64> = members.iter().map(|&i| points[i].e).collect();
        groups.push((p, members, median(if core.is_empty() { &all } else { &core })));
    }

    let deviations: Vec<f64> = groups
        .iter()
        .flat_map(|(_, members, centre)| members.iter().map(move |&i| (points[i].e - centre).abs()))
        .collect();
    let replicate = median(&points.iter().filter_map(|point| point.e_sigma).collect::<Vec<_>>());
    let robust = (1.4826 * median(&deviations)).max(replicate);

    let mut plateaus = Vec::new();
    let mut outliers = Vec::new();
    let mut kept_groups = Vec::new();
    for (p, members, centre) in groups {
        let limit = (options.outlier_sigma * robust)
            .max(options.outlier_least * (centre - e_min.estimate.value).abs());
        let mut kept = Vec::new();
        for i in members {
            let deviation = points[i].e - centre;
            if deviation.abs() <= limit {
                kept.push(points[i].e);
            } else {
                outliers.push((i, deviation, reason(p, deviation)));
            }
        }
        if !kept.is_empty() {
            kept_groups.push((p, kept));
        }
    }
    let spread = pooled_spread(&kept_groups, replicate, &e_min);
    for (p, kept) in kept_groups {
        let mean = kept.iter().sum::<f64>() / count(kept.len());
        let e_max = Estimate::symmetric(mean, spread / count(kept.len()).sqrt(), f64::INFINITY);
        plateaus.push(Plateau {
            p,
            e_max,
            mean: Some(mean),
            source: PlateauSource::Runs,
            points: kept.len(),
        });
    }
    outliers.sort_by_key(|(i, ..)| *i);
    Ok(Levels { e_min, plateaus, outliers })
}

fn reason(p: f64, deviation: f64) -> OutlierReason {
    match (deviation > 0.0, p) {
        (true, p) if p <= LOW_PRESSURE => OutlierReason::BallisticAggregation,
        (false, p) if p >= HIGH_PRESSURE => OutlierReason::DynamicJamming,
        (true, _) => OutlierReason::AbovePlateau,
        (false, _) => OutlierReason::BelowPlateau,
    }
}

/// Standard deviation of one plateau point: pooled over the pressures, or from replicates, or, when every pressure
/// has a single point and there are no replicates, from the scatter of the dense limit.
fn pooled_spread(groups: &[(f64, Vec<f64>)], replicate: f64, e_min: &EMin) -> f64 {
    let (mut squares, mut dof) = (0.0, 0.0);
    for (_, values) in groups {
        let n = count(values.len());
        let mean = values.iter().sum::<f64>() / n;
        squares += values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        dof += n - 1.0;
    }
    if dof >= 2.0 {
        (squares / dof).sqrt()
    } else if replicate > 0.0 {
        replicate
    } else {
        e_min.estimate.se * count(e_min.points).sqrt()
    }
}

fn read_e_min(points: &[&Point], options: &CollapseOptions) -> Result<EMin, FitError> {
    if let Some(value) = options.e_min {
        let estimate = Estimate { value, se: 0.0, ci95: [value, value] };
        return Ok(EMin { estimate, dense_mean: value, points: 0, largest_eta_star: 0.0 });
    }
    let mut dense: Vec<&Point> =
        points.iter().copied().filter(|point| point.scene.eta_star() <= options.dense_eta_star).collect();
    if dense.len() < 2 {
        let mut lowest: Vec<&Point> = points.to_vec();
        lowest.sort_by(|a, b| a.scene.eta_star().total_cmp(&b.scene.eta_star()));
        lowest.truncate(FALLBACK_DENSE.0);
        dense = lowest.into_iter().filter(|point| point.scene.eta_star() <= FALLBACK_DENSE.1).collect();
    }
    if dense.len() < 2 {
        return Err(FitError::too_few("e_min", "points in the dense limit (η* below 1e-3)", 2, dense.len()));
    }
    let raw: Vec<f64> = dense.iter().map(|point| point.e).collect();
    let mut estimate = mean_of(&raw).expect("two or more points");
    let dense_mean = estimate.value;
    let replicate = dense.iter().filter_map(|point| point.e_sigma).fold(0.0, f64::max);
    let floor = replicate / count(dense.len()).sqrt();
    if estimate.se < floor {
        estimate = Estimate::symmetric(estimate.value, floor, f64::INFINITY);
    }
    let largest_eta_star = dense.iter().map(|point| point.scene.eta_star()).fold(0.0, f64::max);
    Ok(EMin { estimate, dense_mean, points: dense.len(), largest_eta_star })
}
