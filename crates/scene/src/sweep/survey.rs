//! What a sweep would run, counted.

use std::collections::BTreeSet;

use serde::Serialize;

use super::{Candidate, Sweep};
use crate::{Problem, Problems, SceneKey, cost};

/// Counts and estimate of a sweep; runs nothing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Survey {
    /// Places in the sweep's order.
    pub candidates: u64,
    /// Points that stay.
    pub points: u64,
    /// Points left out, per filter, in the order of the definition.
    pub left_out: Vec<LeftOut>,
    /// Points whose reduced scene another point of the sweep already has: they run once.
    pub duplicates: u64,
    /// Different runs: `points − duplicates`.
    pub distinct: u64,
    /// Points outside of what the model describes: they run and are marked.
    pub out_of_model: u64,
    /// Estimated particle-steps of the distinct runs.
    pub particle_steps: f64,
    /// Estimated wall time of the distinct runs on one core of a current machine [s].
    pub core_seconds: f64,
    /// Estimated wall time of the longest run on one core [s]: no number of workers is faster.
    pub longest_seconds: f64,
}

/// Points that a filter leaves out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Why.
    pub reason: String,
    /// How many.
    pub points: u64,
}

impl Sweep {
    /// Walks the whole sweep and counts. `known` tells whether a run is done already: it costs nothing.
    ///
    /// # Errors
    /// [`Problems`] of points whose keys are right alone but make no scene together, with the path
    /// `points[INDEX].KEY`, and of a sweep whose filters leave nothing.
    pub fn survey_with(&self, known: impl Fn(&SceneKey) -> bool) -> Result<Survey, Problems> {
        let mut survey = Survey {
            candidates: self.size(),
            points: 0,
            left_out: self
                .filters
                .iter()
                .map(|filter| LeftOut { reason: filter.reason(), points: 0 })
                .collect(),
            duplicates: 0,
            distinct: 0,
            out_of_model: 0,
            particle_steps: 0.0,
            core_seconds: 0.0,
            longest_seconds: 0.0,
        };
        let mut seen = BTreeSet::new();
        let mut broken = Vec::new();
        for candidate in self.candidates() {
            match candidate {
                Candidate::LeftOut { filter, .. } => survey.left_out[filter].points += 1,
                Candidate::Broken { index, problems } => {
                    broken.extend(problems.0.into_iter().map(|problem| Problem {
                        field: format!("points[{index}].{}", problem.field),
                        remedy: format!("{}, or leave the point out by `where`", problem.remedy),
                        ..problem
                    }));
                }
                Candidate::Runs(point) => {
                    survey.points += 1;
                    survey.out_of_model += u64::from(point.out_of_model.is_some());
                    let reduced = point.scene.reduce();
                    let key = reduced.key();
                    if seen.contains(&key) {
                        survey.duplicates += 1;
                        continue;
                    }
                    survey.distinct += 1;
                    if !known(&key) {
                        let cost = cost(&reduced);
                        survey.particle_steps += cost.particle_steps;
                        survey.core_seconds += cost.seconds;
                        survey.longest_seconds = survey.longest_seconds.max(cost.seconds);
                    }
                    seen.insert(key);
                }
            }
        }
        Problems::none_or(broken)?;
        if survey.points == 0 {
            return Err(Problem {
                field: "where".to_owned(),
                value: format!("{} points left out", survey.candidates),
                problem: "leaves no point".to_owned(),
                remedy: "widen the intervals".to_owned(),
            }
            .into());
        }
        Ok(survey)
    }

    /// [`Sweep::survey_with`] when nothing is known to be done.
    ///
    /// # Errors
    /// As [`Sweep::survey_with`].
    pub fn survey(&self) -> Result<Survey, Problems> {
        self.survey_with(|_| false)
    }
}
