//! The collapse e_r = (e − e_min)/(e_max − e_min) (17) against η* (13).

use crate::cost::{Scatter, Shape, scatter};
use crate::fit::Sigma;
use crate::joint::{self, Joint, JointPoint};
use crate::levels::{self, Levels, OutlierReason, Plateau, PlateauSource};
use crate::master::{self, Core, MasterPoint};
use crate::plateau::{self, Level, PlateauFit};
use crate::point::{Point, count, group};
use crate::{Determined, Estimate, FitError, Run};

mod answer;
mod reading;
pub use answer::{Collapse, CollapseOptions, CollapsePoint, Excluded, Outlier, Role};
pub use reading::{Reading, ReadingComparison};

/// Collapses runs.
///
/// # Errors
/// [`FitError`] when e_min or every plateau is out of reach of the runs at hand.
pub fn collapse(runs: &[Run], options: &CollapseOptions) -> Result<Collapse, FitError> {
    let mut excluded = Vec::new();
    let (settled, unsettled): (Vec<Run>, Vec<Run>) =
        runs.iter().cloned().partition(|run| options.include_unsettled || run.settled());
    for run in &unsettled {
        let reason = format!("status {}: the void ratio had not settled", run.status);
        excluded.push(Excluded { id: run.id.clone(), reason });
    }
    let points = group(&settled);
    let roles = roles(&points, options);
    let base: Vec<&Point> = select(&points, &roles);
    let mut levels = levels::read(&base, options)?;
    if levels.plateaus.is_empty() {
        return Err(FitError::too_few("e_max", "points around and above η* = 1", 1, 0));
    }
    refine(&mut levels, &base, options);
    let e_min = levels.e_min.estimate;
    let read: Vec<Level> =
        levels.plateaus.iter().map(|l| Level { p: l.p, e_max: l.e_max.value, se: l.e_max.se }).collect();
    let plateau_fit: Determined<PlateauFit> =
        plateau::fit(&read, e_min.value, e_min.se, options.p_delta).into();

    let mut result = Collapse {
        options: options.clone(),
        runs: runs.len(),
        e_min: levels.e_min.clone(),
        plateaus: complete(&levels, &points, &plateau_fit),
        plateau_fit,
        points: Vec::new(),
        outliers: outliers(&base, &levels),
        excluded,
        scatter: Determined::from(Err(FitError::too_few("collapse", "points", 1, 0))),
        readings: Determined::from(Err(FitError::too_few("readings of e_max", "points", 1, 0))),
    };
    let off: Vec<&Point> = levels.outliers.iter().map(|(i, ..)| base[*i]).collect();
    let comparison = reading::compare(&base, &off, &result);
    place(&mut result, &points, &roles, &off, comparison.as_ref().ok());
    result.readings = comparison.map(|both| both.summary).into();
    let fitted: Vec<&CollapsePoint> = result.points.iter().filter(|point| point.role == Role::Fit).collect();
    result.scatter = scatter_of(&fitted).into();
    Ok(result)
}

/// Scatter of e_r against ln η*.
pub(crate) fn scatter_of(points: &[&CollapsePoint]) -> Result<Scatter, FitError> {
    let usable = points.iter().filter(|point| point.eta_star > 0.0);
    let (u, y): (Vec<f64>, Vec<f64>) = usable.map(|point| (point.eta_star.ln(), point.e_r)).unzip();
    scatter("collapse", &u, &y, &vec![1.0; u.len()], Shape::Increasing)
}

/// The main series has the most common α_n, m_w and e_i; among equally common ones the nearest to the default.
fn roles(points: &[Point], options: &CollapseOptions) -> Vec<Role> {
    let common = |get: fn(&Run) -> f64, default: f64| {
        let mut values: Vec<f64> = points.iter().map(|point| get(&point.scene)).collect();
        values.sort_by(f64::total_cmp);
        let rank = |chunk: &&[f64]| (chunk.len(), -(chunk[0] - default).abs());
        let most = values
            .chunk_by(|a, b| a == b)
            .max_by(|a, b| rank(a).partial_cmp(&rank(b)).expect("scenes hold finite numbers"));
        most.map_or(default, |chunk| chunk[0])
    };
    let main = [common(|run| run.alpha_n, 0.25), common(|run| run.mw, 96.0), common(|run| run.ei, 1.704)];
    points
        .iter()
        .map(|point| {
            let scene = &point.scene;
            if [scene.alpha_n, scene.mw, scene.ei] != main {
                Role::Variation
            } else if scene.out_of_model && !options.include_out_of_model {
                Role::OutOfModel
            } else {
                Role::Fit
            }
        })
        .collect()
}

fn select<'a>(points: &'a [Point], roles: &[Role]) -> Vec<&'a Point> {
    points.iter().zip(roles).filter(|(_, role)| **role == Role::Fit).map(|(point, _)| point).collect()
}

