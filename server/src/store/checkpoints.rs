//! Checkpoints: the newest of each job; the bytes are blobs.

use protocol::{Checkpoint, JobId, WorkerId};
use sqlx::{Row as _, Sqlite, Transaction};

use super::leases::lock;
use super::{LeaseWrite, Store, StoreResult, int};
use crate::clock::Moment;
use crate::scheduler::lifecycle::{Happening, Limits};

/// A checkpoint whose bytes are stored already.
#[derive(Clone, Debug, PartialEq)]
pub struct NewCheckpoint {
    /// The job.
    pub job: JobId,
    /// Who runs it.
    pub worker: WorkerId,
    /// Under which attempt.
    pub attempt: u32,
    /// Hash, steps and size.
    pub checkpoint: Checkpoint,
    /// The lease holds until then: a checkpoint is a sign of life.
    pub lease_until: Moment,
}

/// What became of a checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckpointHeld {
    /// It is the newest.
    Newest,
    /// A newer one is there already; this one is let go.
    Older(Checkpoint),
    /// The writer does not hold the job.
    Not(LeaseWrite),
}

/// Notes that a blob may be unused from now on.
pub(super) async fn drop_blob(tx: &mut Transaction<'_, Sqlite>, hash: &str, now: Moment) -> StoreResult<()> {
    sqlx::query(
        "insert into dropped_blobs (hash, since) values (?1, ?2) on conflict do update set since = excluded.since",
    )
    .bind(hash)
    .bind(now.0)
    .execute(&mut **tx)
    .await?;
    Ok(())
}

impl Store {
    /// Makes a stored blob the newest checkpoint of its job; otherwise the blob is noted as unused.
    ///
    /// # Errors
    /// When the database refuses; nothing is stored then.
    pub async fn checkpoint(
        &self,
        new: &NewCheckpoint,
        limits: Limits,
        now: Moment,
    ) -> StoreResult<CheckpointHeld> {
        let mut tx = self.begin().await?;
        let Some(held) = lock(&mut tx, new.job).await? else {
            drop_blob(&mut tx, &new.checkpoint.hash, now).await?;
            tx.commit().await?;
            return Ok(CheckpointHeld::Not(LeaseWrite::NoJob));
        };
        let refused = match held.job.after(Happening::Checkpoint(new.attempt), limits) {
            Err(refused) => Some(LeaseWrite::Refused(refused)),
            Ok(_) if held.worker != Some(new.worker) => Some(LeaseWrite::OtherWorker),
            Ok(_) => None,
        };
        if let Some(refused) = refused {
            drop_blob(&mut tx, &new.checkpoint.hash, now).await?;
            tx.commit().await?;
            return Ok(CheckpointHeld::Not(refused));
        }
        if let (Some(hash), Some(steps)) = (&held.checkpoint_hash, held.checkpoint_steps) {
            if steps > new.checkpoint.steps {
                drop_blob(&mut tx, &new.checkpoint.hash, now).await?;
                tx.commit().await?;
                let newest = Checkpoint { hash: hash.clone(), steps, bytes: 0 };
                return Ok(CheckpointHeld::Older(newest));
            }
            if *hash != new.checkpoint.hash {
                drop_blob(&mut tx, hash, now).await?;
            }
        }
        let progress = held.checkpoint_steps.is_none_or(|steps| new.checkpoint.steps > steps);
        sqlx::query(
            "update jobs set checkpoint_hash = ?2, checkpoint_steps = ?3, checkpoint_bytes = ?4,
                 lease_until = max(lease_until, ?5), losses_in_a_row = case when ?6 then 0 else losses_in_a_row end
             where seq = ?1",
        )
        .bind(held.seq)
        .bind(&new.checkpoint.hash)
        .bind(int(new.checkpoint.steps))
        .bind(int(new.checkpoint.bytes))
        .bind(new.lease_until.0)
        .bind(progress)
        .execute(&mut *tx)
        .await?;
        sqlx::query("delete from dropped_blobs where hash = ?1")
            .bind(&new.checkpoint.hash)
            .execute(&mut *tx)
            .await?;
        tx.commit().await?;
        Ok(CheckpointHeld::Newest)
    }

    /// Hash of the newest checkpoint for the holder of a lease.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn newest_checkpoint(&self, job: JobId) -> StoreResult<Option<Checkpoint>> {
        let row =
            sqlx::query("select checkpoint_hash, checkpoint_steps, checkpoint_bytes from jobs where id = ?1")
                .bind(job.to_string())
                .fetch_optional(&self.reader)
                .await?;
        row.as_ref().map_or(Ok(None), super::claims::checkpoint_of)
    }

    /// Blobs let go before `before` that no row needs, taken off the list.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn take_unused_blobs(&self, before: Moment) -> StoreResult<Vec<String>> {
        let any: Option<i64> = sqlx::query_scalar("select 1 from dropped_blobs where since < ?1 limit 1")
            .bind(before.0)
            .fetch_optional(&self.reader)
            .await?;
        if any.is_none() {
            return Ok(Vec::new());
        }
        let mut tx = self.begin().await?;
        let rows = sqlx::query(
            "delete from dropped_blobs where hash in (select hash from dropped_blobs where since < ?1 limit 500)
             returning hash, exists (select 1 from jobs where checkpoint_hash = hash)
                 or exists (select 1 from results where outcome = hash)
                 or exists (select 1 from results where states = hash) needed",
        )
        .bind(before.0)
        .fetch_all(&mut *tx)
        .await?;
        tx.commit().await?;
        let mut unused = Vec::new();
        for row in &rows {
            if !row.try_get::<bool, _>("needed")? {
                unused.push(row.try_get("hash")?);
            }
        }
        Ok(unused)
    }
}
