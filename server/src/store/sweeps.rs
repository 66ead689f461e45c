//! Sweeps: insert, read, list.

use protocol::SweepId;
use protocol::api::{Counts, LeftOut, SweepState};
use serde_json::Value;
use sqlx::Row as _;
use sqlx::sqlite::SqliteRow;

use super::{Store, StoreResult, count, events, from_word, idempotency, int, read, small, word};
use crate::clock::Moment;

/// A sweep to be stored.
#[derive(Clone, Debug)]
pub struct NewSweep {
    /// Its id.
    pub id: SweepId,
    /// Its name.
    pub name: String,
    /// The engine.
    pub model: String,
    /// As submitted.
    pub definition: Value,
    /// Larger goes first.
    pub priority: i64,
    /// Points after `where`.
    pub points: u64,
    /// Places in the sweep's order.
    pub candidates: u64,
    /// What `where` left out.
    pub left_out: Vec<LeftOut>,
    /// Key and fingerprint of an idempotent request.
    pub idempotency: Option<(String, String)>,
}

/// A stored sweep.
#[derive(Clone, Debug)]
pub struct SweepRow {
    /// Its number in the database; cursor of the list.
    pub seq: i64,
    /// Its id.
    pub id: SweepId,
    /// Its name.
    pub name: String,
    /// The engine.
    pub model: String,
    /// As submitted.
    pub definition: Value,
    /// Larger goes first.
    pub priority: i64,
    /// State.
    pub state: SweepState,
    /// Points after `where`.
    pub points: u64,
    /// Points turned into jobs.
    pub expanded: u64,
    /// What `where` left out.
    pub left_out: Vec<LeftOut>,
    /// Points whose result was there already.
    pub reused: u64,
    /// Points by job state.
    pub counts: Counts,
    /// Cost of the expanded points [core-seconds].
    pub cost: f64,
    /// Cost of those that are done.
    pub cost_done: f64,
    /// Cost of those set aside or cancelled.
    pub cost_given_up: f64,
    /// Cost of the runs made for it …
    pub timed_cost: f64,
    /// … and the wall seconds they took.
    pub timed_wall: f64,
    /// When it was submitted.
    pub submitted_at: Moment,
    /// When it came to its end.
    pub finished_at: Option<Moment>,
}

/// The running jobs of a sweep in sum, for progress and ETA.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunningWork {
    /// How many.
    pub jobs: u32,
    /// Cost of the points they serve, each times its share done [core-seconds].
    pub done: f64,
    /// Cost of the jobs, each times its share done [core-seconds].
    pub timed_cost: f64,
    /// Wall seconds of their attempts.
    pub timed_wall: f64,
    /// Largest remaining cost of one job [core-seconds].
    pub longest_left: f64,
}

impl SweepRow {
    pub(super) fn of(row: &SqliteRow) -> StoreResult<Self> {
        let left_out: String = row.try_get("left_out")?;
        let definition: String = row.try_get("definition")?;
        Ok(Self {
            seq: row.try_get("seq")?,
            id: read("sweeps.id", row.try_get::<String, _>("id")?.parse())?,
            name: row.try_get("name")?,
            model: row.try_get("model")?,
            definition: read("sweeps.definition", serde_json::from_str(&definition))?,
            priority: row.try_get("priority")?,
            state: from_word("sweeps.state", row.try_get("state")?)?,
            points: count(row.try_get("points")?),
            expanded: count(row.try_get("expanded")?),
            left_out: read("sweeps.left_out", serde_json::from_str(&left_out))?,
            reused: count(row.try_get("reused")?),
            counts: Counts {
                queued: count(row.try_get("queued")?),
                leased: count(row.try_get("leased")?),
                done: count(row.try_get("done")?),
                failed: count(row.try_get("failed")?),
                cancelled: count(row.try_get("cancelled")?),
            },
            cost: row.try_get("cost")?,
            cost_done: row.try_get("cost_done")?,
            cost_given_up: row.try_get("cost_given_up")?,
            timed_cost: row.try_get("timed_cost")?,
            timed_wall: row.try_get("timed_wall")?,
            submitted_at: Moment(row.try_get("submitted_at")?),
            finished_at: row.try_get::<Option<i64>, _>("finished_at")?.map(Moment),
        })
    }
}

