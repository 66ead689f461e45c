//! Events of `GET /v1/events`.

use serde::{Deserialize, Serialize};

use crate::{JobId, SweepId};

/// Something that happened. Sent as a server-sent event: `id` is its number, `event` its kind, `data` this object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Event {
    /// Grows by at least one with every event; absent for `progress`, which is not kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<i64>,
    /// When (RFC 3339).
    pub at: String,
    /// `sweep_submitted`, `sweep_state`, `job_done`, `job_failed`, `job_set_aside`, `job_lost`, `job_released`,
    /// `determinism_alarm`, or `progress`.
    pub kind: String,
    /// The sweep concerned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sweep: Option<SweepId>,
    /// The job concerned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub job: Option<JobId>,
    /// Details.
    #[cfg_attr(feature = "openapi", schema(value_type = Object))]
    pub data: serde_json::Value,
}
