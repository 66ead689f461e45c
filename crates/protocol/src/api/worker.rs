//! Workers as the coordinator sees them.

use serde::{Deserialize, Serialize};

use crate::WorkerId;

/// A worker process.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct WorkerView {
    /// Its id.
    pub id: WorkerId,
    /// Its machine.
    pub host: String,
    /// Jobs it runs at the same time.
    pub slots: u32,
    /// Hardware class.
    pub hardware: String,
    /// Version of its code.
    pub code_version: String,
    /// Models it runs, with their physics versions.
    pub models: Vec<(String, u32)>,
    /// Leases it holds.
    pub leases: u32,
    /// When it registered first (RFC 3339).
    pub registered_at: String,
    /// Last sign of life (RFC 3339).
    pub seen_at: String,
}
