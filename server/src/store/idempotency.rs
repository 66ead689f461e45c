//! Requests that may arrive twice.

use protocol::SweepId;
use sqlx::{Row as _, Sqlite, Transaction};

use super::{StoreResult, read};
use crate::clock::Moment;

/// What is known about a request with an idempotency key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replay {
    /// It is new.
    Fresh,
    /// It was answered before with this sweep.
    Known(SweepId),
    /// Another request was made under the same key.
    Differs,
}

pub(super) async fn find(
    tx: &mut Transaction<'_, Sqlite>,
    key: &str,
    fingerprint: &str,
) -> StoreResult<Option<Replay>> {
    let row = sqlx::query(
        "select i.fingerprint, s.id from idempotency i join sweeps s on s.seq = i.sweep where i.key = ?1",
    )
    .bind(key)
    .fetch_optional(&mut **tx)
    .await?;
    let Some(row) = row else { return Ok(None) };
    if row.try_get::<String, _>("fingerprint")? != fingerprint {
        return Ok(Some(Replay::Differs));
    }
    Ok(Some(Replay::Known(read("sweeps.id", row.try_get::<String, _>("id")?.parse())?)))
}

pub(super) async fn remember(
    tx: &mut Transaction<'_, Sqlite>,
    key: &str,
    fingerprint: &str,
    sweep: i64,
    now: Moment,
) -> StoreResult<()> {
    sqlx::query("insert into idempotency (key, fingerprint, sweep, stored_at) values (?1, ?2, ?3, ?4)")
        .bind(key)
        .bind(fingerprint)
        .bind(sweep)
        .bind(now.0)
        .execute(&mut **tx)
        .await?;
    Ok(())
}
