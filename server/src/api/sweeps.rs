//! `/v1/sweeps`.

use axum::Json;
use axum::body::Body;
use axum::extract::State;
use axum::http::header::LOCATION;
use axum::http::{HeaderMap, HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use protocol::api::{ControlReply, DryRun, Page, PointView, SweepState, SweepView};
use protocol::{JobState, ProblemDocument, SweepId};
use serde::Deserialize;
use utoipa::IntoParams;

use super::extract::{Id, Params, body, cursor, expect_json, idempotency_key, limit};
use super::problem::Answer;
use crate::app::{App, Submission, Submitted};
use crate::store::Control;

#[derive(Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
pub(super) struct SubmitQuery {
    /// Count and estimate only; store nothing.
    #[serde(default)]
    dry_run: bool,
}

#[derive(Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
pub(super) struct ListQuery {
    /// Entries per page, 1 to 500 [default: 50].
    limit: Option<u32>,
    /// `next` of the page before.
    cursor: Option<String>,
    /// Only sweeps in this state.
    state: Option<SweepState>,
}

#[derive(Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
pub(super) struct PointsQuery {
    /// Entries per page, 1 to 5000 [default: 500].
    limit: Option<u32>,
    /// `next` of the page before.
    cursor: Option<String>,
    /// Only points whose job is in this state.
    state: Option<JobState>,
}

/// Submit a sweep
///
/// The body is a sweep definition: `name`, `model`, `base`, `blocks` (each a `grid`, a `zip` or a `list`),
/// `replicates`, `where`, `priority`. With `dry_run=true` nothing is stored and the answer (200) is the count and the
/// estimate. A second request with the same `Idempotency-Key` and body gets the first one's sweep.
#[utoipa::path(post, path = "/v1/sweeps", tag = "sweeps", params(SubmitQuery,
        ("Idempotency-Key" = Option<String>, Header, description = "Makes the request safe to repeat")),
    request_body(content = Object, content_type = "application/json"),
    responses(
        (status = 201, body = SweepView, description = "Stored"),
        (status = 200, body = DryRun, description = "Dry run"),
        (status = 400, body = ProblemDocument, content_type = "application/problem+json", description = "Not JSON"),
        (status = 413, body = ProblemDocument, content_type = "application/problem+json", description = "Too large"),
        (status = 415, body = ProblemDocument, content_type = "application/problem+json", description = "Not announced as JSON"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Mistakes in the definition, all of them")
    ))]
pub(super) async fn submit(
    State(app): State<App>,
    Params(query): Params<SubmitQuery>,
    headers: HeaderMap,
    content: Body,
) -> Answer<Response> {
    expect_json(&headers)?;
    let bytes = body(&headers, content, app.config().max_body_bytes).await?.to_vec();
    if query.dry_run {
        return Ok(Json(app.dry_run(bytes).await?).into_response());
    }
    let submission = Submission { body: bytes, idempotency_key: idempotency_key(&headers)? };
    let (sweep, replayed) = match app.submit(submission).await? {
        Submitted::New(sweep) => (sweep, false),
        Submitted::Before(sweep) => (sweep, true),
    };
    let location = format!("/v1/sweeps/{}", sweep.id);
    let mut response = (StatusCode::CREATED, Json(sweep)).into_response();
    if let Ok(location) = HeaderValue::from_str(&location) {
        response.headers_mut().insert(LOCATION, location);
    }
    if replayed {
        response.headers_mut().insert("idempotent-replayed", HeaderValue::from_static("true"));
    }
    Ok(response)
}

/// List sweeps, newest first
#[utoipa::path(get, path = "/v1/sweeps", tag = "sweeps", params(ListQuery),
    responses((status = 200, body = Page<SweepView>)))]
pub(super) async fn list(
    State(app): State<App>,
    Params(query): Params<ListQuery>,
) -> Answer<Json<Page<SweepView>>> {
    let before = cursor(query.cursor.as_deref())?;
    Ok(Json(app.sweeps(query.state, before, limit(query.limit, 50, 500)?).await?))
}

/// State, counts per job state, progress and ETA of a sweep
#[utoipa::path(get, path = "/v1/sweeps/{id}", tag = "sweeps", params(("id" = SweepId, Path)),
    responses((status = 200, body = SweepView),
        (status = 404, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn show(State(app): State<App>, Id(id): Id<SweepId>) -> Answer<Json<SweepView>> {
    Ok(Json(app.sweep(id).await?))
}

/// Give a sweep up
///
/// Jobs that another sweep wants go on; the others are cancelled, and their workers told at the next heartbeat.
#[utoipa::path(post, path = "/v1/sweeps/{id}/cancel", tag = "sweeps", params(("id" = SweepId, Path)),
    responses((status = 200, body = ControlReply),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn cancel(State(app): State<App>, Id(id): Id<SweepId>) -> Answer<Json<ControlReply>> {
    Ok(Json(app.control(id, Control::Cancel).await?))
}

/// Start no new job on behalf of a sweep
///
/// Running jobs that no other sweep wants make a checkpoint and give their place free.
#[utoipa::path(post, path = "/v1/sweeps/{id}/pause", tag = "sweeps", params(("id" = SweepId, Path)),
    responses((status = 200, body = ControlReply),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn pause(State(app): State<App>, Id(id): Id<SweepId>) -> Answer<Json<ControlReply>> {
    Ok(Json(app.control(id, Control::Pause).await?))
}

/// Undo a pause
#[utoipa::path(post, path = "/v1/sweeps/{id}/resume", tag = "sweeps", params(("id" = SweepId, Path)),
    responses((status = 200, body = ControlReply),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn resume(State(app): State<App>, Id(id): Id<SweepId>) -> Answer<Json<ControlReply>> {
    Ok(Json(app.control(id, Control::Resume).await?))
}

/// Queue again what was set aside or cancelled
#[utoipa::path(post, path = "/v1/sweeps/{id}/retry", tag = "sweeps", params(("id" = SweepId, Path)),
    responses((status = 200, body = ControlReply),
        (status = 404, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn retry(State(app): State<App>, Id(id): Id<SweepId>) -> Answer<Json<ControlReply>> {
    Ok(Json(app.control(id, Control::Retry).await?))
}

/// Points of a sweep with their jobs, in the sweep's order
#[utoipa::path(get, path = "/v1/sweeps/{id}/points", tag = "sweeps",
    params(("id" = SweepId, Path), PointsQuery), responses((status = 200, body = Page<PointView>)))]
pub(super) async fn points(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<PointsQuery>,
) -> Answer<Json<Page<PointView>>> {
    let after = cursor(query.cursor.as_deref())?;
    Ok(Json(app.points(id, query.state, after, limit(query.limit, 500, 5_000)?).await?))
}
