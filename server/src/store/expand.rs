//! Turning points into jobs, chunk by chunk, and asking which scene keys are known.

use std::ops::Range;

use protocol::{JobId, JobState, SweepId};
use serde::Serialize;
use serde_json::Value;
use sqlx::Row as _;

use super::settle::settle_sweep;
use super::{Store, StoreResult, count, events, from_word, int, read};
use crate::clock::Moment;

/// One point, ready to be stored.
#[derive(Clone, Debug, Serialize)]
pub struct ExpandedPoint {
    /// Its place in the sweep.
    pub point: u64,
    /// Identity of the run.
    pub key: String,
    /// Id the job gets if it is new.
    pub job: JobId,
    /// The engine.
    pub model: String,
    /// Version of the physics.
    pub physics_version: u32,
    /// Reduced scene as JSON text.
    pub reduced: String,
    /// SI scene as JSON text.
    pub scene: String,
    /// Estimated cost [core-seconds].
    pub cost: f64,
}

/// A sweep whose expansion is not finished.
#[derive(Clone, Debug)]
pub struct Expanding {
    /// Its number in the database.
    pub seq: i64,
    /// Its id.
    pub id: SweepId,
    /// Its definition.
    pub definition: Value,
    /// Places of the sweep's order looked at so far.
    pub scanned: u64,
    /// Places in all.
    pub candidates: u64,
}

/// What is known about a scene key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// The key.
    pub key: String,
    /// State of its job.
    pub state: JobState,
}

