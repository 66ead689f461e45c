//! The reconcilers: expand, flush, reap, settle, tidy. Each takes no input, is idempotent, runs on a timer and on a
//! nudge; what one pass does not get done the next one does.

use std::time::Duration;

use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use crate::app::App;
use crate::error::AppResult;

/// Idempotency keys are kept this long.
const KEEP_KEYS: Duration = Duration::from_secs(7 * 86_400);
/// Unused files are kept this long.
const KEEP_BLOBS: Duration = Duration::from_secs(600);

#[derive(Clone, Copy, Debug)]
enum Pass {
    Expand,
    Flush,
    Reap,
    Settle,
    Progress,
    Tidy,
}

impl App {
    /// Writes the heartbeats gathered.
    ///
    /// # Errors
    /// When the database refuses; they are kept for the next pass.
    pub async fn flush(&self) -> AppResult<()> {
        let (beats, seen) = self.beats().take();
        let written = self.store().heartbeats(&beats, &seen).await;
        if written.is_err() {
            self.beats().put_back(beats, seen);
        }
        Ok(written?)
    }

    /// Takes back leases that ran out. Returns how many.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn reap(&self) -> AppResult<u64> {
        if !self.store().any_expired(self.now()).await? {
            return Ok(0);
        }
        let (beats, seen) = self.beats().take();
        let reaped = self.store().reap(&beats, &seen, self.limits(), self.now()).await;
        if reaped.is_err() {
            self.beats().put_back(beats, seen);
        }
        let lost = reaped?;
        if lost > 0 {
            tracing::warn!(lost, "leases ran out");
            self.metrics().losses.inc_by(lost);
            self.note_work();
            self.note_events();
        }
        Ok(lost)
    }

    /// Closes sweeps that are over.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn settle(&self) -> AppResult<()> {
        if self.store().settle_all(self.now()).await? > 0 {
            self.note_events();
        }
        Ok(())
    }

    /// Removes unused files, old events and old idempotency keys.
    ///
    /// # Errors
    /// When the database or the disk refuses.
    pub async fn tidy(&self) -> AppResult<()> {
        self.store().trim_events(self.config().max_events).await?;
        self.store().forget_requests(self.now().minus(KEEP_KEYS)).await?;
        let unused = self.store().take_unused_blobs(self.now().minus(KEEP_BLOBS)).await?;
        let blobs = std::sync::Arc::clone(self.blobs());
        crate::error::blocking(move || {
            for hash in &unused {
                blobs.remove(hash)?;
            }
            Ok(())
        })
        .await
    }

    /// Tells followers of events how open sweeps get on.
    ///
    /// # Errors
    /// When the database refuses.
    pub async fn tell_progress(&self) -> AppResult<()> {
        if self.progress().receiver_count() == 0 {
            return Ok(());
        }
        for row in self.store().open_sweeps(200).await? {
            let id = row.id;
            let data = self.sweep(id).await?;
            let event = protocol::api::Event {
                id: None,
                at: self.now().rfc3339(),
                kind: "progress".to_owned(),
                sweep: Some(id),
                job: None,
                data: serde_json::json!({
                    "state": data.state, "points": data.points, "counts": data.counts,
                    "progress": data.progress, "eta_seconds": data.eta_seconds,
                }),
            };
            // Nobody listening any more is no error.
            let _ = self.progress().send(event);
        }
        Ok(())
    }

    /// Runs all reconcilers until `stop`.
    pub fn spawn_reconcilers(&self, tasks: &TaskTracker, stop: &CancellationToken) {
        let tick = Duration::from_secs_f64(self.config().tick_seconds);
        let flush = Duration::from_secs_f64(self.config().flush_seconds);
        let passes = [
            (Pass::Flush, flush),
            (Pass::Reap, tick),
            (Pass::Settle, tick),
            (Pass::Progress, tick),
            (Pass::Tidy, Duration::from_secs(60)),
        ];
        for (pass, period) in passes {
            let (app, stop) = (self.clone(), stop.clone());
            tasks.spawn(async move {
                loop {
                    tokio::select! {
                        () = tokio::time::sleep(period) => {}
                        () = stop.cancelled() => break,
                    }
                    app.report(pass, app.pass(pass).await);
                }
            });
        }
        let (app, stop) = (self.clone(), stop.clone());
        tasks.spawn(async move {
            while !stop.is_cancelled() {
                app.report(Pass::Expand, app.pass(Pass::Expand).await);
                tokio::select! {
                    () = app.expansion_wanted() => {}
                    () = tokio::time::sleep(tick) => {}
                    () = stop.cancelled() => {}
                }
            }
        });
    }

    async fn pass(&self, pass: Pass) -> AppResult<()> {
        match pass {
            Pass::Expand => self.expand_all().await,
            Pass::Flush => self.flush().await,
            Pass::Reap => self.reap().await.map(drop),
            Pass::Settle => self.settle().await,
            Pass::Progress => self.tell_progress().await,
            Pass::Tidy => self.tidy().await,
        }
    }

    fn report(&self, pass: Pass, outcome: AppResult<()>) {
        if let Err(error) = outcome {
            self.metrics().reconcile_errors.inc();
            tracing::error!(reconciler = ?pass, %error, "a pass failed; the next one tries again");
        }
    }
}
