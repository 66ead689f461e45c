//! The log of what happened.

use protocol::{JobId, SweepId};
use serde_json::Value;
use sqlx::{Row as _, Sqlite, Transaction};

use super::{Store, StoreResult, int, read};
use crate::clock::Moment;

/// An event as stored.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredEvent {
    /// Its number; grows.
    pub seq: i64,
    /// When.
    pub at: Moment,
    /// What.
    pub kind: String,
    /// Which sweep.
    pub sweep: Option<SweepId>,
    /// Which job.
    pub job: Option<JobId>,
    /// Details.
    pub data: Value,
}

/// Appends an event inside a transaction.
pub(super) async fn append(
    tx: &mut Transaction<'_, Sqlite>,
    now: Moment,
    kind: &str,
    sweep: Option<SweepId>,
    job: Option<JobId>,
    data: &Value,
) -> StoreResult<()> {
    sqlx::query("insert into events (at, kind, sweep, job, data) values (?1, ?2, ?3, ?4, ?5)")
        .bind(now.0)
        .bind(kind)
        .bind(sweep.map(|id| id.to_string()))
        .bind(job.map(|id| id.to_string()))
        .bind(data.to_string())
        .execute(&mut **tx)
        .await?;
    Ok(())
}

/// Appends an event of a job to every sweep that has it.
pub(super) async fn append_for_job(
    tx: &mut Transaction<'_, Sqlite>,
    now: Moment,
    kind: &str,
    job: (i64, JobId),
    data: &Value,
) -> StoreResult<()> {
    sqlx::query(
        "insert into events (at, kind, sweep, job, data)
         select ?1, ?2, s.id, ?3, ?4 from wants w join sweeps s on s.seq = w.sweep where w.job = ?5",
    )
    .bind(now.0)
    .bind(kind)
    .bind(job.1.to_string())
    .bind(data.to_string())
    .bind(job.0)
    .execute(&mut **tx)
    .await?;
    Ok(())
}

impl Store {
    /// Events after `after`, oldest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn events(
        &self,
        after: i64,
        sweep: Option<SweepId>,
        limit: u32,
    ) -> StoreResult<Vec<StoredEvent>> {
        let rows = sqlx::query(
            "select * from events where seq > ?1 and (?2 is null or sweep = ?2) order by seq limit ?3",
        )
        .bind(after)
        .bind(sweep.map(|id| id.to_string()))
        .bind(limit)
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .map(|row| {
                let sweep: Option<String> = row.try_get("sweep")?;
                let job: Option<String> = row.try_get("job")?;
                let data: String = row.try_get("data")?;
                Ok(StoredEvent {
                    seq: row.try_get("seq")?,
                    at: Moment(row.try_get("at")?),
                    kind: row.try_get("kind")?,
                    sweep: read("events.sweep", sweep.map(|id| id.parse()).transpose())?,
                    job: read("events.job", job.map(|id| id.parse()).transpose())?,
                    data: read("events.data", serde_json::from_str(&data))?,
                })
            })
            .collect()
    }

    /// Numbers of the oldest and the newest event kept; zeros when there is none.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn event_range(&self) -> StoreResult<(i64, i64)> {
        let row = sqlx::query("select coalesce(min(seq), 0) a, coalesce(max(seq), 0) b from events")
            .fetch_one(&self.reader)
            .await?;
        Ok((row.try_get("a")?, row.try_get("b")?))
    }

    /// Drops all but the newest `keep` events.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn trim_events(&self, keep: u64) -> StoreResult<u64> {
        let (oldest, newest) = self.event_range().await?;
        let first_kept = newest - int(keep);
        if oldest > first_kept || newest == 0 {
            return Ok(0);
        }
        let done = sqlx::query("delete from events where seq <= ?1 and seq < ?2 + 20000")
            .bind(first_kept)
            .bind(oldest)
            .execute(&self.writer)
            .await?;
        Ok(done.rows_affected())
    }
}
