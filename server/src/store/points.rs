//! The points of a sweep.

use protocol::{JobId, JobState};
use serde_json::Value;
use sqlx::Row as _;

use super::{Store, StoreResult, count, from_word, int, read, word};

/// One point.
#[derive(Clone, Debug)]
pub struct PointRow {
    /// Its place in the sweep.
    pub point: u64,
    /// The job that serves it.
    pub job: JobId,
    /// State of that job.
    pub state: JobState,
    /// Identity of the run.
    pub scene_key: String,
    /// SI scene.
    pub scene: Value,
}

impl Store {
    /// Points of a sweep after `after`, in order, those in `state` only when given.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn points(
        &self,
        sweep: i64,
        state: Option<JobState>,
        after: Option<u64>,
        limit: u32,
    ) -> StoreResult<Vec<PointRow>> {
        let rows = sqlx::query(
            "select p.point, p.scene, j.id, j.state, j.scene_key
             from points p cross join jobs j on j.seq = p.job
             where p.sweep = ?1 and p.point > ?2 and (?3 is null or j.state = ?3) order by p.point limit ?4",
        )
        .bind(sweep)
        .bind(after.map_or(-1, int))
        .bind(state.map(word))
        .bind(limit)
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .map(|row| {
                let scene: String = row.try_get("scene")?;
                Ok(PointRow {
                    point: count(row.try_get("point")?),
                    job: read("jobs.id", row.try_get::<String, _>("id")?.parse())?,
                    state: from_word("jobs.state", row.try_get("state")?)?,
                    scene_key: row.try_get("scene_key")?,
                    scene: read("points.scene", serde_json::from_str(&scene))?,
                })
            })
            .collect()
    }
}
