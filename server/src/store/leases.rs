//! What the holder of a lease may write: heartbeats, failure, release; and what happens when it falls silent.
//! Every write is fenced by (job, attempt, worker).

use std::time::Duration;

use protocol::api::AttemptEnd;
use protocol::{Failure, JobId, JobState, WorkerId};
use record::Row;
use sqlx::sqlite::SqliteRow;
use sqlx::{Row as _, Sqlite, Transaction};

use super::settle::settle_sweeps_of;
use super::{Store, StoreResult, count, events, from_word, int, read, small, word};
use crate::clock::Moment;
use crate::scheduler::backoff::rest;
use crate::scheduler::lifecycle::{Happening, Job, Limits, Refused};

/// A lease as its holder's message meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldLease {
    /// Number of the job in the database.
    pub seq: i64,
    /// State of the job.
    pub state: JobState,
    /// Current attempt.
    pub attempt: u32,
    /// Who holds it, or held it last.
    pub worker: Option<WorkerId>,
    /// Sweeps on whose behalf it may run.
    pub runnable: u32,
}

/// A sign of life, to be written with many others.
#[derive(Clone, Debug, PartialEq)]
pub struct Beat {
    /// Number of the job in the database.
    pub seq: i64,
    /// Under which attempt.
    pub attempt: u32,
    /// The lease holds until then.
    pub until: Moment,
    /// When it was heard.
    pub at: Moment,
    /// Steps done.
    pub steps: u64,
    /// Expected steps of the whole run.
    pub expected_steps: u64,
    /// Share done.
    pub fraction: f64,
    /// Wall seconds of this attempt.
    pub wall_s: f64,
    /// Live numbers.
    pub live: Row,
}

/// What became of a write under a lease.
#[derive(Clone, Debug, PartialEq)]
pub enum LeaseWrite {
    /// The job's state after it.
    Accepted(JobState),
    /// No such job.
    NoJob,
    /// The writer does not hold the job.
    Refused(Refused),
    /// The attempt belongs to another worker.
    OtherWorker,
}

/// A job row locked by a write transaction.
pub(super) struct Locked {
    pub seq: i64,
    pub id: JobId,
    pub job: Job,
    pub worker: Option<WorkerId>,
    pub cost: f64,
    pub result: Option<i64>,
    pub checkpoint_hash: Option<String>,
    pub checkpoint_steps: Option<u64>,
}

impl Locked {
    fn of(row: &SqliteRow) -> StoreResult<Self> {
        let worker: Option<String> = row.try_get("worker_id")?;
        Ok(Self {
            seq: row.try_get("seq")?,
            id: read("jobs.id", row.try_get::<String, _>("id")?.parse())?,
            job: Job {
                state: from_word("jobs.state", row.try_get("state")?)?,
                attempt: small(row.try_get("attempt")?),
                failures: small(row.try_get("failures")?),
                losses: small(row.try_get("losses")?),
                losses_in_a_row: small(row.try_get("losses_in_a_row")?),
            },
            worker: read("workers.id", worker.map(|id| id.parse()).transpose())?,
            cost: row.try_get("cost")?,
            result: row.try_get("result")?,
            checkpoint_hash: row.try_get("checkpoint_hash")?,
            checkpoint_steps: row.try_get::<Option<i64>, _>("checkpoint_steps")?.map(count),
        })
    }
}

pub(super) async fn lock(tx: &mut Transaction<'_, Sqlite>, job: JobId) -> StoreResult<Option<Locked>> {
    let row = sqlx::query(
        "select j.*, w.id worker_id from jobs j left join workers w on w.seq = j.worker where j.id = ?1",
    )
    .bind(job.to_string())
    .fetch_optional(&mut **tx)
    .await?;
    row.as_ref().map(Locked::of).transpose()
}

/// Writes a job back after a decision; it leaves the lease, if it had one, unless it is leased still.
pub(super) async fn write_back(
    tx: &mut Transaction<'_, Sqlite>,
    seq: i64,
    job: Job,
    not_before: Moment,
) -> StoreResult<()> {
    sqlx::query(
        "update jobs set state = ?2, failures = ?3, losses = ?4, losses_in_a_row = ?5, not_before = ?6,
             lease_until = case when ?2 = 'leased' then lease_until end
         where seq = ?1",
    )
    .bind(seq)
    .bind(word(job.state))
    .bind(job.failures)
    .bind(job.losses)
    .bind(job.losses_in_a_row)
    .bind(not_before.0)
    .execute(&mut **tx)
    .await?;
    Ok(())
}

