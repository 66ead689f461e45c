//! Sweeps, results and analysis, for people and scripts.

use std::time::Duration;

use bytes::Bytes;
use reqwest::Method;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::error::Route;
use super::transport::{Body, Call};
use super::{Client, ClientError};

impl Client {
    /// `GET path`, the answer read as JSON.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn get<T: DeserializeOwned>(&self, path: &str) -> Result<T, ClientError> {
        let mut call = Call::new(Method::GET, path.to_owned(), Route::Other);
        call.accept = Some("application/json");
        self.send_for(call).await
    }

    /// `GET path`, the answer as it comes (CSV, SVG, …).
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn get_bytes(&self, path: &str) -> Result<Bytes, ClientError> {
        self.send(Call::new(Method::GET, path.to_owned(), Route::Other).within(Duration::from_secs(120)))
            .await
    }

    /// `POST path` with `body` as JSON (`None`: no body).
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn post<T: DeserializeOwned>(
        &self,
        path: &str,
        body: Option<&Value>,
    ) -> Result<T, ClientError> {
        let mut call = Call::new(Method::POST, path.to_owned(), Route::Other);
        if let Some(body) = body {
            call = call.json(body)?;
        }
        self.send_for(call).await
    }

    /// `POST /v1/sweeps` with an idempotency key: the same key and definition again is the same sweep.
    ///
    /// # Errors
    /// [`ClientError`]; [`ClientError::FixInput`] lists every wrong field.
    pub async fn submit<T: DeserializeOwned>(
        &self,
        definition: &[u8],
        idempotency_key: &str,
    ) -> Result<T, ClientError> {
        let mut call = Call::new(Method::POST, "/v1/sweeps".to_owned(), Route::Other);
        call.body = Body::Json(Bytes::copy_from_slice(definition));
        call.headers.push(("Idempotency-Key", idempotency_key.to_owned()));
        self.send_for(call.within(Duration::from_secs(120))).await
    }
}
