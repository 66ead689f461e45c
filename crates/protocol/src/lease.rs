//! The worker protocol: register, claim, heartbeat, checkpoint, finish.
//!
//! Every write by a worker carries (job, attempt) and is refused with 409 when the attempt is no longer current.
//! A lease is addressed by its job id: `/v1/leases/{job}`.

use record::{Outcome, Row};
use serde::{Deserialize, Serialize};

use crate::{JobId, WorkerId};

/// `POST /v1/workers`: a worker process introduces itself. Host and boot together are its identity: the same pair
/// gets the same id again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Registration {
    /// Protocol version of the worker.
    pub protocol: u32,
    /// Host name or another stable name of the machine.
    pub host: String,
    /// Drawn once per process start.
    pub boot: uuid::Uuid,
    /// Jobs run at the same time.
    pub slots: u32,
    /// Hardware class: results of one class must agree bit for bit, for example `x86_64-avx2`.
    pub hardware: String,
    /// Version of the worker's code.
    pub code_version: String,
    /// Models this worker runs, with their physics versions.
    pub models: Vec<(String, u32)>,
}

/// Answer to a registration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Registered {
    /// The worker's id.
    pub worker: WorkerId,
    /// A lease not renewed for this long returns to the queue [s].
    pub lease_seconds: f64,
    /// Ask for heartbeats this often [s].
    pub heartbeat_seconds: f64,
    /// Largest checkpoint the coordinator takes [bytes].
    pub max_checkpoint_bytes: u64,
}

/// `POST /v1/claims`: ask for up to `slots` jobs. The coordinator holds the request up to `wait_seconds` while there
/// is none. Jobs already leased to this worker but missing in `holding` are granted again first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ClaimRequest {
    /// Who asks.
    pub worker: WorkerId,
    /// Free slots.
    pub slots: u32,
    /// Jobs this worker is running now.
    #[serde(default)]
    pub holding: Vec<JobId>,
    /// Long poll: wait this long for work [s].
    #[serde(default)]
    pub wait_seconds: f64,
}

/// Answer to a claim: granted jobs, possibly none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ClaimResponse {
    /// Granted jobs.
    pub grants: Vec<Grant>,
    /// Ask again after this long when there were none [s].
    pub retry_seconds: f64,
}

/// One leased job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Grant {
    /// The job.
    pub job: JobId,
    /// Grows with every execution; every later message carries it.
    pub attempt: u32,
    /// Reduced scene, as JSON (`scene::Reduced`).
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub reduced: serde_json::Value,
    /// Its scene key, to be checked by the worker.
    pub scene_key: String,
    /// Newest checkpoint, if any: get it from `GET /v1/leases/{job}/checkpoint?worker=…&attempt=…`.
    pub checkpoint: Option<Checkpoint>,
}

/// A stored checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Checkpoint {
    /// BLAKE3 hash of the bytes, hex.
    pub hash: String,
    /// Steps done at the checkpoint.
    pub steps: u64,
    /// Size [bytes].
    pub bytes: u64,
}

/// `PUT /v1/leases/{job}/checkpoint?worker=…&attempt=…&steps=…`: the body is the checkpoint, as raw bytes. The same
/// query without `steps` reads the newest one back with GET.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "openapi", derive(utoipa::IntoParams))]
pub struct CheckpointQuery {
    /// Who runs the job.
    pub worker: WorkerId,
    /// Under which attempt.
    pub attempt: u32,
    /// Steps done at the checkpoint (PUT only).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
}

/// `PUT /v1/leases/{job}`: the job is alive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Heartbeat {
    /// Who runs it.
    pub worker: WorkerId,
    /// Under which attempt.
    pub attempt: u32,
    /// Steps done.
    pub steps: u64,
    /// Expected steps of the whole run.
    pub expected_steps: u64,
    /// Share of the work done, 0 … 1.
    pub fraction: f64,
    /// Wall seconds spent on the job in this attempt.
    pub wall_s: f64,
    /// Live numbers (`e`, `z`, …).
    #[serde(default)]
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub live: Row,
}

/// What the worker should do with the job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub enum Directive {
    /// Go on.
    Continue,
    /// Make a checkpoint, upload it, release the lease.
    Yield,
    /// Stop at once and forget the job: nobody wants it.
    Drop,
}

/// Answer to a result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Accepted {
    /// The job.
    pub job: JobId,
    /// BLAKE3 digest of the outcome.
    pub digest: String,
    /// Whether this very result was stored before.
    pub duplicate: bool,
}

/// Answer to a failure or a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Returned {
    /// The job.
    pub job: JobId,
    /// Its state now: queued for another try, or set aside.
    pub state: crate::JobState,
}

/// Answer to a heartbeat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct HeartbeatReply {
    /// What to do.
    pub directive: Directive,
    /// The lease now holds for this long [s].
    pub lease_seconds: f64,
}

/// `POST /v1/leases/{job}/result`: the run is finished. The same bytes twice are one row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Completion {
    /// Who ran it.
    pub worker: WorkerId,
    /// Under which attempt.
    pub attempt: u32,
    /// Scene key, as granted.
    pub scene_key: String,
    /// The physics' result: identical bytes for identical scenes.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub outcome: Outcome,
    /// What belongs to this execution alone: `wall_s`, `ns_per_particle_step`, `kernel`, `code_version`, `host`, … .
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub execution: Row,
}

/// Why a run failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub enum FailureKind {
    /// Another try may succeed (damaged checkpoint, full disk, panic).
    Retryable,
    /// It will fail everywhere (unstable scene, illegal combination).
    Permanent,
}

/// `POST /v1/leases/{job}/failure`: the run failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Failure {
    /// Who ran it.
    pub worker: WorkerId,
    /// Under which attempt.
    pub attempt: u32,
    /// Whether another try may help.
    pub kind: FailureKind,
    /// Stable class, for example `unstable`, `not_converged`, `panic`.
    pub class: String,
    /// Evidence for a person.
    pub message: String,
}

/// `POST /v1/leases/{job}/release`: the worker gives the job back unharmed (drain, shutdown). Counts neither as a
/// failure nor as a loss.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Release {
    /// Who ran it.
    pub worker: WorkerId,
    /// Under which attempt.
    pub attempt: u32,
    /// Why, for a person.
    pub reason: String,
}
