//! Errors of the client, typed by what the caller can do.

use std::time::Duration;

use reqwest::StatusCode;
use reqwest::header::{HeaderMap, RETRY_AFTER};

use crate::ProblemDocument;

/// Why a call did not succeed.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// The request is wrong: fix the input.
    #[error("{}", summary(.0))]
    FixInput(Box<ProblemDocument>),
    /// The coordinator cannot be reached or asks for patience: the same request may succeed later.
    #[error("the coordinator does not answer: {what}")]
    Retry {
        /// What was seen.
        what: String,
        /// When the coordinator wants to be asked again.
        retry_after: Option<Duration>,
    },
    /// The attempt is no longer current: forget the job.
    #[error("the lease is lost: {0}")]
    LeaseLost(String),
    /// No repetition helps: wrong token, wrong protocol version, an answer that makes no sense.
    #[error("{0}")]
    GiveUp(String),
}

/// Whether a route belongs to a lease, where 404, 409 and 410 mean that the attempt is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Route {
    Lease,
    Other,
}

impl ClientError {
    /// Whether asking again may help.
    #[must_use]
    pub fn is_transient(&self) -> bool {
        matches!(self, Self::Retry { .. })
    }

    /// The request did not get an answer.
    pub(super) fn unanswered(error: &reqwest::Error) -> Self {
        let mut what = error.to_string();
        let mut cause = std::error::Error::source(error);
        while let Some(inner) = cause {
            what = format!("{what}: {inner}");
            cause = inner.source();
        }
        if error.is_builder() { Self::GiveUp(what) } else { Self::Retry { what, retry_after: None } }
    }

    /// The request got an answer other than success.
    pub(super) fn answered(status: StatusCode, headers: &HeaderMap, body: &[u8], route: Route) -> Self {
        let problem = problem_of(status, body);
        match status.as_u16() {
            404 | 409 | 410 if route == Route::Lease => Self::LeaseLost(summary(&problem)),
            401 | 403 | 426 => Self::GiveUp(summary(&problem)),
            408 | 425 | 429 | 500..=599 => {
                Self::Retry { what: summary(&problem), retry_after: retry_after(headers) }
            }
            400..=499 => Self::FixInput(Box::new(problem)),
            _ => Self::GiveUp(format!("unexpected answer: {}", summary(&problem))),
        }
    }
}

/// `Retry-After` in seconds; the date form is not used by the coordinator.
fn retry_after(headers: &HeaderMap) -> Option<Duration> {
    let seconds = headers.get(RETRY_AFTER)?.to_str().ok()?.trim().parse::<u64>().ok()?;
    Some(Duration::from_secs(seconds))
}

/// The problem document of an answer; something between us and the coordinator may have answered without one.
fn problem_of(status: StatusCode, body: &[u8]) -> ProblemDocument {
    serde_json::from_slice(body).unwrap_or_else(|_| ProblemDocument {
        kind: "about:blank".to_owned(),
        title: status.canonical_reason().unwrap_or("no title").to_owned(),
        status: status.as_u16(),
        detail: Some(String::from_utf8_lossy(&body[..body.len().min(300)]).trim().to_owned())
            .filter(|text| !text.is_empty()),
        errors: Vec::new(),
        retryable: false,
    })
}

fn summary(problem: &ProblemDocument) -> String {
    let mut text = format!("{} ({})", problem.title, problem.status);
    if let Some(detail) = &problem.detail {
        text = format!("{text}: {detail}");
    }
    for one in &problem.errors {
        text = format!("{text}; {} = {}: {} ({})", one.field, one.value, one.problem, one.remedy);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn classify(status: u16, route: Route) -> ClientError {
        let mut headers = HeaderMap::new();
        headers.insert(RETRY_AFTER, "7".parse().unwrap());
        ClientError::answered(StatusCode::from_u16(status).unwrap(), &headers, b"", route)
    }

    #[test]
    fn statuses_become_what_the_caller_can_do() {
        for status in [404, 409, 410] {
            assert!(matches!(classify(status, Route::Lease), ClientError::LeaseLost(_)), "{status}");
            assert!(matches!(classify(status, Route::Other), ClientError::FixInput(_)), "{status}");
        }
        for status in [401, 403, 426] {
            assert!(matches!(classify(status, Route::Lease), ClientError::GiveUp(_)), "{status}");
        }
        for status in [408, 429, 500, 502, 503, 507] {
            let error = classify(status, Route::Other);
            assert!(
                matches!(error, ClientError::Retry { retry_after: Some(after), .. } if after.as_secs() == 7),
                "{status}: {error}"
            );
        }
    }

    #[test]
    fn a_problem_document_is_told_field_by_field() {
        let body = br#"{"type":"urn:tamp:invalid-sweep","title":"invalid sweep","status":422,
            "errors":[{"field":"base.p","value":"-1","problem":"not positive","remedy":"give a pressure in Pa"}]}"#;
        let error =
            ClientError::answered(StatusCode::UNPROCESSABLE_ENTITY, &HeaderMap::new(), body, Route::Other);
        let text = error.to_string();
        assert!(text.contains("base.p = -1: not positive (give a pressure in Pa)"), "{text}");
    }
}
