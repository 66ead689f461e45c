//! Submitting a sweep, or asking what that would do.

use std::cell::RefCell;
use std::collections::HashSet;

use protocol::api::{DryRun, Estimate, LeftOut, SweepView};
use protocol::{FieldProblem, JobState, SweepId};
use scene::Sweep;
use scene::sweep::Survey;
use serde_json::Value;

use super::App;
use crate::error::{AppError, AppResult, blocking};
use crate::store::{NewSweep, Replay};

/// A submission as it came in.
#[derive(Clone, Debug)]
pub struct Submission {
    /// The definition as JSON text.
    pub body: Vec<u8>,
    /// The request may arrive twice.
    pub idempotency_key: Option<String>,
}

/// What became of it.
#[derive(Clone, Debug)]
pub enum Submitted {
    /// A new sweep.
    New(SweepView),
    /// The same request was answered before.
    Before(SweepView),
}

/// Sweeps of at most this many places are expanded before the answer.
const AT_ONCE: u64 = 2_000;

struct Checked {
    sweep: Sweep,
    definition: Value,
    survey: Survey,
    keys: Vec<String>,
}

impl App {
    /// Stores a sweep and starts its expansion; small sweeps are expanded before this returns.
    ///
    /// # Errors
    /// [`AppError::Malformed`], [`AppError::Invalid`] with every problem of the definition,
    /// [`AppError::KeyReused`]; nothing is stored then.
    pub async fn submit(&self, submission: Submission) -> AppResult<Submitted> {
        let Submission { body, idempotency_key } = submission;
        let max_points = self.config().max_points;
        let fingerprint = blake3::hash(&body).to_hex().to_string();
        let checked = blocking(move || check(&body, max_points, false)).await?;
        let id = SweepId(new_uuid(self.now()));
        let new = NewSweep {
            id,
            name: checked.sweep.name.clone(),
            model: checked.sweep.model.name().to_owned(),
            priority: checked.sweep.priority,
            definition: checked.definition,
            points: checked.survey.points,
            candidates: checked.survey.candidates,
            left_out: left_out(&checked.survey),
            idempotency: idempotency_key.map(|key| (key, fingerprint)),
        };
        match self.store().insert_sweep(&new, self.now()).await? {
            Replay::Fresh => {}
            Replay::Known(known) => return Ok(Submitted::Before(self.sweep(known).await?)),
            Replay::Differs => return Err(AppError::KeyReused),
        }
        self.note_events();
        self.metrics().sweeps.inc();
        tracing::info!(sweep = %id, name = %new.name, points = new.points, "sweep submitted");
        if new.candidates <= AT_ONCE {
            self.expand_all().await?;
        } else {
            self.0.expand.notify_one();
        }
        Ok(Submitted::New(self.sweep(id).await?))
    }

    /// What a submission would do; stores nothing.
    ///
    /// # Errors
    /// As [`App::submit`].
    pub async fn dry_run(&self, body: Vec<u8>) -> AppResult<DryRun> {
        let max_points = self.config().max_points;
        let copy = body.clone();
        let first = blocking(move || check(&copy, max_points, true)).await?;
        let mut done = HashSet::new();
        let mut shared = HashSet::new();
        for keys in first.keys.chunks(5_000) {
            for known in self.store().known(keys).await? {
                match known.state {
                    JobState::Done => done.insert(known.key),
                    JobState::Queued | JobState::Leased => shared.insert(known.key),
                    JobState::Failed | JobState::Cancelled => false,
                };
            }
        }
        let counts = (done.len() as u64, shared.len() as u64);
        let survey = if done.is_empty() && shared.is_empty() {
            first.survey
        } else {
            let sweep = first.sweep.clone();
            blocking(move || {
                let known =
                    |key: &scene::SceneKey| done.contains(key.as_str()) || shared.contains(key.as_str());
                sweep.survey_with(known).map_err(|problems| invalid(&problems))
            })
            .await?
        };
        Ok(DryRun {
            dry_run: true,
            name: first.sweep.name,
            model: first.sweep.model.name().to_owned(),
            points: survey.points,
            left_out: left_out(&survey),
            distinct: survey.distinct,
            duplicates: survey.duplicates,
            known: counts.0,
            shared: counts.1,
            to_run: survey.distinct - counts.0 - counts.1,
            estimate: Estimate {
                core_seconds: survey.core_seconds,
                longest_core_seconds: survey.longest_seconds,
            },
        })
    }
}

fn check(body: &[u8], max_points: u64, with_keys: bool) -> AppResult<Checked> {
    let definition = scene::parse_json(body).map_err(|problems| AppError::Malformed(fields(&problems)))?;
    let sweep = Sweep::from_json(&definition).map_err(|problems| invalid(&problems))?;
    if sweep.size() > max_points {
        return Err(AppError::field(
            "sweep",
            "blocks",
            format!("{} points", sweep.size()),
            &format!("is more than the {max_points} points this service takes in one sweep"),
            "split the sweep, or raise max_points of the coordinator",
        ));
    }
    let keys = RefCell::new(Vec::new());
    let survey = sweep
        .survey_with(|key| {
            if with_keys {
                keys.borrow_mut().push(key.as_str().to_owned());
            }
            false
        })
        .map_err(|problems| invalid(&problems))?;
    Ok(Checked { sweep, definition, survey, keys: keys.into_inner() })
}

fn left_out(survey: &Survey) -> Vec<LeftOut> {
    survey.left_out.iter().map(|one| LeftOut { reason: one.reason.clone(), points: one.points }).collect()
}

pub(super) fn fields(problems: &scene::Problems) -> Vec<FieldProblem> {
    problems.0.iter().cloned().map(FieldProblem::from).collect()
}

pub(super) fn invalid(problems: &scene::Problems) -> AppError {
    AppError::Invalid { what: "sweep", fields: fields(problems) }
}

/// A version 7 id: sorts by the coordinator's time.
pub(super) fn new_uuid(now: crate::clock::Moment) -> uuid::Uuid {
    let millis = now.0.max(0).unsigned_abs();
    let nanos = u32::try_from(millis % 1000 * 1_000_000).expect("below a second");
    uuid::Uuid::new_v7(uuid::Timestamp::from_unix(uuid::NoContext, millis / 1000, nanos))
}
