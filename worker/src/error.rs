//! Why a worker cannot start or go on.

use std::path::PathBuf;

use protocol::client::BuildError;

/// Errors that end a worker. Everything else (a coordinator that is away, a failed job) it survives.
#[derive(Debug, thiserror::Error)]
pub enum WorkerError {
    /// A setting is wrong: fix it.
    #[error("{field} = {value}: {problem} ({remedy})")]
    Config {
        /// The setting.
        field: String,
        /// Its value.
        value: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// The settings cannot be read.
    #[error("configuration: {0}")]
    Figment(#[from] Box<figment::Error>),
    /// The address or the token cannot be used.
    #[error(transparent)]
    Client(#[from] BuildError),
    /// The coordinator refuses this worker: wrong token or protocol version.
    #[error("the coordinator refuses this worker: {0}")]
    Refused(String),
    /// Threads or signal handlers cannot be had.
    #[error("runtime: {0}")]
    Runtime(std::io::Error),
    /// The data directory cannot be used.
    #[error("data_dir = {}: {error} (choose a directory this user can write to)", path.display())]
    DataDir {
        /// The directory.
        path: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
}

impl WorkerError {
    /// Whether the input is at fault rather than the surroundings.
    #[must_use]
    pub fn is_bad_input(&self) -> bool {
        matches!(
            self,
            Self::Config { .. } | Self::Figment(_) | Self::Client(BuildError::Address(_) | BuildError::Token)
        )
    }
}
