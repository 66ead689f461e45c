//! `/v1/sweeps/{id}/consolidation`, `/moduli`, `/structure` of cohesive discs, and their pictures.

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
use crate::app::{App, DiscAnalysis, Filters};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(consolidation))
        .routes(routes!(consolidation_svg))
        .routes(routes!(moduli))
        .routes(routes!(moduli_svg))
        .routes(routes!(structure))
        .routes(routes!(structure_svg))
}

type Query = BTreeMap<String, String>;

async fn answer(app: App, id: SweepId, what: DiscAnalysis, query: Query) -> Answer<Json<Value>> {
    Ok(Json(app.analyse_discs(id, what, filters(&query)?).await?))
}

async fn picture(app: App, id: SweepId, what: DiscAnalysis, query: Query) -> Answer<impl IntoResponse> {
    let svg = app.picture_discs(id, what, filters(&query)?).await?;
    Ok(([(CONTENT_TYPE, "image/svg+xml")], svg))
}

fn filters(query: &Query) -> Answer<Filters> {
    Ok(Filters::read(query.iter().map(|(name, text)| (name.as_str(), text.as_str())))?)
}

/// Consolidation curves Φ(P*) with their fits
///
/// Mean 1/Φ of the samples at every pressure, and the fits (7) of the straight part, (8) of the tail and (9) of both, with intervals. Sweeps of cohesive_discs; query parameters filter the states as for `/states`. Answers also while the sweep
/// runs; what the data do not determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/consolidation", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn consolidation(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, DiscAnalysis::Consolidation, query).await
}

/// Consolidation curves Φ(P*) with their fits, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/consolidation.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn consolidation_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, DiscAnalysis::Consolidation, query).await
}

/// Bulk and shear modulus against P*
///
/// B and G from the stiffness matrix of every state, with the Voigt and Reuss estimates (12), (14) and the sign of its smallest eigenvalue. Sweeps of cohesive_discs; query parameters filter the states as for `/states`. Answers also while the sweep
/// runs; what the data do not determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/moduli", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn moduli(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, DiscAnalysis::Moduli, query).await
}

/// Bulk and shear modulus against P*, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/moduli.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn moduli_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, DiscAnalysis::Moduli, query).await
}

/// Structure against P*
///
/// Fractal dimension, correlation length and mass-averaged radius of gyration of the pores of every state. Sweeps of cohesive_discs; query parameters filter the states as for `/states`. Answers also while the sweep
/// runs; what the data do not determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/structure", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn structure(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, DiscAnalysis::Structure, query).await
}

/// Structure against P*, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/structure.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn structure_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, DiscAnalysis::Structure, query).await
}
