//! Errors as problem documents (RFC 9457): the one place that knows status codes.

use std::any::Any;

use axum::body::Body;
use axum::extract::Request;
use axum::http::header::{CONTENT_TYPE, RETRY_AFTER, UPGRADE, WWW_AUTHENTICATE};
use axum::http::{HeaderName, HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use protocol::{FieldProblem, ProblemDocument};

use crate::error::AppError;

/// An error of a handler.
#[derive(Debug)]
pub(super) struct Problem(pub Box<ProblemDocument>);

/// Result of a handler.
pub(super) type Answer<T> = Result<T, Problem>;

impl<E: Into<AppError>> From<E> for Problem {
    fn from(error: E) -> Self {
        describe(error.into())
    }
}

impl Problem {
    pub(super) fn new(status: StatusCode, kind: &str, title: &str, detail: String) -> Self {
        Self(Box::new(ProblemDocument {
            kind: format!("urn:tamp:{kind}"),
            title: title.to_owned(),
            status: status.as_u16(),
            detail: Some(detail),
            errors: Vec::new(),
            retryable: status == StatusCode::SERVICE_UNAVAILABLE,
        }))
    }

    fn with(mut self, errors: Vec<FieldProblem>) -> Self {
        self.0.errors = errors;
        self
    }
}

fn describe(error: AppError) -> Problem {
    let text = error.to_string();
    match error {
        AppError::Invalid { what, fields } => {
            let (status, kind, title) = match what {
                "sweep" => {
                    (StatusCode::UNPROCESSABLE_ENTITY, "invalid-sweep", "the sweep definition has mistakes")
                }
                "result" => (StatusCode::UNPROCESSABLE_ENTITY, "invalid-result", "the result has mistakes"),
                "query" => (StatusCode::BAD_REQUEST, "invalid-query", "the query has mistakes"),
                _ => (StatusCode::UNPROCESSABLE_ENTITY, "invalid-request", "the request has mistakes"),
            };
            Problem::new(status, kind, title, text).with(fields)
        }
        AppError::Malformed(fields) => {
            let title = "the body is not JSON";
            Problem::new(StatusCode::BAD_REQUEST, "malformed-json", title, text).with(fields)
        }
        AppError::TooLarge { .. } => {
            Problem::new(StatusCode::PAYLOAD_TOO_LARGE, "body-too-large", "the body is too large", text)
        }
        AppError::MediaType { .. } => Problem::new(
            StatusCode::UNSUPPORTED_MEDIA_TYPE,
            "unsupported-media-type",
            "the body has another media type",
            text,
        ),
        AppError::NotAcceptable { .. } => {
            Problem::new(StatusCode::NOT_ACCEPTABLE, "not-acceptable", "there is no such format", text)
        }
        AppError::NotFound { .. } => {
            Problem::new(StatusCode::NOT_FOUND, "not-found", "there is no such thing", text)
        }
        AppError::Conflict(_) => {
            Problem::new(StatusCode::CONFLICT, "conflict", "the present state does not admit this", text)
        }
        AppError::StaleLease(_) => {
            Problem::new(StatusCode::CONFLICT, "stale-lease", "the lease was lost", text)
        }
        AppError::NotYet(_) => {
            let mut problem = Problem::new(StatusCode::CONFLICT, "not-done", "the run is not done", text);
            problem.0.retryable = true;
            problem
        }
        AppError::KeyReused => Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "idempotency-key-reused",
            "the idempotency key was used for another request",
            text,
        ),
        AppError::Protocol { .. } => {
            Problem::new(StatusCode::UPGRADE_REQUIRED, "protocol-version", "the protocol differs", text)
        }
        AppError::Analysis(_) => Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "analysis-impossible",
            "the analysis cannot be made from these data",
            text,
        ),
        AppError::Unavailable(_) => Problem::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "unavailable",
            "the service cannot answer now",
            text,
        ),
        AppError::Store(_) | AppError::Blob(_) | AppError::Bug(_) => {
            tracing::error!(error = %text, "request failed by the service's fault");
            let detail = "the cause is in the log of the coordinator; nothing was stored by halves";
            let mut problem = internal(detail);
            problem.0.retryable = true;
            problem
        }
    }
}

fn internal(detail: &str) -> Problem {
    let title = "the service failed";
    Problem::new(StatusCode::INTERNAL_SERVER_ERROR, "internal", title, detail.to_owned())
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.0.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let body = serde_json::to_vec(&*self.0).unwrap_or_default();
        let mut response = (status, Body::from(body)).into_response();
        let headers = response.headers_mut();
        headers.insert(CONTENT_TYPE, HeaderValue::from_static("application/problem+json"));
        let extra: Option<(HeaderName, &'static str)> = match status {
            StatusCode::SERVICE_UNAVAILABLE => Some((RETRY_AFTER, "2")),
            StatusCode::UNAUTHORIZED => Some((WWW_AUTHENTICATE, "Bearer realm=\"tamp\"")),
            StatusCode::UPGRADE_REQUIRED => Some((UPGRADE, "tamp")),
            _ => None,
        };
        if let Some((name, value)) = extra {
            headers.insert(name, HeaderValue::from_static(value));
        }
        response
    }
}

/// Nothing is registered under the path.
pub(super) async fn no_route(request: Request) -> Problem {
    let detail = format!("{} leads nowhere; GET /docs lists the routes", request.uri().path());
    Problem::new(StatusCode::NOT_FOUND, "no-route", "there is no such route", detail)
}

/// The path is registered, the method is not.
pub(super) async fn no_method(request: Request) -> Problem {
    let detail = format!(
        "{} does not take {}; the Allow header names the methods, GET /docs lists the routes",
        request.uri().path(),
        request.method()
    );
    Problem::new(
        StatusCode::METHOD_NOT_ALLOWED,
        "method-not-allowed",
        "the route does not take this method",
        detail,
    )
}

/// A handler panicked: a bug, told like every other error.
pub(super) fn panicked(panic: Box<dyn Any + Send + 'static>) -> Response {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("no message");
    tracing::error!(panic = message, "a handler panicked");
    internal("a bug in the service; the cause is in its log").into_response()
}

/// Gives a problem document to any error answer that a library made without one.
pub(super) async fn finish(request: Request, next: Next) -> Response {
    let path = request.uri().path().to_owned();
    let response = next.run(request).await;
    let status = response.status();
    let is_error = status.is_client_error() || status.is_server_error();
    let told = response.headers().get(CONTENT_TYPE).is_some_and(|kind| {
        kind.as_bytes().starts_with(b"application/problem+json")
            || kind.as_bytes().starts_with(b"application/json")
    });
    if !is_error || told {
        return response;
    }
    let title = status.canonical_reason().unwrap_or("error").to_lowercase();
    let problem =
        Problem::new(status, "request-refused", &title, format!("the request to {path} was refused"));
    let (parts, _) = response.into_parts();
    let mut finished = problem.into_response();
    for (name, value) in &parts.headers {
        if *name != CONTENT_TYPE && *name != axum::http::header::CONTENT_LENGTH {
            finished.headers_mut().insert(name, value.clone());
        }
    }
    finished
}
