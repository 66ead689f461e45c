//! What handlers take from a request, with every refusal a problem document.

use std::str::FromStr;

use axum::body::{Body, Bytes};
use axum::extract::{FromRequestParts, Path, Query};
use axum::http::HeaderMap;
use axum::http::header::{CONTENT_LENGTH, CONTENT_TYPE};
use axum::http::request::Parts;
use futures_util::StreamExt;
use protocol::FieldProblem;
use serde::de::DeserializeOwned;

use super::problem::Problem;
use crate::error::{AppError, AppResult};

/// Of a body that is too large, so much is read and thrown away before the answer, so that the client sees it.
const DRAINED: u64 = 1 << 30;

/// Query parameters.
pub(super) struct Params<T>(pub T);

impl<S: Sync, T: DeserializeOwned> FromRequestParts<S> for Params<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        match Query::<T>::try_from_uri(&parts.uri) {
            Ok(Query(query)) => Ok(Self(query)),
            Err(rejection) => {
                let text = rejection.body_text();
                let text = text.trim_start_matches("Failed to deserialize query string: ").to_owned();
                let value = parts.uri.query().unwrap_or_default();
                let remedy = "GET /docs lists the parameters of every route";
                // serde names the parameter before the colon.
                let (field, problem) = text.split_once(": ").unwrap_or(("query", text.as_str()));
                Err(AppError::field("query", field, format!("{value:.200}"), problem, remedy).into())
            }
        }
    }
}

/// The id in the path.
pub(super) struct Id<T>(pub T);

impl<S: Send + Sync, T: FromStr + Send> FromRequestParts<S> for Id<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let bug = |error: &dyn std::fmt::Display| AppError::Bug(format!("route without id: {error}"));
        let Path(text) =
            Path::<String>::from_request_parts(parts, state).await.map_err(|error| bug(&error))?;
        let what = parts.uri.path().trim_start_matches("/v1/").split('/').next().unwrap_or_default();
        let what = match what {
            "sweeps" => "sweep",
            "jobs" | "leases" => "job",
            _ => "such id:",
        };
        let missing = |_| AppError::NotFound { what, id: format!("{text:.80?}") };
        Ok(Self(text.parse().map_err(missing)?))
    }
}

/// Reads a body of at most `limit` bytes.
pub(super) async fn body(headers: &HeaderMap, body: Body, limit: u64) -> AppResult<Bytes> {
    let announced = headers
        .get(CONTENT_LENGTH)
        .and_then(|value| value.to_str().ok())
        .and_then(|text| text.parse::<u64>().ok());
    let mut too_large = announced.is_some_and(|length| length > limit);
    let mut bytes = Vec::new();
    let mut seen = 0_u64;
    let mut stream = body.into_data_stream();
    while let Some(chunk) = stream.next().await {
        let chunk = chunk.map_err(|error| AppError::Unavailable(format!("the body broke off: {error}")))?;
        seen += chunk.len() as u64;
        too_large |= seen > limit;
        if !too_large {
            bytes.extend_from_slice(&chunk);
        } else {
            bytes = Vec::new();
            if seen > DRAINED {
                break;
            }
        }
    }
    if too_large { Err(AppError::TooLarge { limit }) } else { Ok(bytes.into()) }
}

/// Refuses a body that is not announced as JSON. One without any media type is taken for JSON.
pub(super) fn expect_json(headers: &HeaderMap) -> AppResult<()> {
    let Some(kind) = headers.get(CONTENT_TYPE) else { return Ok(()) };
    let found = String::from_utf8_lossy(kind.as_bytes()).to_ascii_lowercase();
    let essence = found.split(';').next().unwrap_or_default().trim();
    if essence == "application/json" || (essence.starts_with("application/") && essence.ends_with("+json")) {
        return Ok(());
    }
    Err(AppError::MediaType {
        found: format!("{found:.100}"),
        expected: "application/json (with curl: -H 'Content-Type: application/json')",
    })
}

/// Reads a JSON document; a mistake is told with its field path.
pub(super) async fn json<T: DeserializeOwned>(
    headers: &HeaderMap,
    content: Body,
    limit: u64,
) -> AppResult<T> {
    expect_json(headers)?;
    let bytes = body(headers, content, limit).await?;
    // Result documents can be large: parse off the async threads.
    if bytes.len() > 1 << 20
        && let Ok(handle) = tokio::runtime::Handle::try_current()
        && handle.runtime_flavor() == tokio::runtime::RuntimeFlavor::MultiThread
    {
        return tokio::task::block_in_place(|| parse(&bytes));
    }
    parse(&bytes)
}

fn parse<T: DeserializeOwned>(bytes: &[u8]) -> AppResult<T> {
    let reader = &mut serde_json::Deserializer::from_slice(bytes);
    let parsed: Result<T, _> = serde_path_to_error::deserialize(&mut *reader);
    let (path, error) = match parsed {
        Ok(value) => match reader.end() {
            Ok(()) => return Ok(value),
            Err(error) => (String::new(), error),
        },
        Err(error) => (error.path().to_string(), error.into_inner()),
    };
    let field = FieldProblem {
        field: if path == "." { String::new() } else { path },
        value: excerpt(bytes, &error),
        problem: error.to_string(),
        remedy: "GET /docs shows the document this route takes".to_owned(),
    };
    Err(match error.classify() {
        serde_json::error::Category::Data => AppError::Invalid { what: "request", fields: vec![field] },
        _ => AppError::Malformed(vec![field]),
    })
}

/// What stands where the parser stopped.
fn excerpt(bytes: &[u8], error: &serde_json::Error) -> String {
    let line = bytes.split(|&byte| byte == b'\n').nth(error.line().saturating_sub(1)).unwrap_or_default();
    let end = error.column().min(line.len());
    let start = end.saturating_sub(30);
    String::from_utf8_lossy(&line[start..end]).into_owned()
}

/// The idempotency key of a request.
pub(super) fn idempotency_key(headers: &HeaderMap) -> AppResult<Option<String>> {
    let Some(value) = headers.get("idempotency-key") else { return Ok(None) };
    let text = value.to_str().unwrap_or_default();
    if text.is_empty() || text.len() > 255 {
        let remedy = "give 1 to 255 printable ASCII characters, for example a UUID";
        let value = format!("{:.40?}", String::from_utf8_lossy(value.as_bytes()));
        return Err(AppError::field("request", "Idempotency-Key", value, "is not usable", remedy));
    }
    Ok(Some(text.to_owned()))
}

/// Entries per page: `default` when absent, refused outside of 1 … `most`.
pub(super) fn limit(asked: Option<u32>, default: u32, most: u32) -> AppResult<u32> {
    match asked {
        None => Ok(default),
        Some(asked) if (1..=most).contains(&asked) => Ok(asked),
        Some(asked) => {
            let remedy = format!("give 1 to {most}, and follow `next` for more");
            Err(AppError::field("query", "limit", asked, "is out of range", &remedy))
        }
    }
}

/// A cursor: opaque to callers, a number inside.
pub(super) fn cursor<T: FromStr>(given: Option<&str>) -> AppResult<Option<T>> {
    let Some(text) = given else { return Ok(None) };
    let wrong = |_| {
        let remedy = "give `next` of the page before, unchanged";
        AppError::field("query", "cursor", format!("{text:.80?}"), "is no cursor of this list", remedy)
    };
    text.parse().map(Some).map_err(wrong)
}
