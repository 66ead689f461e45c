//! Results: accepted once per job, compared with every other of the same scene, never merged.

use protocol::api::AttemptEnd;
use protocol::{JobId, JobState, WorkerId};
use record::Row;
use sqlx::sqlite::SqliteRow;
use sqlx::{Row as _, Sqlite, Transaction};

use super::checkpoints::drop_blob;
use super::leases::{Locked, end_attempt, lock, write_back};
use super::settle::settle_sweeps_of;
use super::{LeaseWrite, Store, StoreResult, count, events, read};
use crate::clock::Moment;
use crate::scheduler::lifecycle::{Happening, Limits};

/// A result whose outcome is stored as a blob already.
#[derive(Clone, Debug, PartialEq)]
pub struct NewResult {
    /// The job.
    pub job: JobId,
    /// Who ran it.
    pub worker: WorkerId,
    /// Under which attempt.
    pub attempt: u32,
    /// Scene key, as the worker says.
    pub scene_key: String,
    /// Digest of the outcome.
    pub digest: String,
    /// Blob of the outcome.
    pub outcome: String,
    /// Blob of the states of a loading path.
    pub states: Option<String>,
    /// The physics' record.
    pub record: Row,
    /// Facts of the execution.
    pub execution: Row,
}

/// What became of a result.
#[derive(Clone, Debug, PartialEq)]
pub enum Stored {
    /// It is the result of the job. `alarm`: it differs from another one of the same hardware class.
    Accepted {
        /// Determinism fault.
        alarm: bool,
    },
    /// This very result of this very attempt was accepted before.
    Duplicate,
    /// The writer does not hold the job. `kept`: stored as evidence, because the attempt was once the writer's.
    Not {
        /// Why.
        why: LeaseWrite,
        /// Kept as evidence.
        kept: bool,
        /// It differs from another result of the same hardware class.
        alarm: bool,
    },
    /// The scene key is not the job's.
    OtherScene {
        /// The job's key.
        expected: String,
    },
}

/// A finished point, with all that makes its row.
#[derive(Clone, Debug)]
pub struct RunRow {
    /// Place in the sweep.
    pub point: u64,
    /// The job.
    pub job: JobId,
    /// Scene key.
    pub scene_key: String,
    /// SI scene, JSON text.
    pub scene: String,
    /// Reduced scene, JSON text.
    pub reduced: String,
    /// Version of the physics.
    pub physics_version: u32,
    /// The physics' record.
    pub record: Row,
    /// Facts of the execution.
    pub execution: Row,
    /// Blob of the outcome.
    pub outcome: String,
    /// Blob of the states of a loading path.
    pub states: Option<String>,
    /// Determinism fault.
    pub alarm: bool,
    /// Attempt that made it.
    pub attempt: u32,
    /// Host that made it.
    pub host: String,
}

impl RunRow {
    fn of(row: &SqliteRow) -> StoreResult<Self> {
        let record: String = row.try_get("record")?;
        let execution: String = row.try_get("execution")?;
        Ok(Self {
            point: count(row.try_get("point")?),
            job: read("jobs.id", row.try_get::<String, _>("id")?.parse())?,
            scene_key: row.try_get("scene_key")?,
            scene: row.try_get("scene")?,
            reduced: row.try_get("reduced")?,
            physics_version: super::small(row.try_get("physics_version")?),
            record: read("results.record", serde_json::from_str(&record))?,
            execution: read("results.execution", serde_json::from_str(&execution))?,
            outcome: row.try_get("outcome")?,
            states: row.try_get("states")?,
            alarm: row.try_get("alarm")?,
            attempt: super::small(row.try_get("attempt")?),
            host: row.try_get("host")?,
        })
    }
}

