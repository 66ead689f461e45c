//! What the holder of a lease does: heartbeat, checkpoint, result, failure, release.

use protocol::{
    Accepted, Checkpoint, CheckpointQuery, Completion, Directive, Failure, Heartbeat, HeartbeatReply, JobId,
    JobState, Release, Returned, WorkerId,
};

use super::App;
use crate::error::{AppError, AppResult, blocking};
use crate::store::{Beat, CheckpointHeld, HeldLease, LeaseWrite, NewCheckpoint, NewResult, Stored};

/// Longest text of a failure or a release that is kept [characters].
const LONGEST_TEXT: usize = 20_000;
/// Compression of outcomes: fast, and a third of the size.
const ZSTD_LEVEL: i32 = 3;

impl App {
    /// The job is alive: the lease is renewed, in memory at once and in the database within a second or two.
    ///
    /// # Errors
    /// [`AppError::StaleLease`] when the worker does not hold the job any more.
    pub async fn heartbeat(&self, job: JobId, beat: &Heartbeat) -> AppResult<HeartbeatReply> {
        if !(0.0..=1.0).contains(&beat.fraction) {
            let remedy = "give the share of the work done, 0 to 1";
            return Err(AppError::field("request", "fraction", beat.fraction, "out of range", remedy));
        }
        if !(0.0..1e12).contains(&beat.wall_s) {
            let remedy = "give the wall seconds spent, 0 or more";
            return Err(AppError::field("request", "wall_s", beat.wall_s, "out of range", remedy));
        }
        let held = self.held(job, beat.worker, beat.attempt).await?;
        let now = self.now();
        let lease_seconds = self.config().lease_seconds;
        self.metrics().heartbeats.inc();
        if held.state == JobState::Cancelled {
            self.beats().seen(beat.worker, now);
            return Ok(HeartbeatReply { directive: Directive::Drop, lease_seconds });
        }
        self.beats().beat(
            beat.worker,
            Beat {
                seq: held.seq,
                attempt: beat.attempt,
                until: now.plus(self.config().lease()),
                at: now,
                steps: beat.steps,
                expected_steps: beat.expected_steps,
                fraction: beat.fraction,
                wall_s: beat.wall_s,
                live: beat.live.clone(),
            },
        );
        let directive = if held.runnable == 0 { Directive::Yield } else { Directive::Continue };
        Ok(HeartbeatReply { directive, lease_seconds })
    }

    /// Stores a checkpoint.
    ///
    /// # Errors
    /// [`AppError::StaleLease`] when the worker does not hold the job any more.
    pub async fn put_checkpoint(
        &self,
        job: JobId,
        query: &CheckpointQuery,
        bytes: bytes::Bytes,
    ) -> AppResult<Checkpoint> {
        let Some(steps) = query.steps else {
            let remedy = "add steps=…, the steps done at the checkpoint";
            return Err(AppError::field("query", "steps", "absent", "missing", remedy));
        };
        if bytes.is_empty() {
            let remedy = "send the checkpoint as the body";
            return Err(AppError::field("request", "body", "0 bytes", "empty", remedy));
        }
        // Refuse before writing a large file for nobody; the transaction decides.
        let held = self.held(job, query.worker, query.attempt).await?;
        if held.state == JobState::Cancelled {
            return Err(AppError::StaleLease(format!("job {job} was cancelled; drop it")));
        }
        let size = bytes.len() as u64;
        let blobs = std::sync::Arc::clone(self.blobs());
        let hash = blocking(move || Ok(blobs.put(&bytes)?)).await?;
        let checkpoint = Checkpoint { hash, steps, bytes: size };
        let now = self.now();
        let new = NewCheckpoint {
            job,
            worker: query.worker,
            attempt: query.attempt,
            checkpoint: checkpoint.clone(),
            lease_until: now.plus(self.config().lease()),
        };
        match self.store().checkpoint(&new, self.limits(), now).await? {
            CheckpointHeld::Newest => {
                self.metrics().checkpoints.inc();
                self.beats().seen(query.worker, now);
                Ok(checkpoint)
            }
            CheckpointHeld::Older(newest) => Ok(newest),
            CheckpointHeld::Not(why) => Err(refusal(job, &why)),
        }
    }

    /// The newest checkpoint, for the holder of the lease.
    ///
    /// # Errors
    /// [`AppError::StaleLease`]; [`AppError::NotFound`] when there is none.
    pub async fn get_checkpoint(
        &self,
        job: JobId,
        query: &CheckpointQuery,
    ) -> AppResult<(Checkpoint, Vec<u8>)> {
        self.held(job, query.worker, query.attempt).await?;
        let missing = || AppError::NotFound { what: "checkpoint of job", id: job.to_string() };
        let checkpoint = self.store().newest_checkpoint(job).await?.ok_or_else(missing)?;
        let blobs = std::sync::Arc::clone(self.blobs());
        let hash = checkpoint.hash.clone();
        let bytes = blocking(move || Ok(blobs.get(&hash)?)).await?;
        Ok((checkpoint, bytes))
    }

