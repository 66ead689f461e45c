//! When a sweep is over.

use protocol::SweepId;
use sqlx::sqlite::SqliteRow;
use sqlx::{Row as _, Sqlite, Transaction};

use super::control::shift_runnable;
use super::{Store, StoreResult, events, read};
use crate::clock::Moment;

/// Closes the sweep if nothing of it waits or runs.
pub(super) async fn settle_sweep(
    tx: &mut Transaction<'_, Sqlite>,
    sweep: i64,
    now: Moment,
) -> StoreResult<usize> {
    let over = sqlx::query(
        "select seq, state from sweeps
         where seq = ?1 and state in ('running', 'paused') and scanned >= candidates and queued + leased = 0",
    )
    .bind(sweep)
    .fetch_all(&mut **tx)
    .await?;
    close(tx, &over, now).await
}

/// Closes every sweep of a job of which nothing waits or runs any more.
pub(super) async fn settle_sweeps_of(
    tx: &mut Transaction<'_, Sqlite>,
    job: i64,
    now: Moment,
) -> StoreResult<usize> {
    let over = sqlx::query(
        "select seq, state from sweeps
         where seq in (select sweep from wants where job = ?1)
           and state in ('running', 'paused') and scanned >= candidates and queued + leased = 0",
    )
    .bind(job)
    .fetch_all(&mut **tx)
    .await?;
    close(tx, &over, now).await
}

async fn close(tx: &mut Transaction<'_, Sqlite>, over: &[SqliteRow], now: Moment) -> StoreResult<usize> {
    for row in over {
        let sweep: i64 = row.try_get("seq")?;
        if row.try_get::<String, _>("state")? == "paused" {
            // The pause ends with the sweep: a later retry of its jobs runs on its behalf.
            shift_runnable(tx, sweep, 1).await?;
        }
        let closed = sqlx::query(
            "update sweeps set state = case when failed + cancelled > 0 then 'failed' else 'done' end,
                 finished_at = ?1
             where seq = ?2 returning id, state",
        )
        .bind(now.0)
        .bind(sweep)
        .fetch_one(&mut **tx)
        .await?;
        let id: SweepId = read("sweeps.id", closed.try_get::<String, _>("id")?.parse())?;
        let data = serde_json::json!({ "state": closed.try_get::<String, _>("state")? });
        events::append(tx, now, "sweep_state", Some(id), None, &data).await?;
    }
    Ok(over.len())
}

impl Store {
    /// Closes every sweep that is over and was not closed with its last job. Idempotent.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn settle_all(&self, now: Moment) -> StoreResult<usize> {
        let candidates: Vec<i64> = sqlx::query_scalar(
            "select seq from sweeps
             where state in ('running', 'paused') and scanned >= candidates and queued + leased = 0",
        )
        .fetch_all(&self.reader)
        .await?;
        if candidates.is_empty() {
            return Ok(0);
        }
        let mut tx = self.begin().await?;
        let mut closed = 0;
        for sweep in candidates {
            closed += settle_sweep(&mut tx, sweep, now).await?;
        }
        tx.commit().await?;
        Ok(closed)
    }
}
