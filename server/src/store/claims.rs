//! Claims: many of them in one transaction, so that one fsync serves all that wait.

use protocol::{Checkpoint, JobId, WorkerId};
use serde_json::Value;
use sqlx::sqlite::SqliteRow;
use sqlx::{Row as _, Sqlite, Transaction};

use super::{Store, StoreResult, count, read, small};
use crate::clock::Moment;

/// One worker asks for jobs.
#[derive(Clone, Debug)]
pub struct Claim {
    /// Who.
    pub worker: WorkerId,
    /// How many at most.
    pub slots: u32,
    /// Jobs it knows it holds.
    pub holding: Vec<JobId>,
}

/// A granted job.
#[derive(Clone, Debug, PartialEq)]
pub struct Granted {
    /// The job.
    pub job: JobId,
    /// Its fencing number.
    pub attempt: u32,
    /// Reduced scene.
    pub reduced: Value,
    /// Scene key.
    pub scene_key: String,
    /// Newest checkpoint.
    pub checkpoint: Option<Checkpoint>,
    /// Estimated cost [core-seconds].
    pub cost: f64,
}

struct Asking {
    seq: i64,
    models: Vec<(String, u32)>,
}

impl Store {
    /// Whether any job could be claimed by a worker of these models. A read; a claim decides.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn claimable(&self, models: &[(String, u32)], now: Moment) -> StoreResult<bool> {
        let mut found = false;
        for (model, version) in models {
            let any: Option<i64> = sqlx::query_scalar(
                "select 1 from jobs indexed by jobs_claimable
                 where model = ?1 and physics_version = ?2 and state = 'queued' and runnable > 0
                   and not_before <= ?3 limit 1",
            )
            .bind(model)
            .bind(version)
            .bind(now.0)
            .fetch_optional(&self.reader)
            .await?;
            found |= any.is_some();
        }
        Ok(found)
    }

    /// Serves claims in their order, all in one transaction. `None` for a worker that is not registered.
    ///
    /// # Errors
    /// When the database refuses; nothing is leased then.
    pub async fn claim(
        &self,
        claims: &[Claim],
        now: Moment,
        lease_until: Moment,
    ) -> StoreResult<Vec<Option<Vec<Granted>>>> {
        let mut tx = self.begin().await?;
        let mut answers = Vec::with_capacity(claims.len());
        for claim in claims {
            let Some(asking) = asking(&mut tx, claim.worker).await? else {
                answers.push(None);
                continue;
            };
            let mut grants = again(&mut tx, &asking, claim, lease_until).await?;
            let free = (claim.slots as usize).saturating_sub(grants.len());
            for model in best_first(&mut tx, &asking.models, now).await? {
                let left = free.saturating_sub(grants.len());
                if left == 0 {
                    break;
                }
                grants.extend(take(&mut tx, asking.seq, &model, left, now, lease_until).await?);
            }
            grants.sort_by(|a, b| b.cost.total_cmp(&a.cost));
            answers.push(Some(grants));
        }
        tx.commit().await?;
        Ok(answers)
    }
}

async fn asking(tx: &mut Transaction<'_, Sqlite>, worker: WorkerId) -> StoreResult<Option<Asking>> {
    let row = sqlx::query("select seq, models from workers where id = ?1")
        .bind(worker.to_string())
        .fetch_optional(&mut **tx)
        .await?;
    let Some(row) = row else { return Ok(None) };
    let models: String = row.try_get("models")?;
    Ok(Some(Asking {
        seq: row.try_get("seq")?,
        models: read("workers.models", serde_json::from_str(&models))?,
    }))
}

/// Jobs the worker holds but does not know of: the answer to its last claim was lost.
async fn again(
    tx: &mut Transaction<'_, Sqlite>,
    asking: &Asking,
    claim: &Claim,
    lease_until: Moment,
) -> StoreResult<Vec<Granted>> {
    let rows = sqlx::query(
        "update jobs set lease_until = ?1
         where seq in (select seq from jobs where worker = ?2 and state = 'leased'
                       and id not in (select value from json_each(?3)) order by seq limit ?4)
         returning *",
    )
    .bind(lease_until.0)
    .bind(asking.seq)
    .bind(read("holding", serde_json::to_string(&claim.holding))?)
    .bind(claim.slots)
    .fetch_all(&mut **tx)
    .await?;
    rows.iter().map(Granted::of).collect()
}