impl Store {
    /// Stores a sweep in state `expanding`. With an idempotency key that is known already, nothing is stored and
    /// the earlier request's fate is told.
    ///
    /// # Errors
    /// When the database refuses; nothing is stored then.
    pub async fn insert_sweep(&self, sweep: &NewSweep, now: Moment) -> StoreResult<idempotency::Replay> {
        let mut tx = self.begin().await?;
        if let Some((key, fingerprint)) = &sweep.idempotency
            && let Some(replay) = idempotency::find(&mut tx, key, fingerprint).await?
        {
            return Ok(replay);
        }
        let seq: i64 = sqlx::query_scalar(
            "insert into sweeps (id, name, model, definition, priority, state, points, candidates, left_out,
                 submitted_at)
             values (?1, ?2, ?3, ?4, ?5, 'expanding', ?6, ?7, ?8, ?9) returning seq",
        )
        .bind(sweep.id.to_string())
        .bind(&sweep.name)
        .bind(&sweep.model)
        .bind(sweep.definition.to_string())
        .bind(sweep.priority)
        .bind(int(sweep.points))
        .bind(int(sweep.candidates))
        .bind(read("left_out", serde_json::to_string(&sweep.left_out))?)
        .bind(now.0)
        .fetch_one(&mut *tx)
        .await?;
        if let Some((key, fingerprint)) = &sweep.idempotency {
            idempotency::remember(&mut tx, key, fingerprint, seq, now).await?;
        }
        let data = serde_json::json!({ "name": sweep.name, "points": sweep.points });
        events::append(&mut tx, now, "sweep_submitted", Some(sweep.id), None, &data).await?;
        tx.commit().await?;
        Ok(idempotency::Replay::Fresh)
    }

    /// A sweep by id.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn sweep(&self, id: SweepId) -> StoreResult<Option<SweepRow>> {
        let row = sqlx::query("select * from sweeps where id = ?1")
            .bind(id.to_string())
            .fetch_optional(&self.reader)
            .await?;
        row.as_ref().map(SweepRow::of).transpose()
    }

    /// Sweeps older than `before`, newest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn sweeps(
        &self,
        state: Option<SweepState>,
        before: Option<i64>,
        limit: u32,
    ) -> StoreResult<Vec<SweepRow>> {
        let rows = sqlx::query(
            "select * from sweeps where seq < ?1 and (?2 is null or state = ?2) order by seq desc limit ?3",
        )
        .bind(before.unwrap_or(i64::MAX))
        .bind(state.map(word))
        .bind(limit)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(SweepRow::of).collect()
    }

    /// Sweeps that are not over, newest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn open_sweeps(&self, limit: u32) -> StoreResult<Vec<SweepRow>> {
        let rows = sqlx::query(
            "select * from sweeps where state in ('expanding', 'running', 'paused') order by seq desc limit ?1",
        )
        .bind(limit)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(SweepRow::of).collect()
    }

    /// The running jobs of a sweep: as many as there are slots, never as many as there are points.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn running_work(&self, sweep: i64) -> StoreResult<RunningWork> {
        // `cross join` fixes the order: walk the few leased jobs, not the many of the sweep. Summed here: a row for
        // each of some thousand slots would take longer to hand over than to add.
        let row = sqlx::query(
            "select count(*) jobs, total(j.cost * a.fraction * w.points) done, total(j.cost * a.fraction) timed_cost,
                    total(a.wall_s) timed_wall, coalesce(max(j.cost * (1.0 - a.fraction)), 0.0) longest_left
             from jobs j indexed by jobs_leased
             cross join wants w on w.job = j.seq and w.sweep = ?1
             cross join attempts a on a.job = j.seq and a.attempt = j.attempt
             where j.state = 'leased'",
        )
        .bind(sweep)
        .fetch_one(&self.reader)
        .await?;
        Ok(RunningWork {
            jobs: small(row.try_get("jobs")?),
            done: row.try_get("done")?,
            timed_cost: row.try_get("timed_cost")?,
            timed_wall: row.try_get("timed_wall")?,
            longest_left: row.try_get("longest_left")?,
        })
    }
}
