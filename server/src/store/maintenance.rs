//! What keeps the database well, and what the metrics read.

use protocol::api::Counts;
use sqlx::Row as _;

use super::{Store, StoreResult, count};
use crate::clock::Moment;

/// Numbers for the metrics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Jobs by state.
    pub jobs: Counts,
    /// Sweeps that are not over.
    pub open_sweeps: u64,
    /// Results that contradict another one.
    pub alarms: u64,
}

/// Whether reads and writes work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Health {
    /// The database answers a read.
    pub reads: bool,
    /// The writer connection begins a transaction.
    pub writes: bool,
}

impl Store {
    /// Numbers for the metrics; each is kept, none is counted over all jobs.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn totals(&self) -> StoreResult<Totals> {
        let row = sqlx::query(
            "select t.*, (select count(*) from sweeps where state in ('expanding', 'running', 'paused')) open_sweeps,
                    (select count(*) from results where alarm = 1) alarms
             from totals t",
        )
        .fetch_one(&self.reader)
        .await?;
        Ok(Totals {
            jobs: Counts {
                queued: count(row.try_get("queued")?),
                leased: count(row.try_get("leased")?),
                done: count(row.try_get("done")?),
                failed: count(row.try_get("failed")?),
                cancelled: count(row.try_get("cancelled")?),
            },
            open_sweeps: count(row.try_get("open_sweeps")?),
            alarms: count(row.try_get("alarms")?),
        })
    }

    /// Whether reads and writes work now.
    pub async fn health(&self) -> Health {
        let reads = sqlx::query("select 1 from totals").fetch_one(&self.reader).await.is_ok();
        let writes = match self.begin().await {
            Ok(tx) => tx.rollback().await.is_ok(),
            Err(_) => false,
        };
        Health { reads, writes }
    }

    /// Drops idempotency keys older than `before`.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn forget_requests(&self, before: Moment) -> StoreResult<u64> {
        let done = sqlx::query("delete from idempotency where stored_at < ?1")
            .bind(before.0)
            .execute(&self.writer)
            .await?;
        Ok(done.rows_affected())
    }

    /// Recomputes every kept count from the rows and returns what does not agree: nothing, if the service is right.
    /// Walks all points; for tests and for a person with a doubt.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn audit(&self) -> StoreResult<Vec<String>> {
        let rows = sqlx::query(
            "with truth as (
                 select p.sweep, count(*) n, sum(j.state = 'queued') queued, sum(j.state = 'leased') leased,
                        sum(j.state = 'done') done, sum(j.state = 'failed') failed,
                        sum(j.state = 'cancelled') cancelled
                 from points p join jobs j on j.seq = p.job group by p.sweep)
             select 'counts of sweep ' || s.id fault from sweeps s left join truth t on t.sweep = s.seq
             where s.expanded <> coalesce(t.n, 0) or s.queued <> coalesce(t.queued, 0)
                or s.leased <> coalesce(t.leased, 0) or s.done <> coalesce(t.done, 0)
                or s.failed <> coalesce(t.failed, 0) or s.cancelled <> coalesce(t.cancelled, 0)
             union all
             select 'wanted of job ' || j.id from jobs j
             where j.wanted <> (select count(*) from wants w join sweeps s on s.seq = w.sweep
                                where w.job = j.seq and s.state <> 'cancelled')
                or j.runnable <> (select count(*) from wants w join sweeps s on s.seq = w.sweep
                                  where w.job = j.seq and s.state not in ('cancelled', 'paused'))
             union all
             select 'job ' || j.id || ' is ' || j.state || ' and unwanted' from jobs j
             where j.wanted = 0 and j.state in ('queued', 'leased')
             union all
             select 'job ' || j.id || ' is done without a result' from jobs j
             where (j.state = 'done') <> (j.result is not null)
             union all
             select 'totals' from totals t
             where t.queued <> (select count(*) from jobs where state = 'queued')
                or t.leased <> (select count(*) from jobs where state = 'leased')
                or t.done <> (select count(*) from jobs where state = 'done')
                or t.failed <> (select count(*) from jobs where state = 'failed')
                or t.cancelled <> (select count(*) from jobs where state = 'cancelled')",
        )
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(|row| Ok(row.try_get("fault")?)).collect()
    }
}
