//! Coordinator and worker of a study, inside this process.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::time::Duration;

use protocol::client::{Client, Patience};
use server::Running;
use tokio::task::JoinHandle;
use tokio_util::sync::CancellationToken;

use crate::failure::Failure;

/// A running coordinator with one worker.
pub struct Stack {
    /// Talks to the coordinator.
    pub client: Client,
    coordinator: Running,
    worker: JoinHandle<()>,
    stop_worker: CancellationToken,
    stop_coordinator: CancellationToken,
    broken: CancellationToken,
}

impl Stack {
    /// Starts both on a free port of this machine.
    pub async fn start(data_dir: &Path, slots: u32) -> Result<Self, Failure> {
        let stop_coordinator = CancellationToken::new();
        let config = server::Config {
            bind: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
            data_dir: data_dir.to_owned(),
            // worker and coordinator live and die together: a lease found at the start is nobody's
            lease_seconds: 10.0,
            heartbeat_seconds: 1.0,
            grace_seconds: 0.0,
            ..server::Config::default()
        };
        let coordinator = server::run(config, stop_coordinator.clone())
            .await
            .map_err(|error| Failure::Work(error.to_string()))?;
        let address = coordinator.url();
        let client = Client::new(&address, None, Patience::brief(Duration::from_secs(10)))?;

        let stop_worker = CancellationToken::new();
        let broken = CancellationToken::new();
        let config = worker::Config {
            server: address,
            slots,
            data_dir: data_dir.join("worker"),
            checkpoint_seconds: 30.0,
            ..worker::Config::default()
        };
        let work = worker::run(config, worker::Parts::default(), stop_worker.clone());
        let (stopped, ended) = (stop_worker.clone(), broken.clone());
        let worker = tokio::spawn(async move {
            if let Err(error) = work.await {
                tracing::error!(%error, "the worker ended");
            }
            if !stopped.is_cancelled() {
                ended.cancel();
            }
        });
        Ok(Self { client, coordinator, worker, stop_worker, stop_coordinator, broken })
    }

    /// Waits until the worker ends without being told to.
    pub async fn broken(&self) {
        self.broken.cancelled().await;
    }

    /// Saves every running job, gives it back, and stops both.
    pub async fn end(self) {
        self.stop_worker.cancel();
        // a panic of the worker has been told already
        let _ = self.worker.await;
        self.stop_coordinator.cancel();
        self.coordinator.finished().await;
    }
}
