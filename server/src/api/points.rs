//! `/v1/points`.

use axum::Json;
use axum::extract::{Path, State};
use protocol::ProblemDocument;
use protocol::api::Explanation;

use super::problem::Answer;
use crate::app::App;

/// Why a run is, or is not, taken from the store
#[utoipa::path(get, path = "/v1/points/{key}/explain", tag = "jobs",
    params(("key" = String, Path, description = "scene key: 32 hex digits")),
    responses((status = 200, body = Explanation),
        (status = 400, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn explain(State(app): State<App>, Path(key): Path<String>) -> Answer<Json<Explanation>> {
    Ok(Json(app.explain(&key).await?))
}
