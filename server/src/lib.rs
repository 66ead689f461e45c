//! The coordinator: REST API, scheduler, SQLite store.
//!
//! [`run`] serves until told to stop and tells the bound address; [`build`] makes the router alone, for tests and for
//! other processes that host it.

mod api;
pub mod app;
pub mod blob;
pub mod clock;
pub mod config;
pub mod error;
pub mod metrics;
pub mod scheduler;
mod serve;
pub mod store;
pub mod telemetry;

pub use api::description;
pub use app::{App, Parts};
pub use config::{Args, Config, ConfigError};
pub use serve::{Running, StartError, parts, run, run_with, stop_signal};

/// The router over a service; background work is started by [`run`].
pub fn build(app: App) -> axum::Router {
    api::router(app)
}