pub(super) async fn end_attempt(
    tx: &mut Transaction<'_, Sqlite>,
    (job, attempt): (i64, u32),
    end: AttemptEnd,
    evidence: (Option<&str>, Option<&str>),
    now: Moment,
) -> StoreResult<()> {
    sqlx::query(
        "update attempts set ended_at = ?3, \"end\" = ?4, class = ?5, message = ?6
         where job = ?1 and attempt = ?2 and ended_at is null",
    )
    .bind(job)
    .bind(attempt)
    .bind(now.0)
    .bind(word(end))
    .bind(evidence.0)
    .bind(evidence.1)
    .execute(&mut **tx)
    .await?;
    Ok(())
}

impl Store {
    /// The lease of a job, as a heartbeat meets it.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn lease(&self, job: JobId) -> StoreResult<Option<HeldLease>> {
        let row = sqlx::query(
            "select j.seq, j.state, j.attempt, j.runnable, w.id worker_id
             from jobs j left join workers w on w.seq = j.worker where j.id = ?1",
        )
        .bind(job.to_string())
        .fetch_optional(&self.reader)
        .await?;
        let Some(row) = row else { return Ok(None) };
        let worker: Option<String> = row.try_get("worker_id")?;
        Ok(Some(HeldLease {
            seq: row.try_get("seq")?,
            state: from_word("jobs.state", row.try_get("state")?)?,
            attempt: small(row.try_get("attempt")?),
            worker: read("workers.id", worker.map(|id| id.parse()).transpose())?,
            runnable: small(row.try_get("runnable")?),
        }))
    }

    /// Writes many heartbeats and signs of life of workers in one transaction. Stale ones change nothing.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn heartbeats(&self, beats: &[Beat], seen: &[(WorkerId, Moment)]) -> StoreResult<()> {
        if beats.is_empty() && seen.is_empty() {
            return Ok(());
        }
        let mut tx = self.begin().await?;
        write_beats(&mut tx, beats, seen).await?;
        tx.commit().await?;
        Ok(())
    }

    /// The program failed.
    ///
    /// # Errors
    /// When the database refuses; nothing is stored then.
    pub async fn fail(
        &self,
        job: JobId,
        failure: &Failure,
        limits: Limits,
        first_rest: Duration,
        now: Moment,
    ) -> StoreResult<LeaseWrite> {
        let mut tx = self.begin().await?;
        let Some(held) = lock(&mut tx, job).await? else { return Ok(LeaseWrite::NoJob) };
        let next = match held.job.after(Happening::Fail(failure.attempt, failure.kind), limits) {
            Ok(next) => next,
            Err(refused) => return Ok(LeaseWrite::Refused(refused)),
        };
        if held.worker != Some(failure.worker) {
            return Ok(LeaseWrite::OtherWorker);
        }
        write_back(&mut tx, held.seq, next, now.plus(rest(first_rest, next.failures))).await?;
        let evidence = (Some(failure.class.as_str()), Some(failure.message.as_str()));
        end_attempt(&mut tx, (held.seq, failure.attempt), AttemptEnd::Failed, evidence, now).await?;
        let kind = if next.state == JobState::Failed { "job_set_aside" } else { "job_failed" };
        let data = serde_json::json!({
            "attempt": failure.attempt, "class": failure.class, "message": failure.message,
            "failures": next.failures,
        });
        events::append_for_job(&mut tx, now, kind, (held.seq, held.id), &data).await?;
        settle_sweeps_of(&mut tx, held.seq, now).await?;
        tx.commit().await?;
        Ok(LeaseWrite::Accepted(next.state))
    }

    /// The worker gives the job back.
    ///
    /// # Errors
    /// When the database refuses; nothing is stored then.
    pub async fn release(
        &self,
        job: JobId,
        (worker, attempt): (WorkerId, u32),
        reason: &str,
        limits: Limits,
        now: Moment,
    ) -> StoreResult<LeaseWrite> {
        let mut tx = self.begin().await?;
        let Some(held) = lock(&mut tx, job).await? else { return Ok(LeaseWrite::NoJob) };
        let next = match held.job.after(Happening::Release(attempt), limits) {
            Ok(next) => next,
            Err(refused) => return Ok(LeaseWrite::Refused(refused)),
        };
        if held.worker != Some(worker) {
            return Ok(LeaseWrite::OtherWorker);
        }
        write_back(&mut tx, held.seq, next, Moment(0)).await?;
        end_attempt(&mut tx, (held.seq, attempt), AttemptEnd::Released, (None, Some(reason)), now).await?;
        let data = serde_json::json!({ "attempt": attempt, "reason": reason });
        events::append_for_job(&mut tx, now, "job_released", (held.seq, held.id), &data).await?;
        tx.commit().await?;
        Ok(LeaseWrite::Accepted(next.state))
    }

    /// Takes back every lease that ran out, after writing the heartbeats heard so far. Returns how many.
    ///
    /// # Errors
    /// When the database refuses; nothing is changed then.
    pub async fn reap(
        &self,
        beats: &[Beat],
        seen: &[(WorkerId, Moment)],
        limits: Limits,
        now: Moment,
    ) -> StoreResult<u64> {
        let mut tx = self.begin().await?;
        write_beats(&mut tx, beats, seen).await?;
        let rows = sqlx::query(
            "select j.*, w.id worker_id from jobs j indexed by jobs_leased left join workers w on w.seq = j.worker
             where j.state = 'leased' and j.lease_until < ?1",
        )
        .bind(now.0)
        .fetch_all(&mut *tx)
        .await?;
        for row in &rows {
            let held = Locked::of(row)?;
            let attempt = held.job.attempt;
            let Ok(next) = held.job.after(Happening::Expire(attempt), limits) else { continue };
            write_back(&mut tx, held.seq, next, Moment(0)).await?;
            let message = "no sign of life before the lease ran out";
            end_attempt(&mut tx, (held.seq, attempt), AttemptEnd::Lost, (None, Some(message)), now).await?;
            let kind = if next.state == JobState::Failed { "job_set_aside" } else { "job_lost" };
            let data = serde_json::json!({
                "attempt": attempt, "worker": held.worker, "losses": next.losses,
                "losses_in_a_row": next.losses_in_a_row,
            });
            events::append_for_job(&mut tx, now, kind, (held.seq, held.id), &data).await?;
            settle_sweeps_of(&mut tx, held.seq, now).await?;
        }
        tx.commit().await?;
        Ok(rows.len() as u64)
    }

    /// Whether a lease ran out before `now`, as far as the database knows. A read.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn any_expired(&self, now: Moment) -> StoreResult<bool> {
        let any: Option<i64> = sqlx::query_scalar(
            "select 1 from jobs indexed by jobs_leased where state = 'leased' and lease_until < ?1 limit 1",
        )
        .bind(now.0)
        .fetch_optional(&self.reader)
        .await?;
        Ok(any.is_some())
    }

    /// After a start: every lease holds at least until `until`, because its worker could not be heard.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn grace(&self, until: Moment) -> StoreResult<u64> {
        let done =
            sqlx::query("update jobs set lease_until = ?1 where state = 'leased' and lease_until < ?1")
                .bind(until.0)
                .execute(&self.writer)
                .await?;
        Ok(done.rows_affected())
    }
}

