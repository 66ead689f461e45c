//! One run: scene, attempts, record.

use record::Row;
use serde::{Deserialize, Serialize};

use crate::{Checkpoint, JobId, JobState, SweepId, WorkerId};

/// A job as `GET /v1/jobs/{id}` shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct JobView {
    /// Its id.
    pub id: JobId,
    /// Identity of the run: hash of the reduced scene and the physics version.
    pub scene_key: String,
    /// The engine.
    pub model: String,
    /// Version of the physics.
    pub physics_version: u32,
    /// State.
    pub state: JobState,
    /// Priority: the largest of the sweeps that want it.
    pub priority: i64,
    /// Estimated work [core-seconds on the reference machine].
    pub cost_core_seconds: f64,
    /// Number of the newest attempt; 0 before the first.
    pub attempt: u32,
    /// Attempts that ended by the program's fault.
    pub failures: u32,
    /// Attempts whose worker was lost.
    pub losses: u32,
    /// The reduced scene.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub reduced: serde_json::Value,
    /// The scene in SI units, as the first sweep that wanted it wrote it.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub scene: serde_json::Value,
    /// Sweeps that want it (at most 100 are listed).
    pub sweeps: Vec<SweepId>,
    /// Newest checkpoint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checkpoint: Option<Checkpoint>,
    /// Every attempt, oldest first (at most 100, the newest ones).
    pub attempts: Vec<AttemptView>,
    /// The accepted result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result: Option<ResultView>,
    /// Results that differ from the accepted one or came too late; kept as evidence.
    pub other_results: Vec<ResultView>,
}

/// How an attempt ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub enum AttemptEnd {
    /// Its result was accepted.
    Done,
    /// The program failed.
    Failed,
    /// The lease expired.
    Lost,
    /// The worker gave the job back.
    Released,
    /// Nobody wanted the job any more.
    Cancelled,
}

/// One execution of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct AttemptView {
    /// Its number.
    pub attempt: u32,
    /// Who ran it.
    pub worker: WorkerId,
    /// On which machine.
    pub host: String,
    /// Start (RFC 3339).
    pub started_at: String,
    /// End (RFC 3339); absent while it runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ended_at: Option<String>,
    /// How it ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<AttemptEnd>,
    /// Class of a failure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class: Option<String>,
    /// Evidence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Steps done at the last sign of life.
    pub steps: u64,
    /// Expected steps of the whole run.
    pub expected_steps: u64,
    /// Share of the work done, 0 … 1.
    pub fraction: f64,
    /// Wall seconds spent.
    pub wall_s: f64,
    /// Live numbers.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub live: Row,
}

/// A stored result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ResultView {
    /// BLAKE3 digest of the outcome: equal for equal results.
    pub digest: String,
    /// Attempt that made it.
    pub attempt: u32,
    /// Hardware class it was made on.
    pub hardware: String,
    /// Whether it differs from another result of the same hardware class: a determinism fault.
    pub alarm: bool,
    /// When it arrived (RFC 3339).
    pub stored_at: String,
    /// The physics' record.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub record: Row,
    /// Facts of this execution alone.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub execution: Row,
}
