//! Sweeps: submission, status, control.

use serde::{Deserialize, Serialize};

use crate::SweepId;

/// State of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub enum SweepState {
    /// Its points are being turned into jobs; those that are there already run.
    Expanding,
    /// Jobs wait or run.
    Running,
    /// No new job is started on its behalf.
    Paused,
    /// Every point has its result.
    Done,
    /// Over, but at least one point has no result.
    Failed,
    /// Given up by its owner.
    Cancelled,
}

impl SweepState {
    /// The word used on the wire.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Expanding => "expanding",
            Self::Running => "running",
            Self::Paused => "paused",
            Self::Done => "done",
            Self::Failed => "failed",
            Self::Cancelled => "cancelled",
        }
    }

    /// Whether nothing more will happen unless somebody asks for it.
    #[must_use]
    pub fn is_terminal(self) -> bool {
        matches!(self, Self::Done | Self::Failed | Self::Cancelled)
    }
}

/// Points of a sweep by the state of their job.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Counts {
    /// Wait for a worker.
    pub queued: u64,
    /// Run now.
    pub leased: u64,
    /// Have their result.
    pub done: u64,
    /// Set aside with evidence.
    pub failed: u64,
    /// Wanted by no sweep any more.
    pub cancelled: u64,
}

impl Counts {
    /// All points that have been turned into jobs.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.queued + self.leased + self.done + self.failed + self.cancelled
    }
}

/// Points that a `where` clause left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct LeftOut {
    /// The clause, in words.
    pub reason: String,
    /// How many points it left out.
    pub points: u64,
}

/// A sweep as `GET /v1/sweeps/{id}` shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct SweepView {
    /// Its id.
    pub id: SweepId,
    /// Its name, as given.
    pub name: String,
    /// The engine.
    pub model: String,
    /// State.
    pub state: SweepState,
    /// Larger goes first.
    pub priority: i64,
    /// Number of points after `where`.
    pub points: u64,
    /// Points already turned into jobs; equals `points` once `expanding` is over.
    pub expanded: u64,
    /// Points left out by `where`, with reasons.
    pub left_out: Vec<LeftOut>,
    /// Points whose run was already done when the sweep was submitted.
    pub reused: u64,
    /// Points by job state.
    pub counts: Counts,
    /// Share of the estimated work that is done, 0 … 1, running jobs included.
    pub progress: f64,
    /// Estimated time to the end [s]; absent while nothing is known about the speed of the workers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eta_seconds: Option<f64>,
    /// Estimated work of all points [core-seconds on the reference machine].
    pub cost_core_seconds: f64,
    /// When it was submitted (RFC 3339).
    pub submitted_at: String,
    /// When it came to its end (RFC 3339).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finished_at: Option<String>,
    /// The definition, as submitted; absent in lists.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "openapi", schema(value_type = Option<Object>))]
    pub definition: Option<serde_json::Value>,
}

/// What a submission would do (`POST /v1/sweeps?dry_run=true`); nothing is stored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct DryRun {
    /// Always true.
    pub dry_run: bool,
    /// The name given.
    pub name: String,
    /// The engine.
    pub model: String,
    /// Points after `where`.
    pub points: u64,
    /// Points left out by `where`, with reasons.
    pub left_out: Vec<LeftOut>,
    /// Different runs among the points.
    pub distinct: u64,
    /// Points that repeat another point of the same sweep.
    pub duplicates: u64,
    /// Different runs whose result is already stored.
    pub known: u64,
    /// Different runs that wait or run already for another sweep.
    pub shared: u64,
    /// Different runs that would be started.
    pub to_run: u64,
    /// Estimated work of the runs that would be started.
    pub estimate: Estimate,
}

/// An estimate of work, from the cost model of the engine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Estimate {
    /// Work of all runs together [core-seconds on the reference machine].
    pub core_seconds: f64,
    /// Work of the longest run: no number of workers finishes sooner [core-seconds].
    pub longest_core_seconds: f64,
}

/// Answer to cancel, pause, resume and retry.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ControlReply {
    /// The sweep after the change.
    pub sweep: SweepView,
    /// Jobs whose state the request changed.
    pub jobs_changed: u64,
}
