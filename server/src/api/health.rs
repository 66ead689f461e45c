//! Liveness, readiness, metrics.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::IntoResponse;
use protocol::{PROTOCOL_VERSION, ProblemDocument};
use serde::Serialize;
use utoipa::ToSchema;

use super::problem::{Answer, Problem};
use crate::app::App;

/// The process answers.
#[derive(Serialize, ToSchema)]
pub(super) struct Alive {
    status: &'static str,
    /// Version of the coordinator.
    version: &'static str,
    /// Version of the worker protocol.
    protocol: u32,
}

/// Whether the process answers
#[utoipa::path(get, path = "/healthz", tag = "service", responses((status = 200, body = Alive)))]
pub(super) async fn healthz() -> Json<Alive> {
    Json(Alive { status: "ok", version: env!("CARGO_PKG_VERSION"), protocol: PROTOCOL_VERSION })
}

/// Whether the service can work: the database reads and writes, and it is not stopping
#[utoipa::path(get, path = "/readyz", tag = "service", responses((status = 200, body = Alive),
    (status = 503, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn readyz(State(app): State<App>) -> Answer<Json<Alive>> {
    let refused = |why: &str| {
        Problem::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "not-ready",
            "the service cannot work now",
            why.to_owned(),
        )
    };
    if app.stopping().is_cancelled() {
        return Err(refused("the service is stopping"));
    }
    let health = app.store().health().await;
    if !health.reads {
        return Err(refused("the database does not read"));
    }
    if !health.writes {
        return Err(refused("the database does not write"));
    }
    Ok(healthz().await)
}

/// Metrics for Prometheus
#[utoipa::path(get, path = "/metrics", tag = "service",
    responses((status = 200, body = String, content_type = "application/openmetrics-text")))]
pub(super) async fn metrics(State(app): State<App>) -> Answer<impl IntoResponse> {
    let totals = app.store().totals().await?;
    let workers = app.workers_alive().await?;
    let text = app
        .metrics()
        .text(&totals, workers)
        .map_err(|error| crate::error::AppError::Bug(format!("metrics: {error}")))?;
    Ok(([(CONTENT_TYPE, "application/openmetrics-text; version=1.0.0; charset=utf-8")], text))
}
