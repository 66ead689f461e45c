//! The expansion reconciler: points become jobs, chunk by chunk, so that claims get their turn in between.

use protocol::JobId;
use scene::Sweep;
use scene::sweep::Candidate;

use super::App;
use super::submit::{invalid, new_uuid};
use crate::clock::Moment;
use crate::error::{AppError, AppResult, blocking};
use crate::store::{ExpandedPoint, Expanding};

/// Places of a sweep's order per transaction: some tens of milliseconds.
const CHUNK: u64 = 500;

impl App {
    /// Expands every sweep that is not fully expanded. Idempotent; may run beside itself. One that cannot go on
    /// (the database refuses, or a newer version does not take its definition any more) does not stop the others;
    /// what was expanded of it stays, the rest is tried again at the next call.
    ///
    /// # Errors
    /// When the list of sweeps cannot be read.
    pub async fn expand_all(&self) -> AppResult<()> {
        for sweep in self.store().expanding().await? {
            let id = sweep.id;
            if let Err(error) = self.expand_one(sweep).await {
                tracing::error!(sweep = %id, %error, "expansion stopped; it is tried again");
            }
        }
        Ok(())
    }

    async fn expand_one(&self, expanding: Expanding) -> AppResult<()> {
        let definition = expanding.definition.clone();
        let mut sweep =
            blocking(move || Sweep::from_json(&definition).map_err(|problems| invalid(&problems))).await?;
        let mut scanned = expanding.scanned;
        while scanned < expanding.candidates {
            let end = (scanned + CHUNK).min(expanding.candidates);
            let now = self.now();
            let points;
            (sweep, points) = blocking(move || {
                let points = points_of(&sweep, scanned..end, now)?;
                Ok((sweep, points))
            })
            .await?;
            match self.store().expand(expanding.seq, scanned..end, &points, now).await? {
                // Cancelled meanwhile.
                None => break,
                Some(reached) => scanned = reached,
            }
            self.note_work();
            self.note_events();
        }
        Ok(())
    }
}

fn points_of(sweep: &Sweep, places: std::ops::Range<u64>, now: Moment) -> AppResult<Vec<ExpandedPoint>> {
    let mut points = Vec::new();
    for place in places {
        match sweep.candidate(place) {
            Candidate::LeftOut { .. } => {}
            Candidate::Broken { problems, .. } => return Err(invalid(&problems)),
            Candidate::Runs(point) => {
                let reduced = point.scene.reduce();
                let text = |value: &serde_json::Value| {
                    serde_json::to_string(value).map_err(|error| AppError::Bug(error.to_string()))
                };
                points.push(ExpandedPoint {
                    point: point.index,
                    key: reduced.key().as_str().to_owned(),
                    job: JobId(new_uuid(now)),
                    model: reduced.model().name().to_owned(),
                    physics_version: reduced.model().physics_version(),
                    reduced: text(&reduced.to_json())?,
                    scene: text(&point.scene.to_json())?,
                    cost: scene::cost(&reduced).seconds,
                });
            }
        }
    }
    Ok(points)
}
