//! One job with its attempts and results.

use protocol::api::AttemptEnd;
use protocol::{Checkpoint, JobId, JobState, SweepId, WorkerId};
use record::Row;
use serde_json::Value;
use sqlx::Row as _;
use sqlx::sqlite::SqliteRow;

use super::claims::checkpoint_of;
use super::{Store, StoreResult, count, from_word, read, small};
use crate::clock::Moment;

/// A job.
#[derive(Clone, Debug)]
pub struct JobRow {
    /// Its number in the database.
    pub seq: i64,
    /// Its id.
    pub id: JobId,
    /// Identity of the run.
    pub scene_key: String,
    /// The engine.
    pub model: String,
    /// Version of the physics.
    pub physics_version: u32,
    /// Reduced scene.
    pub reduced: Value,
    /// SI scene of the first point.
    pub scene: Value,
    /// State.
    pub state: JobState,
    /// Priority.
    pub priority: i64,
    /// Estimated cost [core-seconds].
    pub cost: f64,
    /// Newest attempt.
    pub attempt: u32,
    /// The program's fault.
    pub failures: u32,
    /// Lost workers.
    pub losses: u32,
    /// Newest checkpoint.
    pub checkpoint: Option<Checkpoint>,
    /// The accepted result.
    pub result: Option<i64>,
}

/// One execution.
#[derive(Clone, Debug)]
pub struct AttemptRow {
    /// Its number.
    pub attempt: u32,
    /// Who ran it.
    pub worker: WorkerId,
    /// On which machine.
    pub host: String,
    /// Start.
    pub started_at: Moment,
    /// End.
    pub ended_at: Option<Moment>,
    /// How it ended.
    pub end: Option<AttemptEnd>,
    /// Class of a failure.
    pub class: Option<String>,
    /// Evidence.
    pub message: Option<String>,
    /// Steps done at the last sign of life.
    pub steps: u64,
    /// Expected steps.
    pub expected_steps: u64,
    /// Share done.
    pub fraction: f64,
    /// Wall seconds.
    pub wall_s: f64,
    /// Live numbers.
    pub live: Row,
}

/// A stored result of a job.
#[derive(Clone, Debug)]
pub struct ResultRow {
    /// Its number in the database.
    pub seq: i64,
    /// Digest of the outcome.
    pub digest: String,
    /// Attempt that made it.
    pub attempt: u32,
    /// Hardware class.
    pub hardware: String,
    /// Determinism fault.
    pub alarm: bool,
    /// When it arrived.
    pub stored_at: Moment,
    /// The physics' record.
    pub record: Row,
    /// Facts of the execution.
    pub execution: Row,
}

impl JobRow {
    fn of(row: &SqliteRow) -> StoreResult<Self> {
        let reduced: String = row.try_get("reduced")?;
        let scene: String = row.try_get("scene")?;
        Ok(Self {
            seq: row.try_get("seq")?,
            id: read("jobs.id", row.try_get::<String, _>("id")?.parse())?,
            scene_key: row.try_get("scene_key")?,
            model: row.try_get("model")?,
            physics_version: small(row.try_get("physics_version")?),
            reduced: read("jobs.reduced", serde_json::from_str(&reduced))?,
            scene: read("jobs.scene", serde_json::from_str(&scene))?,
            state: from_word("jobs.state", row.try_get("state")?)?,
            priority: row.try_get("priority")?,
            cost: row.try_get("cost")?,
            attempt: small(row.try_get("attempt")?),
            failures: small(row.try_get("failures")?),
            losses: small(row.try_get("losses")?),
            checkpoint: checkpoint_of(row)?,
            result: row.try_get("result")?,
        })
    }
}

impl Store {
    /// A job by id.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn job(&self, id: JobId) -> StoreResult<Option<JobRow>> {
        let row = sqlx::query("select * from jobs where id = ?1")
            .bind(id.to_string())
            .fetch_optional(&self.reader)
            .await?;
        row.as_ref().map(JobRow::of).transpose()
    }

    /// A job by scene key.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn job_of_key(&self, key: &str) -> StoreResult<Option<JobRow>> {
        let row = sqlx::query("select * from jobs where scene_key = ?1")
            .bind(key)
            .fetch_optional(&self.reader)
            .await?;
        row.as_ref().map(JobRow::of).transpose()
    }

    /// Sweeps that have a job, oldest first, at most 100.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn sweeps_of_job(&self, job: i64) -> StoreResult<Vec<SweepId>> {
        let ids: Vec<String> = sqlx::query_scalar(
            "select s.id from wants w join sweeps s on s.seq = w.sweep where w.job = ?1 order by s.seq limit 100",
        )
        .bind(job)
        .fetch_all(&self.reader)
        .await?;
        ids.into_iter().map(|id| read("sweeps.id", id.parse())).collect()
    }

    /// The newest 100 attempts of a job, oldest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn attempts(&self, job: i64) -> StoreResult<Vec<AttemptRow>> {
        let rows = sqlx::query(
            "select a.*, w.id worker_id, w.host from attempts a join workers w on w.seq = a.worker
             where a.job = ?1 order by a.attempt desc limit 100",
        )
        .bind(job)
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .rev()
            .map(|row| {
                let end: Option<String> = row.try_get("end")?;
                let live: String = row.try_get("live")?;
                Ok(AttemptRow {
                    attempt: small(row.try_get("attempt")?),
                    worker: read("workers.id", row.try_get::<String, _>("worker_id")?.parse())?,
                    host: row.try_get("host")?,
                    started_at: Moment(row.try_get("started_at")?),
                    ended_at: row.try_get::<Option<i64>, _>("ended_at")?.map(Moment),
                    end: end.map(|word| from_word("attempts.end", word)).transpose()?,
                    class: row.try_get("class")?,
                    message: row.try_get("message")?,
                    steps: count(row.try_get("steps")?),
                    expected_steps: count(row.try_get("expected_steps")?),
                    fraction: row.try_get("fraction")?,
                    wall_s: row.try_get("wall_s")?,
                    live: read("attempts.live", serde_json::from_str(&live))?,
                })
            })
            .collect()
    }

    /// Every result of a job, oldest first, at most 100.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn results_of_job(&self, job: i64) -> StoreResult<Vec<ResultRow>> {
        let rows = sqlx::query("select * from results where job = ?1 order by seq limit 100")
            .bind(job)
            .fetch_all(&self.reader)
            .await?;
        rows.iter()
            .map(|row| {
                let record: String = row.try_get("record")?;
                let execution: String = row.try_get("execution")?;
                Ok(ResultRow {
                    seq: row.try_get("seq")?,
                    digest: row.try_get("digest")?,
                    attempt: small(row.try_get("attempt")?),
                    hardware: row.try_get("hardware")?,
                    alarm: row.try_get("alarm")?,
                    stored_at: Moment(row.try_get("stored_at")?),
                    record: read("results.record", serde_json::from_str(&record))?,
                    execution: read("results.execution", serde_json::from_str(&execution))?,
                })
            })
            .collect()
    }
}
