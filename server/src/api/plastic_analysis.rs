//! `/v1/sweeps/{id}/compaction`, `/coordination` of plastic discs, and the pictures of both.

use std::collections::BTreeMap;

use axum::Json;
use axum::extract::State;
use axum::http::header::CONTENT_TYPE;
use axum::response::IntoResponse;
use protocol::{ProblemDocument, SweepId};
use serde_json::Value;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::extract::{Id, Params};
use super::problem::Answer;
use crate::app::{App, Filters, PlasticAnalysis};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(compaction))
        .routes(routes!(compaction_svg))
        .routes(routes!(coordination))
        .routes(routes!(coordination_svg))
        .routes(routes!(curvature_svg))
        .routes(routes!(stress_strain_svg))
}

type Query = BTreeMap<String, String>;

async fn answer(app: App, id: SweepId, what: PlasticAnalysis, query: Query) -> Answer<Json<Value>> {
    Ok(Json(app.analyse_plastic(id, what, filters(&query)?).await?))
}

async fn picture(app: App, id: SweepId, what: PlasticAnalysis, query: Query) -> Answer<impl IntoResponse> {
    let svg = app.picture_plastic(id, what, filters(&query)?).await?;
    Ok(([(CONTENT_TYPE, "image/svg+xml")], svg))
}

fn filters(query: &Query) -> Answer<Filters> {
    Ok(Filters::read(query.iter().map(|(name, text)| (name.as_str(), text.as_str())))?)
}

/// Stress of plastic discs against solid fraction and strain
///
/// Loading path, jamming point, share α of (11), the fits of (6) and (10) with intervals beside the
/// paper's constants, and the stress at which plastic and elastic curves part. Sweeps of plastic_discs; query parameters filter
/// the states as for `/states`. Answers also while the sweep runs; what the data do not determine is a reason in
/// its place, or a problem document.
#[utoipa::path(get, path = "/v1/sweeps/{id}/compaction", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn compaction(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, PlasticAnalysis::Compaction, query).await
}

/// Stress of plastic discs against solid fraction and strain, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/compaction.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn compaction_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, PlasticAnalysis::Compaction, query).await
}

/// Coordination number above jamming
///
/// Z − Z_c against Φ − Φ_c: the square root of (17), and a fit with a free exponent, with intervals. Sweeps of plastic_discs; query parameters filter
/// the states as for `/states`. Answers also while the sweep runs; what the data do not determine is a reason in
/// its place, or a problem document.
#[utoipa::path(get, path = "/v1/sweeps/{id}/coordination", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn coordination(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, PlasticAnalysis::Coordination, query).await
}

/// Coordination number above jamming, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/coordination.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn coordination_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, PlasticAnalysis::Coordination, query).await
}

/// Largest curvature and solid fraction against stress, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/curvature.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn curvature_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, PlasticAnalysis::Curvature, query).await
}

/// Stress of single discs by four definitions against strain, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/stress-strain.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn stress_strain_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, PlasticAnalysis::StressStrain, query).await
}
