//! Pause, resume, cancel and retry of a sweep, with jobs that other sweeps want too.

use protocol::SweepId;
use protocol::api::SweepState;
use sqlx::{Row as _, Sqlite, Transaction};

use super::settle::settle_sweep;
use super::{Store, StoreResult, count, events, from_word, word};
use crate::clock::Moment;

/// What a user asks of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Start no new job on its behalf.
    Pause,
    /// Undo a pause.
    Resume,
    /// Give it up.
    Cancel,
    /// Queue again what was set aside or cancelled.
    Retry,
}

/// What became of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Controlled {
    /// Done; so many jobs changed their state.
    Changed(u64),
    /// The state of the sweep does not admit it.
    Refused(SweepState),
    /// No such sweep.
    NoSweep,
}

struct Target {
    seq: i64,
    id: SweepId,
    state: SweepState,
    complete: bool,
}

impl Store {
    /// Applies `control` in one transaction. A request that changes nothing (pausing a paused sweep) is accepted.
    ///
    /// # Errors
    /// When the database refuses; nothing is changed then.
    pub async fn control(&self, id: SweepId, control: Control, now: Moment) -> StoreResult<Controlled> {
        let mut tx = self.begin().await?;
        let row = sqlx::query("select seq, state, scanned, candidates from sweeps where id = ?1")
            .bind(id.to_string())
            .fetch_optional(&mut *tx)
            .await?;
        let Some(row) = row else { return Ok(Controlled::NoSweep) };
        let target = Target {
            seq: row.try_get("seq")?,
            id,
            state: from_word("sweeps.state", row.try_get("state")?)?,
            complete: count(row.try_get("scanned")?) >= count(row.try_get("candidates")?),
        };
        let controlled = match control {
            Control::Pause => pause(&mut tx, &target, now).await?,
            Control::Resume => resume(&mut tx, &target, now).await?,
            Control::Cancel => cancel(&mut tx, &target, now).await?,
            Control::Retry => retry(&mut tx, &target, now).await?,
        };
        if matches!(controlled, Controlled::Changed(_)) {
            tx.commit().await?;
        }
        Ok(controlled)
    }
}

async fn pause(tx: &mut Transaction<'_, Sqlite>, target: &Target, now: Moment) -> StoreResult<Controlled> {
    match target.state {
        SweepState::Paused => Ok(Controlled::Changed(0)),
        SweepState::Expanding | SweepState::Running => {
            shift_runnable(tx, target.seq, -1).await?;
            set_state(tx, target, SweepState::Paused, now).await?;
            Ok(Controlled::Changed(0))
        }
        over => Ok(Controlled::Refused(over)),
    }
}

async fn resume(tx: &mut Transaction<'_, Sqlite>, target: &Target, now: Moment) -> StoreResult<Controlled> {
    match target.state {
        SweepState::Expanding | SweepState::Running => Ok(Controlled::Changed(0)),
        SweepState::Paused => {
            shift_runnable(tx, target.seq, 1).await?;
            set_state(tx, target, target.open_state(), now).await?;
            settle_sweep(tx, target.seq, now).await?;
            Ok(Controlled::Changed(0))
        }
        over => Ok(Controlled::Refused(over)),
    }
}

async fn cancel(tx: &mut Transaction<'_, Sqlite>, target: &Target, now: Moment) -> StoreResult<Controlled> {
    match target.state {
        SweepState::Cancelled => return Ok(Controlled::Changed(0)),
        SweepState::Done | SweepState::Failed => return Ok(Controlled::Refused(target.state)),
        SweepState::Expanding | SweepState::Running | SweepState::Paused => {}
    }
    if target.state != SweepState::Paused {
        shift_runnable(tx, target.seq, -1).await?;
    }
    shift_wanted(tx, target.seq, -1).await?;
    sqlx::query(
        "update attempts set ended_at = ?2, \"end\" = 'cancelled' where ended_at is null and (job, attempt) in (
             select j.seq, j.attempt from wants w cross join jobs j on j.seq = w.job
             where w.sweep = ?1 and j.wanted = 0 and j.state = 'leased')",
    )
    .bind(target.seq)
    .bind(now.0)
    .execute(&mut **tx)
    .await?;
    // A job that another sweep wants goes on.
    let changed = sqlx::query(
        "update jobs set state = 'cancelled', lease_until = null
         where seq in (select job from wants where sweep = ?1) and wanted = 0 and state in ('queued', 'leased')",
    )
    .bind(target.seq)
    .execute(&mut **tx)
    .await?;
    set_state(tx, target, SweepState::Cancelled, now).await?;
    Ok(Controlled::Changed(changed.rows_affected()))
}

async fn retry(tx: &mut Transaction<'_, Sqlite>, target: &Target, now: Moment) -> StoreResult<Controlled> {
    if target.state == SweepState::Cancelled {
        shift_wanted(tx, target.seq, 1).await?;
        shift_runnable(tx, target.seq, 1).await?;
    }
    let changed = sqlx::query(
        "update jobs set state = 'queued', failures = 0, losses_in_a_row = 0, not_before = 0
         where seq in (select job from wants where sweep = ?1) and state in ('failed', 'cancelled')",
    )
    .bind(target.seq)
    .execute(&mut **tx)
    .await?;
    if matches!(target.state, SweepState::Failed | SweepState::Cancelled) {
        set_state(tx, target, target.open_state(), now).await?;
    }
    // Other sweeps that were over wait for these jobs again.
    sqlx::query(
        "update sweeps set state = 'running', finished_at = null
         where state in ('done', 'failed') and queued + leased > 0",
    )
    .execute(&mut **tx)
    .await?;
    settle_sweep(tx, target.seq, now).await?;
    Ok(Controlled::Changed(changed.rows_affected()))
}

impl Target {
    /// The state of a sweep that is neither paused nor over.
    fn open_state(&self) -> SweepState {
        if self.complete { SweepState::Running } else { SweepState::Expanding }
    }
}

pub(super) async fn shift_runnable(tx: &mut Transaction<'_, Sqlite>, sweep: i64, by: i64) -> StoreResult<()> {
    sqlx::query(
        "update jobs set runnable = runnable + ?2 where seq in (select job from wants where sweep = ?1)",
    )
    .bind(sweep)
    .bind(by)
    .execute(&mut **tx)
    .await?;
    Ok(())
}

async fn shift_wanted(tx: &mut Transaction<'_, Sqlite>, sweep: i64, by: i64) -> StoreResult<()> {
    sqlx::query("update jobs set wanted = wanted + ?2 where seq in (select job from wants where sweep = ?1)")
        .bind(sweep)
        .bind(by)
        .execute(&mut **tx)
        .await?;
    Ok(())
}

async fn set_state(
    tx: &mut Transaction<'_, Sqlite>,
    target: &Target,
    state: SweepState,
    now: Moment,
) -> StoreResult<()> {
    sqlx::query("update sweeps set state = ?2, finished_at = ?3 where seq = ?1")
        .bind(target.seq)
        .bind(word(state))
        .bind(state.is_terminal().then_some(now.0))
        .execute(&mut **tx)
        .await?;
    let data = serde_json::json!({ "state": state });
    events::append(tx, now, "sweep_state", Some(target.id), None, &data).await
}
