//! `/v1/workers` and `/v1/claims`.

use axum::Json;
use axum::body::Body;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use protocol::api::{Page, PageQuery, WorkerView};
use protocol::{ClaimRequest, ClaimResponse, ProblemDocument, Registered, Registration};

use super::extract::{Params, cursor, json, limit};
use super::problem::Answer;
use crate::app::App;

/// Introduce a worker process
///
/// The same host and boot get the same id again.
#[utoipa::path(post, path = "/v1/workers", tag = "workers", request_body = Registration,
    responses((status = 201, body = Registered),
        (status = 426, body = ProblemDocument, content_type = "application/problem+json", description = "Another protocol")))]
pub(super) async fn register(
    State(app): State<App>,
    headers: HeaderMap,
    content: Body,
) -> Answer<(StatusCode, Json<Registered>)> {
    let registration: Registration = json(&headers, content, app.config().max_body_bytes).await?;
    Ok((StatusCode::CREATED, Json(app.register(&registration).await?)))
}

/// List workers, newest first
#[utoipa::path(get, path = "/v1/workers", tag = "workers", params(PageQuery),
    responses((status = 200, body = Page<WorkerView>)))]
pub(super) async fn list(
    State(app): State<App>,
    Params(query): Params<PageQuery>,
) -> Answer<Json<Page<WorkerView>>> {
    let before = cursor(query.cursor.as_deref())?;
    Ok(Json(app.workers(before, limit(query.limit, 50, 500)?).await?))
}

/// Ask for jobs
///
/// Waits up to `wait_seconds` (at most 60) while there is none. Jobs the worker holds but does not name in `holding`
/// are granted again first, under the same attempt; so ask for one claim at a time.
#[utoipa::path(post, path = "/v1/claims", tag = "workers", request_body = ClaimRequest,
    responses((status = 200, body = ClaimResponse),
        (status = 404, body = ProblemDocument, content_type = "application/problem+json", description = "Not registered: register again")))]
pub(super) async fn claim(
    State(app): State<App>,
    headers: HeaderMap,
    content: Body,
) -> Answer<Json<ClaimResponse>> {
    let request: ClaimRequest = json(&headers, content, app.config().max_body_bytes).await?;
    Ok(Json(app.claim(request).await?))
}
