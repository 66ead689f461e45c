//! Use cases: what the service can do, without HTTP and SQL words.

mod analyse;
mod analyse_discs;
mod analyse_plastic;
mod collect;
mod expand;
mod explain;
mod filter;
mod lease;
mod rows;
mod submit;
mod table;
mod view;
mod work;

use std::sync::Arc;

use tokio::sync::{Notify, Semaphore, broadcast, watch};
use tokio_util::sync::CancellationToken;

use crate::blob::BlobStore;
use crate::clock::{Clock, Moment};
use crate::config::Config;
use crate::metrics::Metrics;
use crate::scheduler::claims::ClaimQueue;
use crate::scheduler::heartbeats::Heartbeats;
use crate::scheduler::lifecycle::Limits;
use crate::store::Store;

pub use analyse::Analysis;
pub use analyse_discs::DiscAnalysis;
pub use analyse_plastic::PlasticAnalysis;
pub use collect::{ResultQuery, RowStream};
pub use filter::{Filter, Filters};
pub use submit::{Submission, Submitted};

/// Everything the use cases need; made once, shared by handlers and reconcilers.
pub struct Parts {
    /// Configuration.
    pub config: Config,
    /// The clock.
    pub clock: Arc<dyn Clock>,
    /// The database.
    pub store: Store,
    /// Checkpoints and outcomes.
    pub blobs: Arc<BlobStore>,
    /// Counters.
    pub metrics: Arc<Metrics>,
}

/// Analyses computed at the same time: they take whole cores.
const ANALYSTS: usize = 2;

/// The service.
#[derive(Clone)]
pub struct App(Arc<Inner>);

struct Inner {
    parts: Parts,
    claims: Arc<ClaimQueue>,
    beats: Heartbeats,
    work: watch::Sender<u64>,
    happened: watch::Sender<u64>,
    expand: Notify,
    progress: broadcast::Sender<protocol::api::Event>,
    stopping: CancellationToken,
    analysts: Semaphore,
}

impl App {
    /// A service over `parts`.
    #[must_use]
    pub fn new(parts: Parts) -> Self {
        let claims = ClaimQueue::new(parts.store.clone(), Arc::clone(&parts.clock), parts.config.lease());
        Self(Arc::new(Inner {
            parts,
            claims,
            beats: Heartbeats::default(),
            work: watch::Sender::new(0),
            happened: watch::Sender::new(0),
            expand: Notify::new(),
            progress: broadcast::Sender::new(256),
            stopping: CancellationToken::new(),
            analysts: Semaphore::new(ANALYSTS),
        }))
    }

    /// Configuration.
    #[must_use]
    pub fn config(&self) -> &Config {
        &self.0.parts.config
    }

    /// The database.
    #[must_use]
    pub fn store(&self) -> &Store {
        &self.0.parts.store
    }

    /// Checkpoints and outcomes.
    #[must_use]
    pub fn blobs(&self) -> &Arc<BlobStore> {
        &self.0.parts.blobs
    }

    /// Counters.
    #[must_use]
    pub fn metrics(&self) -> &Arc<Metrics> {
        &self.0.parts.metrics
    }

    /// The present moment.
    #[must_use]
    pub fn now(&self) -> Moment {
        self.0.parts.clock.now()
    }

    /// The budgets of jobs.
    #[must_use]
    pub fn limits(&self) -> Limits {
        Limits { max_failures: self.config().max_failures, max_losses: self.config().max_losses }
    }

    /// Cancelled when the service stops: long polls and event streams end.
    #[must_use]
    pub fn stopping(&self) -> &CancellationToken {
        &self.0.stopping
    }

    /// Signs of life not yet written.
    #[must_use]
    pub fn beats(&self) -> &Heartbeats {
        &self.0.beats
    }

    /// Changes whenever an event was stored.
    #[must_use]
    pub fn happened(&self) -> watch::Receiver<u64> {
        self.0.happened.subscribe()
    }

    /// Progress of sweeps; not stored.
    #[must_use]
    pub fn progress(&self) -> &broadcast::Sender<protocol::api::Event> {
        &self.0.progress
    }

    /// Waits until an expansion is asked for.
    pub async fn expansion_wanted(&self) {
        self.0.expand.notified().await;
    }

    /// Something was stored that followers of events want to see.
    pub(crate) fn note_events(&self) {
        self.0.happened.send_modify(|turn| *turn += 1);
    }

    /// There may be a job to claim.
    pub(crate) fn note_work(&self) {
        self.0.work.send_modify(|turn| *turn += 1);
    }
}