impl Store {
    /// Sweeps whose expansion has to go on, oldest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn expanding(&self) -> StoreResult<Vec<Expanding>> {
        let rows = sqlx::query(
            "select seq, id, definition, scanned, candidates from sweeps
             where state in ('expanding', 'paused') and scanned < candidates order by seq",
        )
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .map(|row| {
                let definition: String = row.try_get("definition")?;
                Ok(Expanding {
                    seq: row.try_get("seq")?,
                    id: read("sweeps.id", row.try_get::<String, _>("id")?.parse())?,
                    definition: read("sweeps.definition", serde_json::from_str(&definition))?,
                    scanned: count(row.try_get("scanned")?),
                    candidates: count(row.try_get("candidates")?),
                })
            })
            .collect()
    }

    /// Stores the points among the places `places` of a sweep's order in one transaction: new jobs, points, wants
    /// and counts together. Places that do not follow the stored ones (another call was faster) change nothing.
    /// Returns the number of places looked at so far, or `None` when the sweep wants no more.
    ///
    /// # Errors
    /// When the database refuses; nothing is stored then.
    pub async fn expand(
        &self,
        sweep: i64,
        places: Range<u64>,
        chunk: &[ExpandedPoint],
        now: Moment,
    ) -> StoreResult<Option<u64>> {
        let mut tx = self.begin().await?;
        let row = sqlx::query("select id, state, priority, scanned, candidates from sweeps where seq = ?1")
            .bind(sweep)
            .fetch_one(&mut *tx)
            .await?;
        let id: SweepId = read("sweeps.id", row.try_get::<String, _>("id")?.parse())?;
        let state: String = row.try_get("state")?;
        let priority: i64 = row.try_get("priority")?;
        let scanned = count(row.try_get("scanned")?);
        let candidates = count(row.try_get("candidates")?);
        if !matches!(state.as_str(), "expanding" | "paused") {
            return Ok(None);
        }
        if places.start != scanned {
            return Ok(Some(scanned));
        }
        let runnable = i64::from(state == "expanding");
        let batch = read("chunk", serde_json::to_string(chunk))?;

        sqlx::query(
            "insert into jobs (id, scene_key, model, physics_version, reduced, scene, cost)
             select value ->> 'job', value ->> 'key', value ->> 'model', value ->> 'physics_version',
                    value ->> 'reduced', value ->> 'scene', value ->> 'cost'
             from json_each(?1) where true
             on conflict (scene_key) do nothing",
        )
        .bind(&batch)
        .execute(&mut *tx)
        .await?;
        // A job that was given up is wanted again.
        sqlx::query(
            "update jobs set state = 'queued', failures = 0, losses_in_a_row = 0, not_before = 0
             where state = 'cancelled' and scene_key in (select value ->> 'key' from json_each(?1))",
        )
        .bind(&batch)
        .execute(&mut *tx)
        .await?;
        sqlx::query(
            "insert into points (sweep, point, job, scene)
             select ?2, value ->> 'point', jobs.seq, value ->> 'scene'
             from json_each(?1) cross join jobs on jobs.scene_key = value ->> 'key'",
        )
        .bind(&batch)
        .bind(sweep)
        .execute(&mut *tx)
        .await?;
        sqlx::query(
            "update jobs set wanted = wanted + 1, runnable = runnable + ?3,
                 priority = case when wanted = 0 then ?4 else max(priority, ?4) end
             where scene_key in (select value ->> 'key' from json_each(?1))
               and not exists (select 1 from wants where wants.job = jobs.seq and wants.sweep = ?2)",
        )
        .bind(&batch)
        .bind(sweep)
        .bind(runnable)
        .bind(priority)
        .execute(&mut *tx)
        .await?;
        sqlx::query(
            "insert into wants (job, sweep, points)
             select jobs.seq, ?2, count(*)
             from json_each(?1) cross join jobs on jobs.scene_key = value ->> 'key' group by jobs.seq
             on conflict (job, sweep) do update set points = points + excluded.points",
        )
        .bind(&batch)
        .bind(sweep)
        .execute(&mut *tx)
        .await?;
        sqlx::query(
            "update sweeps set expanded = sweeps.expanded + s.n, scanned = ?3,
                 reused = sweeps.reused + s.done,
                 queued = sweeps.queued + s.queued, leased = sweeps.leased + s.leased, done = sweeps.done + s.done,
                 failed = sweeps.failed + s.failed, cost = sweeps.cost + s.cost,
                 cost_done = sweeps.cost_done + s.cost_done,
                 cost_given_up = sweeps.cost_given_up + s.cost_failed
             from (select count(*) n, coalesce(sum(state = 'queued'), 0) queued,
                       coalesce(sum(state = 'leased'), 0) leased, coalesce(sum(state = 'done'), 0) done,
                       coalesce(sum(state = 'failed'), 0) failed, coalesce(total(cost), 0.0) cost,
                       total(cost * (state = 'done')) cost_done, total(cost * (state = 'failed')) cost_failed
                   from json_each(?1) e cross join jobs on jobs.scene_key = e.value ->> 'key') s
             where sweeps.seq = ?2",
        )
        .bind(&batch)
        .bind(sweep)
        .bind(int(places.end))
        .execute(&mut *tx)
        .await?;
        if places.end >= candidates && state == "expanding" {
            sqlx::query("update sweeps set state = 'running' where seq = ?1")
                .bind(sweep)
                .execute(&mut *tx)
                .await?;
            let data = serde_json::json!({ "state": "running" });
            events::append(&mut tx, now, "sweep_state", Some(id), None, &data).await?;
        }
        settle_sweep(&mut tx, sweep, now).await?;
        tx.commit().await?;
        Ok(Some(places.end))
    }

    /// Which of these scene keys have a job, and in which state.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn known(&self, keys: &[String]) -> StoreResult<Vec<Known>> {
        let rows = sqlx::query(
            "select j.scene_key, j.state from json_each(?1) e cross join jobs j on j.scene_key = e.value",
        )
        .bind(read("keys", serde_json::to_string(keys))?)
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .map(|row| {
                let state = from_word("jobs.state", row.try_get("state")?)?;
                Ok(Known { key: row.try_get("scene_key")?, state })
            })
            .collect()
    }
}
