//! One granted job: its thread, its heartbeats, its checkpoints, its last word.

use std::sync::Arc;
use std::thread;
use std::time::Duration;

use bytes::Bytes;
use protocol::client::{Client, ClientError, Patience};
use protocol::{Completion, Directive, Failure, Grant, Heartbeat, Release, WorkerId};
use record::{Outcome, Row};
use scene::Reduced;
use sim_core::{KernelChoice, Options};
use tokio::sync::{mpsc, oneshot};
use tokio::time::MissedTickBehavior;

use crate::checkpoint::{self, Sealed, Shelf};
use crate::config::Config;
use crate::control::{Command, Control};
use crate::deliver::Courier;
use crate::engine::Engine;
use crate::failure::Failed;
use crate::outbox::{Message, Report};
use crate::runner::{self, End, Task};

/// The physics may recurse deeper than the default of a thread allows.
const STACK: usize = 16 << 20;

/// What every job of a worker shares.
pub(crate) struct Context {
    pub client: Client,
    pub engine: Arc<dyn Engine>,
    pub shelf: Shelf,
    pub courier: Arc<Courier>,
    pub config: Config,
}

/// What the coordinator said at registration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Session {
    pub worker: WorkerId,
    pub heartbeat: Duration,
    pub max_checkpoint_bytes: u64,
}

/// One job under its lease.
pub(crate) struct Job {
    pub context: Arc<Context>,
    pub session: Session,
    pub grant: Grant,
    pub control: Arc<Control>,
}

impl Job {
    /// Runs the job to its end; returns when nothing more is to be done for it here.
    pub(crate) async fn supervise(self) {
        tokio::select! {
            () = self.execute() => {}
            () = self.heartbeats() => {}
        }
    }

    async fn execute(&self) {
        let task = match self.prepare().await {
            Ok(task) => task,
            Err(failed) => return self.report_failure(failed).await,
        };
        let (tell, told) = mpsc::unbounded_channel();
        let end = match self.start(task, tell) {
            Ok(ending) => self.accompany(ending, told).await,
            Err(error) => End::Failed(Failed::retryable("thread", format!("cannot start a thread: {error}"))),
        };
        match end {
            End::Finished { outcome, execution } => self.report_result(*outcome, execution).await,
            End::Yielded(sealed) => self.give_back(sealed).await,
            End::Dropped => tracing::info!(job = %self.grant.job, "dropped"),
            End::Failed(failed) => self.report_failure(failed).await,
        }
    }

    /// Reads the scene and gathers the checkpoints to go on from.
    async fn prepare(&self) -> Result<Task, Failed> {
        let grant = &self.grant;
        let scene = Reduced::from_json(&grant.reduced)
            .map_err(|problems| Failed::retryable("protocol", problems.to_string()))?;
        let key = scene.key();
        if key.as_str() != grant.scene_key {
            let message = format!("granted as {}, computed here as {key}", grant.scene_key);
            return Err(Failed::retryable("scene_key", message));
        }
        let config = &self.context.config;
        let mut starts: Vec<(u64, Bytes)> = Vec::new();
        let known_steps = |bytes: &Bytes| checkpoint::open(bytes, &key).ok().map(|(label, _)| label.steps);
        if let Some(local) = self.context.shelf.get(&key)
            && let Some(steps) = known_steps(&local)
        {
            starts.push((steps, local));
        }
        if let Some(remote) = &grant.checkpoint
            && starts.iter().all(|(steps, _)| *steps < remote.steps)
            && let Some(bytes) = self.download().await
        {
            starts.push((remote.steps, bytes));
        }
        starts.sort_by_key(|(steps, _)| std::cmp::Reverse(*steps));
        Ok(Task {
            scene,
            key,
            options: Options {
                threads: usize::try_from(config.threads).unwrap_or(1),
                kernel: KernelChoice::Auto,
            },
            starts: starts.into_iter().map(|(_, bytes)| bytes).collect(),
            checkpoint_every: Some(Duration::from_secs_f64(config.checkpoint_seconds)),
        })
    }