/// Points for the master curve at these levels.
fn master_points(base: &[&Point], levels: &Levels) -> (Vec<MasterPoint>, Sigma) {
    let e_min = levels.e_min.estimate.value;
    let known = base.iter().all(|point| point.e_sigma.is_some());
    let mut points = Vec::new();
    for (i, point) in base.iter().enumerate() {
        if levels.outliers.iter().any(|(outlier, ..)| *outlier == i) {
            continue;
        }
        let Some(plateau) = levels.plateaus.iter().find(|plateau| plateau.p == point.scene.p) else {
            continue;
        };
        let span = plateau.e_max.value - e_min;
        points.push(MasterPoint {
            eta_star: point.scene.eta_star(),
            e_r: (point.e - e_min) / span,
            sigma: point.e_sigma.filter(|_| known).unwrap_or(1.0) / span,
        });
    }
    (points, if known { Sigma::Absolute } else { Sigma::Relative })
}

/// Largest share of e_max − e_min by which the joint model may move a level.
const LARGEST_MOVE: f64 = 0.1;

/// Moves the levels to the least squares of the joint model and gives them its standard errors. Where that model
/// cannot be fitted, or leaves the neighbourhood of the plain means, these stay.
fn refine(levels: &mut Levels, base: &[&Point], options: &CollapseOptions) {
    let (points, known) = master_points(base, levels);
    let Ok(core) = master::fit_points(&points, known, None) else { return };
    let joint_points = joint_points(base, levels, known);
    let e_max: Vec<f64> = levels.plateaus.iter().map(|plateau| plateau.e_max.value).collect();
    let e_min = levels.e_min.estimate.value;
    let fixed = options.e_min.is_some();
    let Some((low, high)) = joint::polish(&joint_points, known, e_min, fixed, &e_max, &core.curve) else {
        return;
    };
    let near =
        |new: f64, old: f64| e_max.iter().all(|top| (new - old).abs() <= LARGEST_MOVE * (top - e_min).abs());
    if !near(low, e_min) || !high.iter().zip(&e_max).all(|(new, old)| near(*new, *old)) {
        return;
    }
    let mut moved =
        Levels { e_min: levels.e_min.clone(), plateaus: levels.plateaus.clone(), outliers: Vec::new() };
    moved.outliers.clone_from(&levels.outliers);
    moved.e_min.estimate.value = low;
    for (plateau, value) in moved.plateaus.iter_mut().zip(&high) {
        plateau.e_max.value = *value;
    }
    let (points, _) = master_points(base, &moved);
    let Ok(core) = master::fit_points(&points, known, Some(core.curve)) else { return };
    let free = vec![None; high.len()];
    let Some(joint) = joint::covariance(&joint_points, known, low, &high, &free, &core.curve) else {
        return;
    };
    let dof = count(joint_points.len()) - count(high.len() + 5);
    let e_min_se = if fixed { 0.0 } else { joint.e_min_se };
    moved.e_min.estimate = Estimate::symmetric(low, e_min_se, dof);
    for ((plateau, value), se) in moved.plateaus.iter_mut().zip(high).zip(joint.e_max_se) {
        plateau.e_max = Estimate::symmetric(value, se, dof);
    }
    *levels = moved;
}

fn joint_points(base: &[&Point], levels: &Levels, known: Sigma) -> Vec<JointPoint> {
    let kept =
        base.iter().enumerate().filter(|(i, _)| !levels.outliers.iter().any(|(outlier, ..)| outlier == i));
    kept.filter_map(|(_, point)| {
        let plateau = levels.plateaus.iter().position(|plateau| plateau.p == point.scene.p)?;
        let sigma = if known == Sigma::Absolute { point.e_sigma? } else { 1.0 };
        Some(JointPoint { eta_star: point.scene.eta_star(), e: point.e, sigma, plateau })
    })
    .collect()
}

impl Collapse {
    /// Joint covariance of levels and curve; nothing in the other reading of e_max.
    pub(crate) fn joint(&self, core: &Core) -> Option<Joint> {
        if self.options.reading != Reading::PerPressure {
            return None;
        }
        let used = || self.points.iter().filter(|point| point.role == Role::Fit);
        let known = used().all(|point| point.e_sigma.is_some());
        let points: Vec<JointPoint> = used()
            .filter_map(|point| {
                let plateau = self.plateaus.iter().position(|plateau| plateau.p == point.p)?;
                let sigma = point.e_sigma.filter(|_| known).unwrap_or(1.0);
                Some(JointPoint { eta_star: point.eta_star, e: point.e, sigma, plateau })
            })
            .collect();
        let e_max: Vec<f64> = self.plateaus.iter().map(|plateau| plateau.e_max.value).collect();
        let prior: Vec<Option<f64>> = self
            .plateaus
            .iter()
            .map(|plateau| (plateau.source == PlateauSource::Fit).then_some(plateau.e_max.se))
            .collect();
        let sigma = if known { Sigma::Absolute } else { Sigma::Relative };
        joint::covariance(&points, sigma, self.e_min.estimate.value, &e_max, &prior, &core.curve)
    }

