//! Starting and stopping.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use crate::app::{App, Parts};
use crate::blob::BlobStore;
use crate::clock::{Clock, SystemClock};
use crate::config::Config;
use crate::metrics::Metrics;
use crate::store::{OpenError, Store};

/// Requests still running at a stop get this long.
const PATIENCE: Duration = Duration::from_secs(10);

/// The service cannot start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The data directory cannot be used.
    #[error("data directory {path}: {source}")]
    Data {
        /// Which one.
        path: std::path::PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The database cannot be opened.
    #[error(transparent)]
    Database(#[from] OpenError),
    /// The database refuses to work.
    #[error(transparent)]
    Store(#[from] crate::store::StoreError),
    /// The address cannot be bound.
    #[error("address {address}: {source}; give another one by --bind")]
    Bind {
        /// Which one.
        address: SocketAddr,
        /// Why.
        source: std::io::Error,
    },
}

/// A running service.
#[derive(Debug)]
pub struct Running {
    /// The bound address.
    pub address: SocketAddr,
    finished: tokio::task::JoinHandle<()>,
}

impl Running {
    /// Where clients reach it.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}", self.address)
    }

    /// Waits until it has stopped: requests answered, heartbeats written, database closed.
    pub async fn finished(self) {
        if let Err(error) = self.finished.await {
            tracing::error!(%error, "the service ended by a panic");
        }
    }
}

/// Opens database and files.
///
/// # Errors
/// [`StartError`] when they cannot be used.
pub async fn parts(config: Config, clock: Arc<dyn Clock>) -> Result<Parts, StartError> {
    let failed = |source| StartError::Data { path: config.data_dir.clone(), source };
    std::fs::create_dir_all(&config.data_dir).map_err(failed)?;
    let blobs = Arc::new(BlobStore::open(&config.data_dir).map_err(failed)?);
    let default = || config.data_dir.join("tamp.sqlite").to_string_lossy().into_owned();
    let address = config.database.clone().unwrap_or_else(default);
    let store = Store::open(&address, config.readers).await?;
    // Workers may have outlived the coordinator: give them time to be heard.
    let held = store.grace(clock.now().plus(Duration::from_secs_f64(config.grace_seconds))).await?;
    if held > 0 {
        tracing::info!(
            leases = held,
            grace_seconds = config.grace_seconds,
            "leases found; they get a grace period"
        );
    }
    Ok(Parts { config, clock, store, blobs, metrics: Arc::new(Metrics::default()) })
}

/// Serves until `shutdown` is cancelled.
///
/// # Errors
/// [`StartError`]; nothing runs then.
pub async fn run(config: Config, shutdown: CancellationToken) -> Result<Running, StartError> {
    run_with(config, Arc::new(SystemClock), shutdown).await
}

/// [`run`] by another clock.
///
/// # Errors
/// As [`run`].
pub async fn run_with(
    config: Config,
    clock: Arc<dyn Clock>,
    shutdown: CancellationToken,
) -> Result<Running, StartError> {
    let bind = config.bind;
    let listener =
        TcpListener::bind(bind).await.map_err(|source| StartError::Bind { address: bind, source })?;
    let address = listener.local_addr().map_err(|source| StartError::Bind { address: bind, source })?;
    let app = App::new(parts(config, clock).await?);
    let tasks = TaskTracker::new();
    let stop_background = CancellationToken::new();
    app.spawn_reconcilers(&tasks, &stop_background);
    let router = crate::build(app.clone());
    tracing::info!(%address, data = %app.config().data_dir.display(), "coordinator listens");
    let finished = tokio::spawn(async move {
        let stopping = app.stopping().clone();
        let asked = shutdown.clone();
        let graceful = async move {
            asked.cancelled().await;
            // Long polls and event streams end, the others are answered.
            stopping.cancel();
        };
        let serving = axum::serve(listener, router).with_graceful_shutdown(graceful);
        let overdue = async {
            shutdown.cancelled().await;
            tokio::time::sleep(PATIENCE).await;
        };
        tokio::select! {
            served = serving => if let Err(error) = served {
                tracing::error!(%error, "the listener failed");
            },
            () = overdue => tracing::warn!("connections still open at the stop are cut"),
        }
        stop_background.cancel();
        tasks.close();
        tasks.wait().await;
        if let Err(error) = app.flush().await {
            tracing::error!(%error, "the last heartbeats were not written; leases get a grace period at the next start");
        }
        app.store().close().await;
        tracing::info!("coordinator stopped");
    });
    Ok(Running { address, finished })
}

/// Waits for SIGINT or SIGTERM.
pub async fn stop_signal() {
    let interrupt = tokio::signal::ctrl_c();
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        match signal(SignalKind::terminate()) {
            Ok(mut terminate) => {
                tokio::select! {
                    _ = interrupt => {}
                    _ = terminate.recv() => {}
                }
            }
            Err(error) => {
                tracing::warn!(%error, "SIGTERM cannot be caught");
                let _ = interrupt.await;
            }
        }
    }
    #[cfg(not(unix))]
    {
        let _ = interrupt.await;
    }
}
