//! Registration and claims.

use std::time::Duration;

use protocol::{ClaimRequest, ClaimResponse, Grant, PROTOCOL_VERSION, Registered, Registration, WorkerId};

use super::App;
use super::submit::new_uuid;
use crate::error::{AppError, AppResult};
use crate::store::{Claim, Granted};

/// Longest long poll.
const LONGEST_WAIT: Duration = Duration::from_secs(60);
/// While polling, look again this often even if nothing was announced: a back-off may have run out.
const LOOK_AGAIN: Duration = Duration::from_secs(1);
/// Most slots of one worker.
const MOST_SLOTS: u32 = 4096;

impl App {
    /// Registers a worker process.
    ///
    /// # Errors
    /// [`AppError::Protocol`], [`AppError::Invalid`].
    pub async fn register(&self, registration: &Registration) -> AppResult<Registered> {
        if registration.protocol != PROTOCOL_VERSION {
            return Err(AppError::Protocol { found: registration.protocol, accepted: PROTOCOL_VERSION });
        }
        if registration.slots == 0 || registration.slots > MOST_SLOTS {
            let remedy = "give 1 to 4096 slots";
            return Err(AppError::field("request", "slots", registration.slots, "out of range", remedy));
        }
        for (field, text) in [("host", &registration.host), ("hardware", &registration.hardware)] {
            if text.trim().is_empty() || text.len() > 200 {
                let remedy = "give 1 to 200 characters";
                return Err(AppError::field(
                    "request",
                    field,
                    format!("{text:.40?}"),
                    "no usable name",
                    remedy,
                ));
            }
        }
        if registration.models.is_empty() || registration.models.len() > 100 {
            let remedy = "name the models this worker runs, with their physics versions";
            return Err(AppError::field(
                "request",
                "models",
                registration.models.len(),
                "out of range",
                remedy,
            ));
        }
        let fresh = WorkerId(new_uuid(self.now()));
        let worker = self.store().register(fresh, registration, self.now()).await?;
        tracing::info!(%worker, host = %registration.host, slots = registration.slots, "worker registered");
        Ok(Registered {
            worker,
            lease_seconds: self.config().lease_seconds,
            heartbeat_seconds: self.config().heartbeat_seconds,
            max_checkpoint_bytes: self.config().max_checkpoint_bytes,
        })
    }

    /// Grants jobs, waiting for some up to the time asked for.
    ///
    /// # Errors
    /// [`AppError::NotFound`] for a worker that is not registered: it registers again.
    pub async fn claim(&self, request: ClaimRequest) -> AppResult<ClaimResponse> {
        if !(0.0..1e6).contains(&request.wait_seconds) {
            let remedy = "give the seconds to wait, 0 or more";
            let value = request.wait_seconds;
            return Err(AppError::field("request", "wait_seconds", value, "out of range", remedy));
        }
        if request.slots > MOST_SLOTS || request.holding.len() > MOST_SLOTS as usize {
            let remedy = "give at most 4096 slots";
            return Err(AppError::field("request", "slots", request.slots, "out of range", remedy));
        }
        let deadline =
            tokio::time::Instant::now() + Duration::from_secs_f64(request.wait_seconds).min(LONGEST_WAIT);
        let mut work = self.0.work.subscribe();
        loop {
            work.mark_unchanged();
            let grants = self.try_claim(&request).await?;
            if !grants.is_empty() || request.slots == 0 {
                return Ok(ClaimResponse { grants, retry_seconds: 0.0 });
            }
            let now = tokio::time::Instant::now();
            if now >= deadline || self.stopping().is_cancelled() {
                let retry_seconds = self.config().heartbeat_seconds.min(5.0);
                return Ok(ClaimResponse { grants, retry_seconds });
            }
            let pause = (deadline - now).min(LOOK_AGAIN);
            tokio::select! {
                _ = work.changed() => {}
                () = tokio::time::sleep(pause) => {}
                () = self.stopping().cancelled() => {}
            }
        }
    }

    async fn try_claim(&self, request: &ClaimRequest) -> AppResult<Vec<Grant>> {
        let unknown = || AppError::NotFound { what: "worker", id: request.worker.to_string() };
        let now = self.now();
        let worker = self.store().worker(request.worker).await?.ok_or_else(unknown)?;
        self.beats().seen(request.worker, now);
        // Only a claim that can succeed takes the writer's time.
        let forgotten = worker.leases as usize > request.holding.len();
        if !forgotten && !self.store().claimable(&worker.models, now).await? {
            return Ok(Vec::new());
        }
        let claim = Claim { worker: request.worker, slots: request.slots, holding: request.holding.clone() };
        let granted = self
            .0
            .claims
            .claim(claim)
            .await
            .map_err(|error| AppError::Unavailable(error.to_string()))?
            .ok_or_else(unknown)?;
        self.metrics().claims.inc_by(granted.len() as u64);
        Ok(granted.into_iter().map(grant).collect())
    }
}

fn grant(granted: Granted) -> Grant {
    Grant {
        job: granted.job,
        attempt: granted.attempt,
        reduced: granted.reduced,
        scene_key: granted.scene_key,
        checkpoint: granted.checkpoint,
    }
}
