//! Sweeps, jobs, points and workers as the API shows them; control of sweeps.

use protocol::api::{
    AttemptView, ControlReply, JobView, Page, PointView, ResultView, SweepState, SweepView, WorkerView,
};
use protocol::{JobId, JobState, SweepId};

use super::App;
use crate::error::{AppError, AppResult};
use crate::scheduler::estimate::{Work, progress, seconds_left};
use crate::store::{Control, Controlled, ResultRow, RunningWork, SweepRow, WorkerRow};

impl App {
    /// One sweep.
    ///
    /// # Errors
    /// [`AppError::NotFound`].
    pub async fn sweep(&self, id: SweepId) -> AppResult<SweepView> {
        let row = self.sweep_row(id).await?;
        let running = self.store().running_work(row.seq).await?;
        let definition = row.definition.clone();
        Ok(SweepView { definition: Some(definition), ..view(row, &running) })
    }

    pub(super) async fn sweep_row(&self, id: SweepId) -> AppResult<SweepRow> {
        let missing = || AppError::NotFound { what: "sweep", id: id.to_string() };
        self.store().sweep(id).await?.ok_or_else(missing)
    }

    /// A page of sweeps, newest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn sweeps(
        &self,
        state: Option<SweepState>,
        before: Option<i64>,
        limit: u32,
    ) -> AppResult<Page<SweepView>> {
        let mut rows = self.store().sweeps(state, before, limit + 1).await?;
        let next = cut(&mut rows, limit).map(|row| row.seq.to_string());
        let mut items = Vec::with_capacity(rows.len());
        for row in rows {
            let running = if row.counts.leased > 0 {
                self.store().running_work(row.seq).await?
            } else {
                RunningWork::default()
            };
            items.push(view(row, &running));
        }
        Ok(Page { items, next })
    }

    /// Pauses, resumes, cancels or retries a sweep.
    ///
    /// # Errors
    /// [`AppError::NotFound`]; [`AppError::Conflict`] when its state does not admit it.
    pub async fn control(&self, id: SweepId, control: Control) -> AppResult<ControlReply> {
        match self.store().control(id, control, self.now()).await? {
            Controlled::NoSweep => Err(AppError::NotFound { what: "sweep", id: id.to_string() }),
            Controlled::Refused(state) => {
                let verb = format!("{control:?}").to_lowercase();
                let hint = match (control, state) {
                    (Control::Resume | Control::Pause, SweepState::Cancelled) => "; retry brings it back",
                    _ => "",
                };
                Err(AppError::Conflict(format!("a sweep that is {} cannot {verb}{hint}", state.name())))
            }
            Controlled::Changed(jobs_changed) => {
                self.note_events();
                self.note_work();
                self.0.expand.notify_one();
                tracing::info!(sweep = %id, ?control, jobs_changed, "sweep controlled");
                Ok(ControlReply { sweep: self.sweep(id).await?, jobs_changed })
            }
        }
    }

    /// A page of a sweep's points.
    ///
    /// # Errors
    /// [`AppError::NotFound`].
    pub async fn points(
        &self,
        id: SweepId,
        state: Option<JobState>,
        after: Option<u64>,
        limit: u32,
    ) -> AppResult<Page<PointView>> {
        let sweep = self.sweep_row(id).await?;
        let mut rows = self.store().points(sweep.seq, state, after, limit + 1).await?;
        let next = cut(&mut rows, limit).map(|row| row.point.to_string());
        let items = rows
            .into_iter()
            .map(|row| PointView {
                point: row.point,
                job: row.job,
                state: row.state,
                scene_key: row.scene_key,
                scene: row.scene,
            })
            .collect();
        Ok(Page { items, next })
    }

    /// One job.
    ///
    /// # Errors
    /// [`AppError::NotFound`].
    pub async fn job(&self, id: JobId) -> AppResult<JobView> {
        let missing = || AppError::NotFound { what: "job", id: id.to_string() };
        let job = self.store().job(id).await?.ok_or_else(missing)?;
        let attempts = self.store().attempts(job.seq).await?;
        let (accepted, others): (Vec<ResultRow>, Vec<ResultRow>) = self
            .store()
            .results_of_job(job.seq)
            .await?
            .into_iter()
            .partition(|result| Some(result.seq) == job.result);
        Ok(JobView {
            id: job.id,
            scene_key: job.scene_key,
            model: job.model,
            physics_version: job.physics_version,
            state: job.state,
            priority: job.priority,
            cost_core_seconds: job.cost,
            attempt: job.attempt,
            failures: job.failures,
            losses: job.losses,
            reduced: job.reduced,
            scene: job.scene,
            sweeps: self.store().sweeps_of_job(job.seq).await?,
            checkpoint: job.checkpoint,
            attempts: attempts
                .into_iter()
                .map(|row| AttemptView {
                    attempt: row.attempt,
                    worker: row.worker,
                    host: row.host,
                    started_at: row.started_at.rfc3339(),
                    ended_at: row.ended_at.map(|at| at.rfc3339()),
                    end: row.end,
                    class: row.class,
                    message: row.message,
                    steps: row.steps,
                    expected_steps: row.expected_steps,
                    fraction: row.fraction,
                    wall_s: row.wall_s,
                    live: row.live,
                })
                .collect(),
            result: accepted.into_iter().next().map(result_view),
            other_results: others.into_iter().map(result_view).collect(),
        })
    }

    /// A page of workers, newest first.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn workers(&self, before: Option<i64>, limit: u32) -> AppResult<Page<WorkerView>> {
        let mut rows = self.store().workers(before, limit + 1).await?;
        let next = cut(&mut rows, limit).map(|row| row.seq.to_string());
        Ok(Page { items: rows.into_iter().map(worker_view).collect(), next })
    }

    /// Workers heard within two leases.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn workers_alive(&self) -> AppResult<u64> {
        Ok(self.store().workers_alive(self.now().minus(2 * self.config().lease())).await?)
    }
}