    async fn download(&self) -> Option<Bytes> {
        let client = self.context.client.with_patience(Patience::brief(Duration::from_secs(60)));
        match client.get_checkpoint(self.grant.job, self.session.worker, self.grant.attempt).await {
            Ok(bytes) => Some(bytes),
            Err(error) => {
                tracing::warn!(job = %self.grant.job, %error, "the checkpoint cannot be had: from the beginning");
                None
            }
        }
    }

    /// Starts the thread that computes; heartbeats never wait for it.
    fn start(
        &self,
        task: Task,
        tell: mpsc::UnboundedSender<Sealed>,
    ) -> std::io::Result<oneshot::Receiver<End>> {
        let (ended, ending) = oneshot::channel();
        let engine = Arc::clone(&self.context.engine);
        let control = Arc::clone(&self.control);
        let shelf = self.context.shelf.clone();
        let job = self.grant.job;
        thread::Builder::new().name(format!("job-{job}")).stack_size(STACK).spawn(move || {
            let end = runner::run(engine.as_ref(), &task, &control, &mut |sealed| {
                keep(&shelf, &sealed);
                // the receiver is gone only when the job is given up
                let _ = tell.send(sealed);
            });
            if let End::Yielded(Some(sealed)) = &end {
                keep(&shelf, sealed);
            }
            let _ = ended.send(end);
        })?;
        Ok(ending)
    }

    /// Uploads checkpoints as they come, until the thread ends.
    async fn accompany(
        &self,
        mut ending: oneshot::Receiver<End>,
        mut told: mpsc::UnboundedReceiver<Sealed>,
    ) -> End {
        let uploads = async {
            while let Some(mut sealed) = told.recv().await {
                while let Ok(newer) = told.try_recv() {
                    sealed = newer;
                }
                let patience = self.context.config.checkpoint_seconds.max(5.0);
                self.upload(sealed, Duration::from_secs_f64(patience)).await;
            }
        };
        let ended = tokio::select! {
            ended = &mut ending => ended,
            () = uploads => ending.await,
        };
        // the runner turns panics into ends: only a thread that was torn down says nothing
        ended.unwrap_or_else(|_| {
            End::Failed(Failed::retryable("thread", "the thread ended silently".to_owned()))
        })
    }

    async fn upload(&self, sealed: Sealed, patience: Duration) {
        let (job, steps, size) = (self.grant.job, sealed.label.steps, sealed.bytes.len());
        if size as u64 > self.session.max_checkpoint_bytes {
            tracing::warn!(%job, bytes = size, "too large for the coordinator: the checkpoint stays on this machine");
            return;
        }
        let client = self.context.client.with_patience(Patience::brief(patience));
        let (worker, attempt) = (self.session.worker, self.grant.attempt);
        match client.put_checkpoint(job, worker, attempt, steps, sealed.bytes).await {
            Ok(()) => tracing::debug!(%job, steps, bytes = size, "checkpoint uploaded"),
            Err(ClientError::LeaseLost(why)) => self.lose(&why),
            Err(error) => tracing::warn!(%job, steps, %error, "the checkpoint stays on this machine for now"),
        }
    }

    /// Tells the coordinator every few seconds that the job is alive, and does what it answers.
    async fn heartbeats(&self) {
        let mut ticks = tokio::time::interval(self.session.heartbeat);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        ticks.tick().await;
        let mut away = false;
        loop {
            ticks.tick().await;
            match self.context.client.heartbeat(self.grant.job, &self.beat()).await {
                Ok(reply) => {
                    if std::mem::take(&mut away) {
                        tracing::info!(job = %self.grant.job, "the coordinator is back");
                    }
                    match reply.directive {
                        Directive::Continue => {}
                        Directive::Yield => self.control.command(Command::Yield),
                        Directive::Drop => self.control.command(Command::Drop),
                    }
                }
                Err(ClientError::LeaseLost(why)) => self.lose(&why),
                Err(error) => {
                    if !std::mem::replace(&mut away, true) {
                        tracing::warn!(job = %self.grant.job, %error, "no heartbeat for now; the job goes on");
                    }
                }
            }
        }
    }

