//! `/v1/leases/{job}`: what the holder of a lease writes. Everything is refused with 409 once the lease is lost.

use axum::Json;
use axum::body::Body;
use axum::extract::State;
use axum::http::header::{CONTENT_TYPE, ETAG};
use axum::http::{HeaderMap, HeaderValue};
use axum::response::{IntoResponse, Response};
use protocol::{
    Accepted, Checkpoint, CheckpointQuery, Completion, Failure, Heartbeat, HeartbeatReply, JobId,
    ProblemDocument, Release, Returned,
};

use super::extract::{Id, Params, body, json};
use super::problem::Answer;
use crate::app::App;

/// The job is alive
#[utoipa::path(put, path = "/v1/leases/{job}", tag = "workers", params(("job" = JobId, Path)),
    request_body = Heartbeat, responses((status = 200, body = HeartbeatReply),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Lease lost")))]
pub(super) async fn heartbeat(
    State(app): State<App>,
    Id(job): Id<JobId>,
    headers: HeaderMap,
    content: Body,
) -> Answer<Json<HeartbeatReply>> {
    let beat: Heartbeat = json(&headers, content, app.config().max_body_bytes).await?;
    Ok(Json(app.heartbeat(job, &beat).await?))
}

/// Store a checkpoint
///
/// The body is the checkpoint as raw bytes. It renews the lease.
#[utoipa::path(put, path = "/v1/leases/{job}/checkpoint", tag = "workers",
    params(("job" = JobId, Path), CheckpointQuery),
    request_body(content = Vec<u8>, content_type = "application/octet-stream"),
    responses((status = 200, body = Checkpoint),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Lease lost"),
        (status = 413, body = ProblemDocument, content_type = "application/problem+json", description = "Too large")))]
pub(super) async fn put_checkpoint(
    State(app): State<App>,
    Id(job): Id<JobId>,
    Params(query): Params<CheckpointQuery>,
    headers: HeaderMap,
    content: Body,
) -> Answer<Json<Checkpoint>> {
    let bytes = body(&headers, content, app.config().max_checkpoint_bytes).await?;
    Ok(Json(app.put_checkpoint(job, &query, bytes).await?))
}

/// The newest checkpoint, as raw bytes; its BLAKE3 hash is the ETag
#[utoipa::path(get, path = "/v1/leases/{job}/checkpoint", tag = "workers",
    params(("job" = JobId, Path), CheckpointQuery),
    responses((status = 200, body = Vec<u8>, content_type = "application/octet-stream"),
        (status = 404, body = ProblemDocument, content_type = "application/problem+json", description = "None"),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Lease lost")))]
pub(super) async fn get_checkpoint(
    State(app): State<App>,
    Id(job): Id<JobId>,
    Params(query): Params<CheckpointQuery>,
) -> Answer<Response> {
    let (checkpoint, bytes) = app.get_checkpoint(job, &query).await?;
    let mut response = bytes.into_response();
    let headers = response.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static("application/octet-stream"));
    headers.insert("x-tamp-steps", HeaderValue::from(checkpoint.steps));
    if let Ok(tag) = HeaderValue::from_str(&format!("\"{}\"", checkpoint.hash)) {
        headers.insert(ETAG, tag);
    }
    Ok(response)
}

/// Store the result of a run
///
/// The same bytes twice are one result. Different bytes for one scene on one hardware class are a determinism alarm:
/// both are kept and shown.
#[utoipa::path(post, path = "/v1/leases/{job}/result", tag = "workers", params(("job" = JobId, Path)),
    request_body = Completion, responses((status = 200, body = Accepted),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Lease lost"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Mistakes in the result")))]
pub(super) async fn result(
    State(app): State<App>,
    Id(job): Id<JobId>,
    headers: HeaderMap,
    content: Body,
) -> Answer<Json<Accepted>> {
    let completion: Completion = json(&headers, content, app.config().max_result_bytes).await?;
    Ok(Json(app.complete(job, completion).await?))
}

/// The run failed
#[utoipa::path(post, path = "/v1/leases/{job}/failure", tag = "workers", params(("job" = JobId, Path)),
    request_body = Failure, responses((status = 200, body = Returned),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Lease lost")))]
pub(super) async fn failure(
    State(app): State<App>,
    Id(job): Id<JobId>,
    headers: HeaderMap,
    content: Body,
) -> Answer<Json<Returned>> {
    let failure: Failure = json(&headers, content, app.config().max_body_bytes).await?;
    Ok(Json(app.fail(job, failure).await?))
}

/// Give a job back unharmed
#[utoipa::path(post, path = "/v1/leases/{job}/release", tag = "workers", params(("job" = JobId, Path)),
    request_body = Release, responses((status = 200, body = Returned),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Lease lost")))]
pub(super) async fn release(
    State(app): State<App>,
    Id(job): Id<JobId>,
    headers: HeaderMap,
    content: Body,
) -> Answer<Json<Returned>> {
    let release: Release = json(&headers, content, app.config().max_body_bytes).await?;
    Ok(Json(app.release(job, &release).await?))
}