/// Cuts a list that was read one entry too far to its page; the last entry of the page when there is a next one.
pub(super) fn cut<T>(rows: &mut Vec<T>, limit: u32) -> Option<&T> {
    let more = rows.len() > limit as usize;
    rows.truncate(limit as usize);
    if more { rows.last() } else { None }
}

fn worker_view(row: WorkerRow) -> WorkerView {
    WorkerView {
        id: row.id,
        host: row.host,
        slots: row.slots,
        hardware: row.hardware,
        code_version: row.code_version,
        models: row.models,
        leases: row.leases,
        registered_at: row.registered_at.rfc3339(),
        seen_at: row.seen_at.rfc3339(),
    }
}

fn result_view(row: ResultRow) -> ResultView {
    ResultView {
        digest: row.digest,
        attempt: row.attempt,
        hardware: row.hardware,
        alarm: row.alarm,
        stored_at: row.stored_at.rfc3339(),
        record: row.record,
        execution: row.execution,
    }
}

pub(super) fn view(row: SweepRow, running: &RunningWork) -> SweepView {
    let work = work(&row, running);
    let over = row.state.is_terminal();
    SweepView {
        id: row.id,
        name: row.name,
        model: row.model,
        state: row.state,
        priority: row.priority,
        points: row.points,
        expanded: row.expanded,
        left_out: row.left_out,
        reused: row.reused,
        counts: row.counts,
        progress: if row.state == SweepState::Done { 1.0 } else { progress(&work) },
        eta_seconds: if over { None } else { seconds_left(&work) },
        cost_core_seconds: work.total,
        submitted_at: row.submitted_at.rfc3339(),
        finished_at: row.finished_at.map(|at| at.rfc3339()),
        definition: None,
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts of points stay far below 2^53")]
fn work(row: &SweepRow, running: &RunningWork) -> Work {
    // Points not expanded yet are taken to cost what the others cost on average.
    let share = if row.expanded > 0 { row.points as f64 / row.expanded as f64 } else { 1.0 };
    Work {
        total: row.cost * share,
        done: row.cost_done,
        running_done: running.done,
        given_up: row.cost_given_up,
        timed_cost: row.timed_cost + running.timed_cost,
        timed_wall: row.timed_wall + running.timed_wall,
        running: running.jobs,
        longest_left: running.longest_left,
    }
}
