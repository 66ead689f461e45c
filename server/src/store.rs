//! The store: all SQL is in this module and below, behind methods that know no SQL.
//!
//! SQLite in WAL mode, `synchronous=FULL`, one writer connection whose transactions all begin immediate (a deferred
//! one that reads first fails at once when somebody else writes), and a read-only pool beside it. No transaction
//! waits for anything but the database. An answer that says "stored" is given after the commit.

mod checkpoints;
mod claims;
mod control;
mod events;
mod expand;
mod idempotency;
mod jobs;
mod leases;
mod maintenance;
mod open;
mod points;
mod results;
mod settle;
mod sweeps;
mod workers;

use sqlx::sqlite::SqlitePool;
use sqlx::{Sqlite, Transaction};

pub use checkpoints::{CheckpointHeld, NewCheckpoint};
pub use claims::{Claim, Granted};
pub use control::{Control, Controlled};
pub use events::StoredEvent;
pub use expand::{ExpandedPoint, Expanding, Known};
pub use idempotency::Replay;
pub use jobs::{AttemptRow, JobRow, ResultRow};
pub use leases::{Beat, HeldLease, LeaseWrite};
pub use maintenance::{Health, Totals};
pub use open::OpenError;
pub use points::PointRow;
pub use results::{NewResult, RunRow, Stored};
pub use sweeps::{NewSweep, RunningWork, SweepRow};
pub use workers::WorkerRow;

/// The database cannot do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The database refused.
    #[error("database: {0}")]
    Sql(#[from] sqlx::Error),
    /// A row does not read as what was once written.
    #[error("database: {what} does not read: {why}")]
    Corrupt {
        /// Which row and column.
        what: String,
        /// Why.
        why: String,
    },
}

/// Result of a store operation.
pub type StoreResult<T> = Result<T, StoreError>;

/// The open database.
#[derive(Clone, Debug)]
pub struct Store {
    writer: SqlitePool,
    reader: SqlitePool,
}

impl Store {
    /// A write transaction; rolled back unless committed.
    async fn begin(&self) -> StoreResult<Transaction<'static, Sqlite>> {
        Ok(self.writer.begin_with("BEGIN IMMEDIATE").await?)
    }
}

/// Reads a stored word, id or JSON text.
fn read<T, E: std::fmt::Display>(what: &str, parsed: Result<T, E>) -> StoreResult<T> {
    parsed.map_err(|why| StoreError::Corrupt { what: what.to_owned(), why: why.to_string() })
}

/// The word of a unit-like enum as serde writes it.
fn word<T: serde::Serialize>(value: T) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(word)) => word,
        other => unreachable!("a state is written as a word, not {other:?}"),
    }
}

/// Reads such a word back.
fn from_word<T: serde::de::DeserializeOwned>(what: &str, word: String) -> StoreResult<T> {
    read(what, serde_json::from_value(serde_json::Value::String(word)))
}

/// A count as SQLite keeps it.
fn int(count: u64) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// A count read back; negative ones cannot be and read as zero.
fn count(value: i64) -> u64 {
    u64::try_from(value).unwrap_or(0)
}

/// A small count read back.
fn small(value: i64) -> u32 {
    u32::try_from(value).unwrap_or(if value < 0 { 0 } else { u32::MAX })
}
