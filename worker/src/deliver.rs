//! Delivers reports, now or when the coordinator is back.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use protocol::JobId;
use protocol::client::{Client, ClientError, Patience};
use tokio::sync::Notify;
use tokio_util::sync::CancellationToken;

use crate::checkpoint::Shelf;
use crate::outbox::{Message, Outbox, Report};

/// Longest wait between two tries while the coordinator is away.
const LONGEST_WAIT: Duration = Duration::from_secs(15);

/// Reports on their way, in memory and on disk.
#[derive(Debug)]
pub struct Courier {
    outbox: Outbox,
    shelf: Shelf,
    waiting: Mutex<VecDeque<Report>>,
    arrived: Notify,
}

impl Courier {
    /// A courier that starts with what earlier processes left.
    #[must_use]
    pub fn new(outbox: Outbox, shelf: Shelf) -> Self {
        let waiting = Mutex::new(outbox.all().into());
        Self { outbox, shelf, waiting, arrived: Notify::new() }
    }

    /// Takes a report: durable on disk before this returns, unless the disk refuses.
    pub async fn take(self: &Arc<Self>, report: Report) {
        let this = Arc::clone(self);
        let stored = report.clone();
        let written = tokio::task::spawn_blocking(move || this.outbox.put(&stored)).await;
        if let Ok(Err(error)) = written {
            tracing::error!(job = %report.job, %error, "a report is kept in memory only");
        }
        self.waiting().push_back(report);
        self.arrived.notify_one();
    }

    /// Jobs whose report has not been taken yet.
    #[must_use]
    pub fn pending(&self) -> Vec<JobId> {
        self.waiting().iter().map(|report| report.job).collect()
    }

    /// Delivers until `stop`; then, for at most `grace`, what is left. What is still left stays on disk.
    pub async fn run(&self, client: &Client, stop: &CancellationToken, grace: Duration) {
        let once = client.with_patience(Patience::none());
        tokio::select! {
            () = stop.cancelled() => {}
            () = self.deliver_for_ever(&once) => {}
        }
        let last = tokio::time::timeout(grace, self.deliver_all(&once)).await;
        if last.is_err() {
            tracing::warn!(reports = self.waiting().len(), "left in the outbox for the next start");
        }
    }

    async fn deliver_for_ever(&self, client: &Client) {
        loop {
            self.deliver_all(client).await;
            self.arrived.notified().await;
        }
    }

    /// Tries every report in turn, pass after pass, until none is left: one that cannot be delivered now does not
    /// hold up the others.
    async fn deliver_all(&self, client: &Client) {
        let mut waits = Patience::endless(LONGEST_WAIT).waits();
        loop {
            let reports: Vec<Report> = self.waiting().iter().cloned().collect();
            let mut ask_again_after = Duration::ZERO;
            for report in &reports {
                // it stays in the queue until it is settled: giving up half-way loses nothing
                match self.deliver(client, report).await {
                    Ok(()) => self.waiting().retain(|other| !other.is_same(report)),
                    Err(retry_after) => {
                        ask_again_after = ask_again_after.max(retry_after.unwrap_or_default())
                    }
                }
            }
            if self.waiting().is_empty() {
                return;
            }
            let wait = waits.next().unwrap_or(LONGEST_WAIT).max(ask_again_after);
            tokio::select! {
                () = tokio::time::sleep(wait) => {}
                // a fresh report is tried at once
                () = self.arrived.notified() => {}
            }
        }
    }

    /// Delivers one report; the error says after what time the coordinator wants to be asked again.
    async fn deliver(&self, client: &Client, report: &Report) -> Result<(), Option<Duration>> {
        let delivered = match &report.message {
            Message::Result(completion) => client.complete(report.job, completion).await,
            Message::Failure(failure) => client.fail(report.job, failure).await,
        };
        let (job, attempt) = (report.job, report.attempt());
        match delivered {
            Ok(()) => {
                tracing::info!(%job, attempt, "delivered");
                self.outbox.remove(report);
                if matches!(report.message, Message::Result(_)) {
                    self.shelf.forget(&report.scene_key);
                }
            }
            Err(ClientError::Retry { what, retry_after }) => {
                tracing::debug!(%job, attempt, what, "not delivered yet");
                return Err(retry_after);
            }
            Err(ClientError::LeaseLost(why)) => {
                tracing::warn!(%job, attempt, why, "the lease is lost: the report is dropped");
                self.outbox.remove(report);
            }
            Err(error @ (ClientError::FixInput(_) | ClientError::GiveUp(_))) => {
                tracing::error!(%job, attempt, %error, "the report is refused and set aside");
                self.outbox.set_aside(report);
            }
        }
        Ok(())
    }

    fn waiting(&self) -> std::sync::MutexGuard<'_, VecDeque<Report>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
