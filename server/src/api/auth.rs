//! The bearer token, when one is configured. Compared in constant time, by hashes.

use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::http::header::AUTHORIZATION;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::problem::Problem;
use crate::app::App;

/// Refuses requests under `/v1` without the token. Health, metrics and the description are open.
pub(super) async fn require_token(State(app): State<App>, request: Request, next: Next) -> Response {
    let Some(expected) = &app.config().token else { return next.run(request).await };
    if !request.uri().path().starts_with("/v1") {
        return next.run(request).await;
    }
    let given = request
        .headers()
        .get(AUTHORIZATION)
        .and_then(|value| value.to_str().ok())
        .and_then(|value| value.split_once(' '))
        .filter(|(scheme, _)| scheme.eq_ignore_ascii_case("bearer"))
        .map(|(_, token)| token.trim());
    // `blake3::Hash` compares in constant time.
    let admitted =
        given.is_some_and(|given| blake3::hash(given.as_bytes()) == blake3::hash(expected.trim().as_bytes()));
    if admitted {
        return next.run(request).await;
    }
    let detail = match given {
        None => "send `Authorization: Bearer TOKEN`",
        Some(_) => "the token is not the one of this coordinator",
    };
    Problem::new(StatusCode::UNAUTHORIZED, "unauthorized", "a token is asked for", detail.to_owned())
        .into_response()
}
