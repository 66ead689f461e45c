//! Points of a sweep, and why a run is or is not taken from the store.

use serde::{Deserialize, Serialize};

use crate::{JobId, JobState, SweepId};

/// One point of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct PointView {
    /// Its place in the sweep, from 0.
    pub point: u64,
    /// The job that serves it.
    pub job: JobId,
    /// State of that job.
    pub state: JobState,
    /// Identity of the run.
    pub scene_key: String,
    /// The scene in SI units.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub scene: serde_json::Value,
}

/// What a submission of this scene would meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub enum Verdict {
    /// The result is stored and would be served at once.
    Hit,
    /// The run waits or is under way; its result would be shared.
    Shared,
    /// The run was set aside after failures; a retry has to be asked for.
    SetAside,
    /// It would be queued again: it was cancelled before it was finished.
    Requeued,
    /// Nothing is known: it would be run.
    Miss,
}

/// `GET /v1/points/{key}/explain`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Explanation {
    /// The scene key asked for.
    pub scene_key: String,
    /// What a submission would meet.
    pub verdict: Verdict,
    /// The same in words, with the reason.
    pub explanation: String,
    /// The job of this key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub job: Option<JobId>,
    /// State of the job.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<JobState>,
    /// The reduced scene that was hashed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "openapi", schema(value_type = Option<Object>))]
    pub reduced: Option<serde_json::Value>,
    /// The physics version that was hashed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub physics_version: Option<u32>,
    /// Sweeps that want this run (at most 100).
    pub sweeps: Vec<SweepId>,
}