/// The models in the order of their best claimable job.
async fn best_first(
    tx: &mut Transaction<'_, Sqlite>,
    models: &[(String, u32)],
    now: Moment,
) -> StoreResult<Vec<(String, u32)>> {
    if models.len() == 1 {
        return Ok(models.to_vec());
    }
    let mut ranked = Vec::new();
    for model in models {
        let best = sqlx::query(
            "select priority, cost from jobs indexed by jobs_claimable
             where model = ?1 and physics_version = ?2 and state = 'queued' and runnable > 0 and not_before <= ?3
             order by priority desc, cost desc, seq limit 1",
        )
        .bind(&model.0)
        .bind(model.1)
        .bind(now.0)
        .fetch_optional(&mut **tx)
        .await?;
        if let Some(best) = best {
            ranked.push((
                best.try_get::<i64, _>("priority")?,
                best.try_get::<f64, _>("cost")?,
                model.clone(),
            ));
        }
    }
    ranked.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2)));
    Ok(ranked.into_iter().map(|(_, _, model)| model).collect())
}

async fn take(
    tx: &mut Transaction<'_, Sqlite>,
    worker: i64,
    model: &(String, u32),
    slots: usize,
    now: Moment,
    lease_until: Moment,
) -> StoreResult<Vec<Granted>> {
    let rows = sqlx::query(
        "update jobs set state = 'leased', attempt = attempt + 1, worker = ?1, lease_until = ?2
         where seq in (
             select seq from jobs indexed by jobs_claimable
             where model = ?3 and physics_version = ?4 and state = 'queued' and runnable > 0 and not_before <= ?5
             order by priority desc, cost desc, seq limit ?6)
         returning *",
    )
    .bind(worker)
    .bind(lease_until.0)
    .bind(&model.0)
    .bind(model.1)
    .bind(now.0)
    .bind(i64::try_from(slots).unwrap_or(i64::MAX))
    .fetch_all(&mut **tx)
    .await?;
    for row in &rows {
        sqlx::query(
            "insert into attempts (job, attempt, worker, started_at, steps) values (?1, ?2, ?3, ?4, ?5)",
        )
        .bind(row.try_get::<i64, _>("seq")?)
        .bind(row.try_get::<i64, _>("attempt")?)
        .bind(worker)
        .bind(now.0)
        .bind(row.try_get::<Option<i64>, _>("checkpoint_steps")?.unwrap_or(0))
        .execute(&mut **tx)
        .await?;
    }
    rows.iter().map(Granted::of).collect()
}

impl Granted {
    fn of(row: &SqliteRow) -> StoreResult<Self> {
        let reduced: String = row.try_get("reduced")?;
        Ok(Self {
            job: read("jobs.id", row.try_get::<String, _>("id")?.parse())?,
            attempt: small(row.try_get("attempt")?),
            reduced: read("jobs.reduced", serde_json::from_str(&reduced))?,
            scene_key: row.try_get("scene_key")?,
            checkpoint: checkpoint_of(row)?,
            cost: row.try_get("cost")?,
        })
    }
}

/// The newest checkpoint of a job row.
pub(super) fn checkpoint_of(row: &SqliteRow) -> StoreResult<Option<Checkpoint>> {
    let hash: Option<String> = row.try_get("checkpoint_hash")?;
    let steps: Option<i64> = row.try_get("checkpoint_steps")?;
    let bytes: Option<i64> = row.try_get("checkpoint_bytes")?;
    Ok(hash.map(|hash| Checkpoint {
        hash,
        steps: count(steps.unwrap_or(0)),
        bytes: count(bytes.unwrap_or(0)),
    }))
}
