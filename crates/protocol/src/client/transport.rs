//! One request, repeated while that may help.

use std::time::Duration;

use backon::Retryable;
use bytes::Bytes;
use reqwest::Method;
use reqwest::header::{ACCEPT, CONTENT_TYPE, HeaderValue};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::error::Route;
use super::{ClientError, Patience};

/// Time for one answer, unless the call knows better.
const ANSWER: Duration = Duration::from_secs(30);

/// The client of one coordinator. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Client {
    http: reqwest::Client,
    base: String,
    token: Option<String>,
    patience: Patience,
}

/// The client cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The address of the coordinator is not a URL.
    #[error("server = {0:?}: not the address of a coordinator (write http://HOST:PORT or https://HOST)")]
    Address(String),
    /// The token holds characters that no header can carry.
    #[error("token: holds characters that cannot be sent in a header (use printable ASCII)")]
    Token,
    /// TLS or the resolver could not be set up.
    #[error("http client: {0}")]
    Http(#[from] reqwest::Error),
}

/// What a request carries.
#[derive(Clone, Debug)]
pub(super) enum Body {
    None,
    Json(Bytes),
    Octets(Bytes),
}

/// One request, complete.
#[derive(Clone, Debug)]
pub(super) struct Call {
    pub method: Method,
    pub path: String,
    pub body: Body,
    pub route: Route,
    pub accept: Option<&'static str>,
    pub headers: Vec<(&'static str, String)>,
    pub answer_within: Duration,
}

impl Call {
    pub(super) fn new(method: Method, path: String, route: Route) -> Self {
        Self {
            method,
            path,
            body: Body::None,
            route,
            accept: None,
            headers: Vec::new(),
            answer_within: ANSWER,
        }
    }

    /// Carries `value` as JSON.
    pub(super) fn json<T: Serialize>(mut self, value: &T) -> Result<Self, ClientError> {
        let text = serde_json::to_vec(value)
            .map_err(|error| ClientError::GiveUp(format!("cannot write the request as JSON: {error}")))?;
        self.body = Body::Json(Bytes::from(text));
        Ok(self)
    }

    pub(super) fn octets(mut self, bytes: Bytes) -> Self {
        self.body = Body::Octets(bytes);
        self
    }

    pub(super) fn within(mut self, time: Duration) -> Self {
        self.answer_within = time;
        self
    }
}

impl Client {
    /// A client of the coordinator at `server`, for example `http://127.0.0.1:8300`.
    ///
    /// # Errors
    /// [`BuildError`] when the address or the token cannot be used.
    pub fn new(server: &str, token: Option<String>, patience: Patience) -> Result<Self, BuildError> {
        let base = server.trim_end_matches('/').to_owned();
        let url = reqwest::Url::parse(&base).map_err(|_| BuildError::Address(server.to_owned()))?;
        if !matches!(url.scheme(), "http" | "https") || url.host_str().is_none() {
            return Err(BuildError::Address(server.to_owned()));
        }
        if let Some(token) = &token
            && HeaderValue::from_str(&format!("Bearer {token}")).is_err()
        {
            return Err(BuildError::Token);
        }
        // The process may have chosen a provider before: then that one stays.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let http = reqwest::Client::builder()
            .connect_timeout(Duration::from_secs(10))
            .pool_idle_timeout(Duration::from_secs(30))
            .build()?;
        Ok(Self { http, base, token, patience })
    }

    /// The same client with another patience.
    #[must_use]
    pub fn with_patience(&self, patience: Patience) -> Self {
        Self { patience, ..self.clone() }
    }

    /// Address of the coordinator.
    #[must_use]
    pub fn server(&self) -> &str {
        &self.base
    }

    /// Sends `call` until it is answered, refused, or patience ends.
    pub(super) async fn send(&self, call: Call) -> Result<Bytes, ClientError> {
        let once = || async { self.send_once(&call).await };
        once.retry(self.patience.backoff())
            .when(ClientError::is_transient)
            .adjust(|error, wait| match error {
                ClientError::Retry { retry_after: Some(asked), .. } => wait.map(|wait| wait.max(*asked)),
                _ => wait,
            })
            .notify(|error, wait| {
                tracing::debug!(path = call.path, wait_s = wait.as_secs_f64(), %error, "asking again");
            })
            .await
    }

    /// [`send`](Self::send), and the answer read as JSON.
    pub(super) async fn send_for<T: DeserializeOwned>(&self, call: Call) -> Result<T, ClientError> {
        let path = call.path.clone();
        let body = self.send(call).await?;
        serde_json::from_slice(&body)
            .map_err(|error| ClientError::GiveUp(format!("{path}: the answer makes no sense: {error}")))
    }

    async fn send_once(&self, call: &Call) -> Result<Bytes, ClientError> {
        let url = format!("{}{}", self.base, call.path);
        let mut request = self.http.request(call.method.clone(), url).timeout(call.answer_within);
        if let Some(token) = &self.token {
            request = request.bearer_auth(token);
        }
        if let Some(accept) = call.accept {
            request = request.header(ACCEPT, accept);
        }
        for (name, value) in &call.headers {
            request = request.header(*name, value);
        }
        request = match &call.body {
            Body::None => request,
            Body::Json(text) => request.header(CONTENT_TYPE, "application/json").body(text.clone()),
            Body::Octets(bytes) => {
                request.header(CONTENT_TYPE, "application/octet-stream").body(bytes.clone())
            }
        };
        let answer = request.send().await.map_err(|error| ClientError::unanswered(&error))?;
        let status = answer.status();
        let headers = answer.headers().clone();
        let body = answer.bytes().await.map_err(|error| ClientError::unanswered(&error))?;
        if status.is_success() {
            Ok(body)
        } else {
            Err(ClientError::answered(status, &headers, &body, call.route))
        }
    }
}
