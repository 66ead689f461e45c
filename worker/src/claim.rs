//! The loop of a worker: ask for jobs, start them, stop them when told.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use protocol::client::{ClientError, Patience};
use protocol::{ClaimRequest, ClaimResponse, Grant, JobId, Registration};
use tokio::sync::watch;
use tokio::task::JoinSet;
use tokio_util::sync::CancellationToken;

use crate::control::{Command, Control};
use crate::error::WorkerError;
use crate::gate::Leave;
use crate::job::{Context, Job, Session};
use crate::session::register;

/// The coordinator holds a claim this long while there is no work [s].
const LONG_POLL_S: f64 = 20.0;
/// Longest wait between two tries while the coordinator is away.
const LONGEST_WAIT: Duration = Duration::from_secs(15);

/// Why a worker ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// It was told to stop.
    Stopped,
    /// The machine is no longer available.
    TimeOver,
    /// There was nothing to do for the time allowed.
    Idle,
}

/// Jobs in hand and the session they run under.
pub(crate) struct Desk {
    context: Arc<Context>,
    registration: Registration,
    session: Session,
    running: JoinSet<JobId>,
    controls: BTreeMap<JobId, Arc<Control>>,
    last_work: Instant,
}

/// What woke the loop.
enum Wake {
    Stop,
    GateMoved,
    JobEnded(JobId),
    Claimed { asked: Instant, answer: Result<ClaimResponse, ClientError> },
    TimePassed,
}

impl Desk {
    pub(crate) fn new(context: Arc<Context>, registration: Registration, session: Session) -> Self {
        Self {
            context,
            registration,
            session,
            running: JoinSet::new(),
            controls: BTreeMap::new(),
            last_work: Instant::now(),
        }
    }

    /// Works until told to stop, out of time, or idle for too long; then gives every job back.
    ///
    /// # Errors
    /// [`WorkerError::Refused`] when the coordinator no longer accepts this worker.
    pub(crate) async fn work(
        mut self,
        mut gate: watch::Receiver<Leave>,
        stop: &CancellationToken,
    ) -> Result<Ended, WorkerError> {
        let mut waits = Patience::endless(LONGEST_WAIT).waits();
        let mut away = false;
        let mut not_before = Instant::now();
        let ended = loop {
            let leave = *gate.borrow_and_update();
            self.obey(leave);
            if leave == Leave::End {
                break Ok(Ended::TimeOver);
            }
            if self.is_idle_for_too_long() {
                break Ok(Ended::Idle);
            }
            match self.next_event(leave, not_before, &mut gate, stop).await {
                Wake::Stop => break Ok(Ended::Stopped),
                Wake::GateMoved | Wake::TimePassed => {}
                Wake::JobEnded(job) => {
                    self.controls.remove(&job);
                    self.last_work = Instant::now();
                }
                Wake::Claimed { asked, answer: Ok(response) } => {
                    if std::mem::take(&mut away) {
                        tracing::info!("the coordinator is back");
                    }
                    waits = Patience::endless(LONGEST_WAIT).waits();
                    if response.grants.is_empty() {
                        // a long poll has waited already: ask again at once
                        not_before = asked + seconds(response.retry_seconds.min(60.0));
                    }
                    for grant in response.grants {
                        self.start(grant);
                    }
                }
                Wake::Claimed { answer: Err(ClientError::Retry { what, retry_after }), .. } => {
                    if !std::mem::replace(&mut away, true) {
                        tracing::warn!(what, "the coordinator is away; asking again from time to time");
                    }
                    let wait = waits.next().unwrap_or(LONGEST_WAIT).max(retry_after.unwrap_or_default());
                    not_before = Instant::now() + wait;
                }
                Wake::Claimed { answer: Err(ClientError::FixInput(problem)), .. } => {
                    tracing::warn!(problem = problem.title, "the claim is refused; registering again");
                    match self.register_again(stop).await {
                        Ok(true) => not_before = Instant::now() + waits.next().unwrap_or(LONGEST_WAIT),
                        Ok(false) => break Ok(Ended::Stopped),
                        Err(error) => break Err(error),
                    }
                }
                Wake::Claimed { answer: Err(error), .. } => {
                    break Err(WorkerError::Refused(error.to_string()));
                }
            }
        };
        self.drain().await;
        ended
    }

