//! Why a run is, or is not, taken from the store.

use protocol::JobState;
use protocol::api::{Explanation, Verdict};
use scene::SceneKey;

use super::App;
use crate::error::{AppError, AppResult};

impl App {
    /// Explains what a submission of the scene with this key would meet.
    ///
    /// # Errors
    /// [`AppError::Invalid`] when the text is no scene key.
    pub async fn explain(&self, key: &str) -> AppResult<Explanation> {
        let key: SceneKey = key.parse().map_err(|_| {
            let remedy = "give the 32 hex digits that `tamp explain` or a job shows";
            AppError::field("query", "key", format!("{key:?}"), "is not a scene key", remedy)
        })?;
        let Some(job) = self.store().job_of_key(key.as_str()).await? else {
            return Ok(Explanation {
                scene_key: key.as_str().to_owned(),
                verdict: Verdict::Miss,
                explanation: "no run of this key was ever asked for: the key is the hash of the reduced scene \
                              (seed and numerics included) and the physics version; compare the reduced scene \
                              with that of a run you expected to match (GET /v1/jobs/{id})"
                    .to_owned(),
                job: None,
                state: None,
                reduced: None,
                physics_version: None,
                sweeps: Vec::new(),
            });
        };
        let (verdict, explanation) = match job.state {
            JobState::Done => (
                Verdict::Hit,
                format!("the run is done since attempt {}; its result is served at once", job.attempt),
            ),
            JobState::Queued => {
                (Verdict::Shared, "the run waits for a worker; its result will be shared".to_owned())
            }
            JobState::Leased => (
                Verdict::Shared,
                format!("the run is under way, attempt {}; its result will be shared", job.attempt),
            ),
            JobState::Failed => (
                Verdict::SetAside,
                format!(
                    "the run was set aside after {} failures and {} lost workers; POST /v1/sweeps/{{id}}/retry \
                     queues it again",
                    job.failures, job.losses
                ),
            ),
            JobState::Cancelled => (
                Verdict::Requeued,
                "the run was cancelled before it was done; a submission queues it again".to_owned(),
            ),
        };
        Ok(Explanation {
            scene_key: key.as_str().to_owned(),
            verdict,
            explanation,
            job: Some(job.id),
            state: Some(job.state),
            reduced: Some(job.reduced),
            physics_version: Some(job.physics_version),
            sweeps: self.store().sweeps_of_job(job.seq).await?,
        })
    }
}