    /// Stores the result of a run.
    ///
    /// # Errors
    /// [`AppError::StaleLease`] when the worker does not hold the job any more (its result is kept as evidence when
    /// it once did); [`AppError::Invalid`].
    pub async fn complete(&self, job: JobId, completion: Completion) -> AppResult<Accepted> {
        if completion.outcome.record.is_empty() {
            let remedy = "send the record of the run";
            return Err(AppError::field("result", "outcome.record", "{}", "empty", remedy));
        }
        let Completion { worker, attempt, scene_key, outcome, execution } = completion;
        let record = outcome.record.clone();
        let blobs = std::sync::Arc::clone(self.blobs());
        let (digest, blob, states) = blocking(move || {
            let bug = |error: &dyn std::fmt::Display| AppError::Bug(error.to_string());
            let bytes = serde_json::to_vec(&outcome).map_err(|error| bug(&error))?;
            let digest = blake3::hash(&bytes).to_hex().to_string();
            let packed = zstd::bulk::compress(&bytes, ZSTD_LEVEL).map_err(|error| bug(&error))?;
            let states = if outcome.states.is_empty() {
                None
            } else {
                let bytes = serde_json::to_vec(&outcome.states).map_err(|error| bug(&error))?;
                let packed = zstd::bulk::compress(&bytes, ZSTD_LEVEL).map_err(|error| bug(&error))?;
                Some(blobs.put(&packed)?)
            };
            Ok((digest, blobs.put(&packed)?, states))
        })
        .await?;
        let new = NewResult {
            job,
            worker,
            attempt,
            scene_key,
            digest: digest.clone(),
            outcome: blob,
            states,
            record,
            execution,
        };
        let now = self.now();
        let stored = self.store().complete(&new, self.limits(), now).await?;
        self.beats().seen(worker, now);
        self.note_events();
        match stored {
            Stored::Accepted { alarm } => {
                self.metrics().results.inc();
                self.alarm(alarm, job);
                tracing::info!(%job, attempt, %worker, "result stored");
                Ok(Accepted { job, digest, duplicate: false })
            }
            Stored::Duplicate => {
                self.metrics().duplicates.inc();
                Ok(Accepted { job, digest, duplicate: true })
            }
            Stored::OtherScene { expected } => Err(AppError::field(
                "result",
                "scene_key",
                new.scene_key,
                &format!("is not the scene of this job, {expected}"),
                "send the result to the job it was granted for; check that worker and coordinator reduce alike",
            )),
            Stored::Not { why, kept, alarm } => {
                self.metrics().late.inc();
                self.alarm(alarm, job);
                tracing::warn!(%job, attempt, %worker, kept, "late result refused");
                Err(refusal(job, &why))
            }
        }
    }

    fn alarm(&self, alarm: bool, job: JobId) {
        if alarm {
            self.metrics().alarms.inc();
            tracing::error!(%job, "determinism alarm: results of one scene differ on one hardware class");
        }
    }

    /// The program failed: the job is tried again later, or set aside.
    ///
    /// # Errors
    /// [`AppError::StaleLease`] when the worker does not hold the job any more.
    pub async fn fail(&self, job: JobId, failure: Failure) -> AppResult<Returned> {
        let failure = Failure {
            class: shortened(&failure.class, 200),
            message: shortened(&failure.message, LONGEST_TEXT),
            ..failure
        };
        let rest = std::time::Duration::from_secs_f64(self.config().retry_seconds);
        let now = self.now();
        let write = self.store().fail(job, &failure, self.limits(), rest, now).await?;
        self.beats().seen(failure.worker, now);
        let state = accepted(job, write)?;
        self.metrics().failures.inc();
        tracing::warn!(%job, attempt = failure.attempt, class = %failure.class, message = %failure.message,
            ?state, "run failed");
        self.note_events();
        Ok(Returned { job, state })
    }

    /// The worker gives the job back.
    ///
    /// # Errors
    /// [`AppError::StaleLease`] when the worker does not hold the job any more.
    pub async fn release(&self, job: JobId, release: &Release) -> AppResult<Returned> {
        let who = (release.worker, release.attempt);
        let reason = shortened(&release.reason, LONGEST_TEXT);
        let now = self.now();
        let write = self.store().release(job, who, &reason, self.limits(), now).await?;
        self.beats().seen(release.worker, now);
        let state = accepted(job, write)?;
        self.note_events();
        self.note_work();
        Ok(Returned { job, state })
    }

    /// The lease, if this worker holds it under this attempt, or held it when the job was cancelled.
    async fn held(&self, job: JobId, worker: WorkerId, attempt: u32) -> AppResult<HeldLease> {
        let missing = || AppError::NotFound { what: "job", id: job.to_string() };
        let held = self.store().lease(job).await?.ok_or_else(missing)?;
        let open = matches!(held.state, JobState::Leased | JobState::Cancelled);
        if open && held.attempt == attempt && held.worker == Some(worker) {
            return Ok(held);
        }
        Err(AppError::StaleLease(format!(
            "job {job} is {:?} at attempt {}; worker {worker} does not hold it under attempt {attempt}; drop it",
            held.state, held.attempt
        )))
    }
}

fn accepted(job: JobId, write: LeaseWrite) -> AppResult<JobState> {
    match write {
        LeaseWrite::Accepted(state) => Ok(state),
        refused => Err(refusal(job, &refused)),
    }
}

fn refusal(job: JobId, why: &LeaseWrite) -> AppError {
    match why {
        LeaseWrite::NoJob => AppError::NotFound { what: "job", id: job.to_string() },
        LeaseWrite::OtherWorker => {
            AppError::StaleLease(format!("job {job} is held by another worker; drop it"))
        }
        LeaseWrite::Refused(refused) => AppError::StaleLease(format!("job {job}: {refused}; drop it")),
        LeaseWrite::Accepted(state) => AppError::Bug(format!("job {job} accepted as {state:?} and refused")),
    }
}

fn shortened(text: &str, longest: usize) -> String {
    match text.char_indices().nth(longest) {
        Some((cut, _)) => format!("{}…", &text[..cut]),
        None => text.to_owned(),
    }
}
