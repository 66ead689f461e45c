//! Worker processes.

use protocol::{Registration, WorkerId};
use sqlx::Row as _;
use sqlx::sqlite::SqliteRow;

use super::{Store, StoreResult, read, small};
use crate::clock::Moment;

/// A registered worker.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkerRow {
    /// Its number in the database; cursor of the list.
    pub seq: i64,
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
    /// Models with physics versions.
    pub models: Vec<(String, u32)>,
    /// Leases it holds.
    pub leases: u32,
    /// When it registered first.
    pub registered_at: Moment,
    /// Last sign of life.
    pub seen_at: Moment,
}

impl WorkerRow {
    fn of(row: &SqliteRow) -> StoreResult<Self> {
        let models: String = row.try_get("models")?;
        Ok(Self {
            seq: row.try_get("seq")?,
            id: read("workers.id", row.try_get::<String, _>("id")?.parse())?,
            host: row.try_get("host")?,
            slots: small(row.try_get("slots")?),
            hardware: row.try_get("hardware")?,
            code_version: row.try_get("code_version")?,
            models: read("workers.models", serde_json::from_str(&models))?,
            leases: small(row.try_get("leases")?),
            registered_at: Moment(row.try_get("registered_at")?),
            seen_at: Moment(row.try_get("seen_at")?),
        })
    }
}

impl Store {
    /// Registers a worker; the same host and boot get the same id again.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn register(&self, id: WorkerId, new: &Registration, now: Moment) -> StoreResult<WorkerId> {
        let known: String = sqlx::query_scalar(
            "insert into workers (id, host, boot, slots, hardware, code_version, models, registered_at, seen_at)
             values (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?8)
             on conflict (host, boot) do update set slots = excluded.slots, hardware = excluded.hardware,
                 code_version = excluded.code_version, models = excluded.models, seen_at = excluded.seen_at
             returning id",
        )
        .bind(id.to_string())
        .bind(&new.host)
        .bind(new.boot.to_string())
        .bind(new.slots)
        .bind(&new.hardware)
        .bind(&new.code_version)
        .bind(read("models", serde_json::to_string(&new.models))?)
        .bind(now.0)
        .fetch_one(&self.writer)
        .await?;
        read("workers.id", known.parse())
    }

    /// A worker by id.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn worker(&self, id: WorkerId) -> StoreResult<Option<WorkerRow>> {
        let row = sqlx::query(
            "select w.*, (select count(*) from jobs where worker = w.seq and state = 'leased') leases
             from workers w where id = ?1",
        )
        .bind(id.to_string())
        .fetch_optional(&self.reader)
        .await?;
        row.as_ref().map(WorkerRow::of).transpose()
    }

    /// Workers older than `before`, newest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn workers(&self, before: Option<i64>, limit: u32) -> StoreResult<Vec<WorkerRow>> {
        let rows = sqlx::query(
            "select w.*, (select count(*) from jobs where worker = w.seq and state = 'leased') leases
             from workers w where seq < ?1 order by seq desc limit ?2",
        )
        .bind(before.unwrap_or(i64::MAX))
        .bind(limit)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(WorkerRow::of).collect()
    }

    /// Workers seen since `since`.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn workers_alive(&self, since: Moment) -> StoreResult<u64> {
        let alive: i64 = sqlx::query_scalar("select count(*) from workers where seen_at >= ?1")
            .bind(since.0)
            .fetch_one(&self.reader)
            .await?;
        Ok(super::count(alive))
    }
}
