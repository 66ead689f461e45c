//! The stored outcome of a run.

use std::io::Read;

use protocol::{JobId, JobState};
use record::Outcome;
use serde::de::DeserializeOwned;

use super::App;
use crate::error::{AppError, AppResult, blocking};

/// Largest outcome that is unpacked [bytes].
const LARGEST: u64 = 4 << 30;

/// Reads JSON packed by zstd.
pub(super) fn unpack<T: DeserializeOwned>(packed: &[u8]) -> AppResult<T> {
    let broken =
        |error: &dyn std::fmt::Display| AppError::Bug(format!("a stored outcome does not read: {error}"));
    let mut bytes = Vec::new();
    zstd::Decoder::new(packed)
        .map_err(|error| broken(&error))?
        .take(LARGEST)
        .read_to_end(&mut bytes)
        .map_err(|error| broken(&error))?;
    serde_json::from_slice(&bytes).map_err(|error| broken(&error))
}

impl App {
    /// The whole outcome of a finished run.
    ///
    /// # Errors
    /// [`AppError::NotFound`]; [`AppError::NotYet`] while the run is not done.
    pub async fn outcome(&self, id: JobId) -> AppResult<Outcome> {
        let missing = || AppError::NotFound { what: "job", id: id.to_string() };
        let Some(hash) = self.store().outcome_of(id).await? else {
            let held = self.store().lease(id).await?.ok_or_else(missing)?;
            let hint = match held.state {
                JobState::Queued | JobState::Leased => "ask again when it is",
                JobState::Done | JobState::Failed | JobState::Cancelled => "it has no result",
            };
            return Err(AppError::NotYet(format!("job {id} is {:?}, not done; {hint}", held.state)));
        };
        let blobs = std::sync::Arc::clone(self.blobs());
        blocking(move || unpack(&blobs.get(&hash)?)).await
    }
}
