//! The worker protocol.

use std::time::Duration;

use bytes::Bytes;
use reqwest::Method;

use super::error::Route;
use super::transport::Call;
use super::{Client, ClientError};
use crate::{
    ClaimRequest, ClaimResponse, Completion, Failure, Heartbeat, HeartbeatReply, JobId, Registered,
    Registration, Release, WorkerId,
};

/// Time for a body of many megabytes on a slow line.
const LARGE: Duration = Duration::from_secs(600);

impl Client {
    /// `POST /v1/workers`.
    ///
    /// # Errors
    /// [`ClientError`]; a refused protocol version or token is [`ClientError::GiveUp`].
    pub async fn register(&self, registration: &Registration) -> Result<Registered, ClientError> {
        self.send_for(Call::new(Method::POST, "/v1/workers".to_owned(), Route::Other).json(registration)?)
            .await
    }

    /// `POST /v1/claims`: long poll for up to `request.wait_seconds`.
    ///
    /// # Errors
    /// [`ClientError`]; a worker the coordinator does not know is [`ClientError::FixInput`]: register again.
    pub async fn claim(&self, request: &ClaimRequest) -> Result<ClaimResponse, ClientError> {
        let patience = Duration::from_secs_f64(request.wait_seconds.clamp(0.0, 3600.0) + 15.0);
        let call = Call::new(Method::POST, "/v1/claims".to_owned(), Route::Other).json(request)?;
        self.send_for(call.within(patience)).await
    }

    /// `PUT /v1/leases/{job}`: the job is alive.
    ///
    /// # Errors
    /// [`ClientError`]; [`ClientError::LeaseLost`] when the attempt is no longer current.
    pub async fn heartbeat(&self, job: JobId, beat: &Heartbeat) -> Result<HeartbeatReply, ClientError> {
        self.send_for(lease(Method::PUT, job, "").json(beat)?.within(Duration::from_secs(10))).await
    }

    /// `PUT /v1/leases/{job}/checkpoint?worker=…&attempt=…&steps=…`: the bytes as they are.
    ///
    /// # Errors
    /// [`ClientError`]; [`ClientError::LeaseLost`] when the attempt is no longer current.
    pub async fn put_checkpoint(
        &self,
        job: JobId,
        worker: WorkerId,
        attempt: u32,
        steps: u64,
        bytes: Bytes,
    ) -> Result<(), ClientError> {
        let tail = format!("/checkpoint?worker={worker}&attempt={attempt}&steps={steps}");
        self.send(lease(Method::PUT, job, &tail).octets(bytes).within(LARGE)).await?;
        Ok(())
    }

    /// `GET /v1/leases/{job}/checkpoint?attempt=…`: the newest checkpoint.
    ///
    /// # Errors
    /// [`ClientError`]; [`ClientError::LeaseLost`] also when there is no checkpoint.
    pub async fn get_checkpoint(
        &self,
        job: JobId,
        worker: WorkerId,
        attempt: u32,
    ) -> Result<Bytes, ClientError> {
        let tail = format!("/checkpoint?worker={worker}&attempt={attempt}");
        self.send(lease(Method::GET, job, &tail).within(LARGE)).await
    }

    /// `POST /v1/leases/{job}/result`.
    ///
    /// # Errors
    /// [`ClientError`]; [`ClientError::LeaseLost`] when the attempt is no longer current.
    pub async fn complete(&self, job: JobId, completion: &Completion) -> Result<(), ClientError> {
        self.send(lease(Method::POST, job, "/result").json(completion)?.within(LARGE)).await?;
        Ok(())
    }

    /// `POST /v1/leases/{job}/failure`.
    ///
    /// # Errors
    /// [`ClientError`]; [`ClientError::LeaseLost`] when the attempt is no longer current.
    pub async fn fail(&self, job: JobId, failure: &Failure) -> Result<(), ClientError> {
        self.send(lease(Method::POST, job, "/failure").json(failure)?).await?;
        Ok(())
    }

    /// `POST /v1/leases/{job}/release`.
    ///
    /// # Errors
    /// [`ClientError`]; [`ClientError::LeaseLost`] when the attempt is no longer current.
    pub async fn release(&self, job: JobId, release: &Release) -> Result<(), ClientError> {
        self.send(lease(Method::POST, job, "/release").json(release)?).await?;
        Ok(())
    }
}

fn lease(method: Method, job: JobId, tail: &str) -> Call {
    Call::new(method, format!("/v1/leases/{job}{tail}"), Route::Lease)
}
