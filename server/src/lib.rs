//! The coordinator: REST API, scheduler, SQLite store.

pub mod blob;
pub mod clock;
pub mod config;
pub mod scheduler;
pub mod store;