    fn beat(&self) -> Heartbeat {
        let latest = self.control.latest();
        let (steps, expected_steps, fraction, live) = latest.progress.map_or_else(
            || (0, 0, 0.0, Row::new()),
            |progress| (progress.steps, progress.expected_steps, progress.fraction, progress.live),
        );
        Heartbeat {
            worker: self.session.worker,
            attempt: self.grant.attempt,
            steps,
            expected_steps,
            fraction: if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 },
            wall_s: latest.wall.as_secs_f64(),
            live,
        }
    }

    fn lose(&self, why: &str) {
        if self.control.now() != Command::Drop {
            tracing::warn!(job = %self.grant.job, attempt = self.grant.attempt, why, "the lease is lost");
        }
        self.control.command(Command::Drop);
    }

    async fn report_result(&self, outcome: Outcome, mut execution: Row) {
        execution
            .put("worker", self.session.worker.to_string())
            .put("attempt", i64::from(self.grant.attempt));
        let completion = Completion {
            worker: self.session.worker,
            attempt: self.grant.attempt,
            scene_key: self.grant.scene_key.clone(),
            outcome,
            execution,
        };
        self.report(Message::Result(Box::new(completion))).await;
    }

    async fn report_failure(&self, failed: Failed) {
        tracing::warn!(job = %self.grant.job, class = failed.class, message = failed.message, "the run failed");
        let failure = Failure {
            worker: self.session.worker,
            attempt: self.grant.attempt,
            kind: failed.kind,
            class: failed.class.to_owned(),
            message: failed.message,
        };
        self.report(Message::Failure(failure)).await;
    }

    async fn report(&self, message: Message) {
        match self.grant.scene_key.parse() {
            Ok(scene_key) => {
                self.context.courier.take(Report { job: self.grant.job, scene_key, message }).await;
            }
            Err(error) => tracing::error!(job = %self.grant.job, %error, "granted under no scene key"),
        }
    }

    /// Uploads the last state and gives the lease back.
    async fn give_back(&self, sealed: Option<Sealed>) {
        let patience = Duration::from_secs_f64(self.context.config.drain_seconds);
        let (job, steps) = (self.grant.job, sealed.as_ref().map_or(0, |sealed| sealed.label.steps));
        let returned = tokio::time::timeout(patience, async {
            if let Some(sealed) = sealed {
                self.upload(sealed, patience).await;
            }
            let release = Release {
                worker: self.session.worker,
                attempt: self.grant.attempt,
                reason: "the worker was asked to stop".to_owned(),
            };
            self.context.client.with_patience(Patience::brief(patience)).release(job, &release).await
        });
        match returned.await {
            Ok(Ok(())) => tracing::info!(%job, steps, "given back"),
            Ok(Err(ClientError::LeaseLost(why))) => tracing::info!(%job, why, "the lease was lost already"),
            Ok(Err(error)) => {
                tracing::warn!(%job, steps, %error, "not given back: the lease will expire, the state is kept");
            }
            Err(_) => {
                tracing::warn!(%job, steps, "no time to give it back: the lease will expire, the state is kept")
            }
        }
    }
}

/// Stores a checkpoint on this machine; a full disk costs safety, not the run.
fn keep(shelf: &Shelf, sealed: &Sealed) {
    if let Err(error) = shelf.put(sealed) {
        tracing::warn!(scene = %sealed.label.scene_key, %error, "the checkpoint is not kept on this machine");
    }
}