    /// Points for the master curve, with e_min and one plateau moved by the given amounts.
    pub(crate) fn master_points(
        &self,
        e_min_shift: f64,
        plateau_shift: Option<(usize, f64)>,
    ) -> (Vec<MasterPoint>, Sigma) {
        let e_min = self.e_min.estimate.value + e_min_shift;
        let used = || self.points.iter().filter(|point| point.role == Role::Fit);
        let known = used().all(|point| point.e_sigma.is_some());
        let points = used()
            .map(|point| {
                let moved =
                    plateau_shift.filter(|(k, _)| self.plateaus[*k].p == point.p).map_or(0.0, |(_, by)| by);
                let span = point.e_max + moved - e_min;
                MasterPoint {
                    eta_star: point.eta_star,
                    e_r: (point.e - e_min) / span,
                    sigma: point.e_sigma.filter(|_| known).unwrap_or(1.0) / span,
                }
            })
            .collect();
        (points, if known { Sigma::Absolute } else { Sigma::Relative })
    }
}

/// Adds the pressures without a plateau of their own, from the fit of (15) where it reaches.
fn complete(levels: &Levels, points: &[Point], fit: &Determined<PlateauFit>) -> Vec<Plateau> {
    let mut plateaus = levels.plateaus.clone();
    for point in points {
        let p = point.scene.p;
        if plateaus.iter().any(|plateau| plateau.p == p) {
            continue;
        }
        if let Some(e_max) = fit.value().and_then(|fit| fit.predict(p).ok()) {
            plateaus.push(Plateau { p, e_max, mean: None, source: PlateauSource::Fit, points: 0 });
        }
    }
    plateaus.sort_by(|a, b| a.p.total_cmp(&b.p));
    plateaus
}

fn outliers(base: &[&Point], levels: &Levels) -> Vec<Outlier> {
    let entry = |&(i, deviation, reason): &(usize, f64, OutlierReason)| Outlier {
        id: base[i].scene.id.clone(),
        p: base[i].scene.p,
        sigma_c: base[i].scene.sigma_c,
        sigma_e: base[i].scene.sigma_e,
        deviation,
        reason,
        message: reason.explain().to_owned(),
    };
    levels.outliers.iter().map(entry).collect()
}

/// Fills `points`; those without e_max go to `excluded`.
fn place(
    result: &mut Collapse,
    points: &[Point],
    roles: &[Role],
    off: &[&Point],
    readings: Option<&reading::Both>,
) {
    let e_min = result.e_min.estimate.value;
    for (point, &role) in points.iter().zip(roles) {
        let scene = &point.scene;
        let e_max: Option<f64> = match result.options.reading {
            Reading::PerPressure => {
                result.plateaus.iter().find(|plateau| plateau.p == scene.p).map(|plateau| plateau.e_max.value)
            }
            Reading::PerCriticalPressure => readings.and_then(|both| both.e_max(scene)),
        };
        let Some(e_max) = e_max.filter(|e_max| *e_max > e_min) else {
            let reason = match result.options.reading {
                Reading::PerPressure => format!(
                    "p = {:.4e} Pa has no run around η* = 1 and the fit (15) does not reach it",
                    scene.p
                ),
                Reading::PerCriticalPressure => format!(
                    "p_crit = {:.4e} Pa lies outside the range of the fit (15) in this reading",
                    scene.sigma_c * scene.sigma_c / scene.sigma_e
                ),
            };
            result.excluded.push(Excluded { id: scene.id.clone(), reason });
            continue;
        };
        let is_off = off.iter().any(|other| std::ptr::eq(*other, point));
        result.points.push(CollapsePoint {
            id: scene.id.clone(),
            p: scene.p,
            sigma_c: scene.sigma_c,
            sigma_e: scene.sigma_e,
            alpha_n: scene.alpha_n,
            mw: scene.mw,
            ei: scene.ei,
            eta: scene.eta(),
            eta_star: scene.eta_star(),
            p_crit: scene.sigma_c * scene.sigma_c / scene.sigma_e,
            e: point.e,
            e_sigma: point.e_sigma,
            replicates: point.replicates,
            e_max,
            e_r: (point.e - e_min) / (e_max - e_min),
            role: if is_off { Role::Outlier } else { role },
        });
    }
}

#[cfg(test)]
mod tests;