impl Store {
    /// Stores a result.
    ///
    /// # Errors
    /// When the database refuses; nothing is stored then.
    pub async fn complete(&self, new: &NewResult, limits: Limits, now: Moment) -> StoreResult<Stored> {
        let mut tx = self.begin().await?;
        let Some(held) = lock(&mut tx, new.job).await? else {
            let_go(&mut tx, new, now).await?;
            tx.commit().await?;
            return Ok(Stored::Not { why: LeaseWrite::NoJob, kept: false, alarm: false });
        };
        let expected: String = sqlx::query_scalar("select scene_key from jobs where seq = ?1")
            .bind(held.seq)
            .fetch_one(&mut *tx)
            .await?;
        if expected != new.scene_key {
            let_go(&mut tx, new, now).await?;
            tx.commit().await?;
            return Ok(Stored::OtherScene { expected });
        }
        let stored = match held.job.after(Happening::Complete(new.attempt), limits) {
            Ok(next) if held.worker == Some(new.worker) => {
                let (result, alarm) = keep(&mut tx, &held, new, now).await?;
                write_back(&mut tx, held.seq, next, Moment(0)).await?;
                accept(&mut tx, &held, result, new, now).await?;
                Stored::Accepted { alarm }
            }
            other => {
                let why = match other {
                    Ok(_) => LeaseWrite::OtherWorker,
                    Err(refused) => LeaseWrite::Refused(refused),
                };
                late(&mut tx, &held, new, why, now).await?
            }
        };
        tx.commit().await?;
        Ok(stored)
    }

    /// Finished points of a sweep after `after`, in order.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn runs(&self, sweep: i64, after: Option<u64>, limit: u32) -> StoreResult<Vec<RunRow>> {
        let rows = sqlx::query(
            "select p.point, p.scene, j.id, j.scene_key, j.reduced, j.physics_version,
                    r.record, r.execution, r.outcome, r.states, r.alarm, r.attempt, w.host
             from points p
             cross join jobs j on j.seq = p.job
             cross join results r on r.seq = j.result
             cross join workers w on w.seq = r.worker
             where p.sweep = ?1 and p.point > ?2 order by p.point limit ?3",
        )
        .bind(sweep)
        .bind(after.map_or(-1, super::int))
        .bind(limit)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(RunRow::of).collect()
    }

    /// Blob of the accepted outcome of a job.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn outcome_of(&self, job: JobId) -> StoreResult<Option<String>> {
        Ok(sqlx::query_scalar(
            "select r.outcome from jobs j join results r on r.seq = j.result where j.id = ?1",
        )
        .bind(job.to_string())
        .fetch_optional(&self.reader)
        .await?)
    }
}

/// Notes the files of a result that is not stored.
async fn let_go(tx: &mut Transaction<'_, Sqlite>, new: &NewResult, now: Moment) -> StoreResult<()> {
    drop_blob(tx, &new.outcome, now).await?;
    if let Some(states) = &new.states {
        drop_blob(tx, states, now).await?;
    }
    Ok(())
}

/// Inserts the result row, or finds the one with the same bytes, and looks for a contradiction.
async fn keep(
    tx: &mut Transaction<'_, Sqlite>,
    held: &Locked,
    new: &NewResult,
    now: Moment,
) -> StoreResult<(i64, bool)> {
    let hardware: String = sqlx::query_scalar("select hardware from workers where id = ?1")
        .bind(new.worker.to_string())
        .fetch_one(&mut **tx)
        .await?;
    let seq: i64 = sqlx::query_scalar(
        "insert into results (job, digest, attempt, worker, hardware, record, execution, outcome, states,
             stored_at)
         select ?1, ?2, ?3, seq, hardware, ?4, ?5, ?6, ?7, ?8 from workers where id = ?9
         on conflict (job, digest, hardware) do update set digest = excluded.digest
         returning seq",
    )
    .bind(held.seq)
    .bind(&new.digest)
    .bind(new.attempt)
    .bind(read("record", serde_json::to_string(&new.record))?)
    .bind(read("execution", serde_json::to_string(&new.execution))?)
    .bind(&new.outcome)
    .bind(&new.states)
    .bind(now.0)
    .bind(new.worker.to_string())
    .fetch_one(&mut **tx)
    .await?;
    let marked = sqlx::query(
        "update results set alarm = 1 where job = ?1 and hardware = ?2
             and (select count(distinct digest) from results where job = ?1 and hardware = ?2) > 1",
    )
    .bind(held.seq)
    .bind(&hardware)
    .execute(&mut **tx)
    .await?;
    let alarm = marked.rows_affected() > 0;
    if alarm {
        let data = serde_json::json!({
            "hardware": hardware, "attempt": new.attempt, "digest": new.digest,
            "message": "two runs of one scene on one hardware class differ; both are kept",
        });
        events::append_for_job(tx, now, "determinism_alarm", (held.seq, held.id), &data).await?;
    }
    Ok((seq, alarm))
}

