//! Registration: the worker introduces itself, and again when the coordinator has forgotten it.

use std::time::Duration;

use protocol::client::{Client, ClientError, Patience};
use protocol::{PROTOCOL_VERSION, Registration};
use uuid::Uuid;

use crate::config::Config;
use crate::engine::Engine;
use crate::error::WorkerError;
use crate::execution::CODE_VERSION;
use crate::host;
use crate::job::Session;

/// Longest wait between two tries while the coordinator is away.
const LONGEST_WAIT: Duration = Duration::from_secs(15);

/// The introduction of this process: host and `boot` are its identity.
pub(crate) fn introduction(config: &Config, engine: &dyn Engine, boot: Uuid) -> Registration {
    Registration {
        protocol: PROTOCOL_VERSION,
        host: host::name(),
        boot,
        slots: config.slots,
        hardware: host::hardware(),
        code_version: CODE_VERSION.to_owned(),
        models: engine.models(),
    }
}

/// Registers, however long the coordinator is away.
///
/// # Errors
/// [`WorkerError::Refused`] when repeating does not help: wrong token or protocol version.
pub(crate) async fn register(client: &Client, registration: &Registration) -> Result<Session, WorkerError> {
    let patient = client.with_patience(Patience::endless(LONGEST_WAIT));
    match patient.register(registration).await {
        Ok(registered) => Ok(Session {
            worker: registered.worker,
            // a coordinator that asks for nonsense must not make this worker spin or fall silent
            heartbeat: Duration::from_secs_f64(registered.heartbeat_seconds.clamp(0.05, 600.0)),
            max_checkpoint_bytes: registered.max_checkpoint_bytes,
        }),
        Err(
            error @ (ClientError::FixInput(_)
            | ClientError::GiveUp(_)
            | ClientError::LeaseLost(_)
            | ClientError::Retry { .. }),
        ) => Err(WorkerError::Refused(error.to_string())),
    }
}