async fn write_beats(
    tx: &mut Transaction<'_, Sqlite>,
    beats: &[Beat],
    seen: &[(WorkerId, Moment)],
) -> StoreResult<()> {
    for beat in beats {
        let renewed = sqlx::query(
            "update jobs set lease_until = max(lease_until, ?3)
             where seq = ?1 and attempt = ?2 and state = 'leased'",
        )
        .bind(beat.seq)
        .bind(beat.attempt)
        .bind(beat.until.0)
        .execute(&mut **tx)
        .await?;
        if renewed.rows_affected() == 0 {
            continue;
        }
        sqlx::query(
            "update attempts set steps = ?3, expected_steps = ?4, fraction = ?5, wall_s = ?6, live = ?7
             where job = ?1 and attempt = ?2",
        )
        .bind(beat.seq)
        .bind(beat.attempt)
        .bind(int(beat.steps))
        .bind(int(beat.expected_steps))
        .bind(beat.fraction)
        .bind(beat.wall_s)
        .bind(read("live", serde_json::to_string(&beat.live))?)
        .execute(&mut **tx)
        .await?;
    }
    for (worker, at) in seen {
        sqlx::query("update workers set seen_at = max(seen_at, ?2) where id = ?1")
            .bind(worker.to_string())
            .bind(at.0)
            .execute(&mut **tx)
            .await?;
    }
    Ok(())
}