/// The result becomes the job's.
async fn accept(
    tx: &mut Transaction<'_, Sqlite>,
    held: &Locked,
    result: i64,
    new: &NewResult,
    now: Moment,
) -> StoreResult<()> {
    sqlx::query(
        "update jobs set result = ?2, checkpoint_hash = null, checkpoint_steps = null, checkpoint_bytes = null
         where seq = ?1",
    )
    .bind(held.seq)
    .bind(result)
    .execute(&mut **tx)
    .await?;
    if let Some(checkpoint) = &held.checkpoint_hash {
        drop_blob(tx, checkpoint, now).await?;
    }
    let wall = new.execution.real("wall_s").filter(|wall| *wall > 0.0);
    sqlx::query(
        "update attempts set fraction = 1, wall_s = coalesce(?3, wall_s), steps = coalesce(?4, steps)
         where job = ?1 and attempt = ?2",
    )
    .bind(held.seq)
    .bind(new.attempt)
    .bind(wall)
    .bind(new.record.real("steps").map(steps_of))
    .execute(&mut **tx)
    .await?;
    end_attempt(tx, (held.seq, new.attempt), AttemptEnd::Done, (None, None), now).await?;
    if let Some(wall) = wall {
        sqlx::query(
            "update sweeps set timed_cost = timed_cost + ?2, timed_wall = timed_wall + ?3
             where seq in (select sweep from wants where job = ?1)",
        )
        .bind(held.seq)
        .bind(held.cost)
        .bind(wall)
        .execute(&mut **tx)
        .await?;
    }
    let data = serde_json::json!({ "attempt": new.attempt, "status": new.record.text("status") });
    events::append_for_job(tx, now, "job_done", (held.seq, held.id), &data).await?;
    settle_sweeps_of(tx, held.seq, now).await?;
    Ok(())
}

#[expect(clippy::cast_possible_truncation, reason = "a count of steps far below 2^53")]
fn steps_of(steps: f64) -> i64 {
    steps as i64
}

/// A result from somebody who does not hold the job.
async fn late(
    tx: &mut Transaction<'_, Sqlite>,
    held: &Locked,
    new: &NewResult,
    why: LeaseWrite,
    now: Moment,
) -> StoreResult<Stored> {
    if held.job.state == JobState::Done {
        let same: Option<i64> = sqlx::query_scalar(
            "select 1 from results r join workers w on w.seq = r.worker
             where r.seq = ?1 and r.digest = ?2 and r.attempt = ?3 and w.id = ?4",
        )
        .bind(held.result)
        .bind(&new.digest)
        .bind(new.attempt)
        .bind(new.worker.to_string())
        .fetch_optional(&mut **tx)
        .await?;
        if same.is_some() {
            return Ok(Stored::Duplicate);
        }
    }
    let was_theirs: Option<i64> = sqlx::query_scalar(
        "select 1 from attempts a join workers w on w.seq = a.worker
         where a.job = ?1 and a.attempt = ?2 and w.id = ?3",
    )
    .bind(held.seq)
    .bind(new.attempt)
    .bind(new.worker.to_string())
    .fetch_optional(&mut **tx)
    .await?;
    if was_theirs.is_none() {
        let_go(tx, new, now).await?;
        return Ok(Stored::Not { why, kept: false, alarm: false });
    }
    let (_, alarm) = keep(tx, held, new, now).await?;
    Ok(Stored::Not { why, kept: true, alarm })
}