    async fn next_event(
        &mut self,
        leave: Leave,
        not_before: Instant,
        gate: &mut watch::Receiver<Leave>,
        stop: &CancellationToken,
    ) -> Wake {
        let free =
            self.context.config.slots.saturating_sub(u32::try_from(self.running.len()).unwrap_or(u32::MAX));
        let may_claim = free > 0 && leave == Leave::Work;
        let request = self.request(free);
        let client = &self.context.client;
        let claim = async {
            tokio::time::sleep_until(not_before.into()).await;
            let asked = Instant::now();
            (asked, client.claim(&request).await)
        };
        tokio::select! {
            biased;
            () = stop.cancelled() => Wake::Stop,
            Some(ended) = self.running.join_next() => match ended {
                Ok(job) => Wake::JobEnded(job),
                Err(error) => {
                    // a supervisor that panicked is our own defect: tell, and let the lease expire
                    tracing::error!(%error, "a job was lost inside this worker");
                    Wake::TimePassed
                }
            },
            Ok(()) = gate.changed() => Wake::GateMoved,
            () = tokio::time::sleep(Duration::from_secs(1)), if self.context.config.idle_timeout_seconds.is_some() && !may_claim => Wake::TimePassed,
            (asked, answer) = claim, if may_claim => Wake::Claimed { asked, answer },
        }
    }

    fn request(&self, free: u32) -> ClaimRequest {
        // a finished job whose report is on its way is still ours
        let mut holding: Vec<JobId> = self.controls.keys().copied().collect();
        holding.extend(self.context.courier.pending());
        let idle = self.context.config.idle_timeout_seconds.unwrap_or(f64::INFINITY);
        ClaimRequest {
            worker: self.session.worker,
            slots: free,
            holding,
            wait_seconds: LONG_POLL_S.min(idle),
        }
    }

    fn start(&mut self, grant: Grant) {
        let job = grant.job;
        if self.controls.contains_key(&job) {
            tracing::warn!(%job, "granted while it is running here; ignored");
            return;
        }
        tracing::info!(%job, attempt = grant.attempt, resumes = grant.checkpoint.is_some(), "granted");
        let control = Arc::new(Control::new());
        self.controls.insert(job, Arc::clone(&control));
        self.last_work = Instant::now();
        let work = Job { context: Arc::clone(&self.context), session: self.session, grant, control };
        self.running.spawn(async move {
            work.supervise().await;
            job
        });
    }

    /// Suspends, wakes or gives back what runs.
    fn obey(&self, leave: Leave) {
        for control in self.controls.values() {
            control.pause(leave == Leave::Pause);
            if matches!(leave, Leave::Yield | Leave::End) {
                control.command(Command::Yield);
            }
        }
    }

    fn is_idle_for_too_long(&self) -> bool {
        let Some(limit) = self.context.config.idle_timeout_seconds else { return false };
        self.running.is_empty() && self.last_work.elapsed() >= seconds(limit)
    }

    /// `false`: told to stop meanwhile.
    async fn register_again(&mut self, stop: &CancellationToken) -> Result<bool, WorkerError> {
        tokio::select! {
            () = stop.cancelled() => Ok(false),
            session = register(&self.context.client, &self.registration) => {
                self.session = session?;
                Ok(true)
            }
        }
    }

    /// Gives every job back with its state.
    async fn drain(mut self) {
        if !self.controls.is_empty() {
            tracing::info!(jobs = self.controls.len(), "saving and giving back");
        }
        self.obey(Leave::End);
        while self.running.join_next().await.is_some() {}
    }
}

fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::ZERO)
}
