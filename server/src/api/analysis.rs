//! `/v1/sweeps/{id}/collapse`, `/fit`, `/exponents`, `/forces`, `/bonds`, `/variation`, and their pictures.

use std::collections::BTreeMap;

use analysis::variation::Varied;
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
use crate::app::{Analysis, App, Filters};
use crate::error::AppError;

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(collapse))
        .routes(routes!(collapse_svg))
        .routes(routes!(fit))
        .routes(routes!(fit_svg))
        .routes(routes!(exponents))
        .routes(routes!(exponents_svg))
        .routes(routes!(forces))
        .routes(routes!(forces_svg))
        .routes(routes!(bonds))
        .routes(routes!(bonds_svg))
        .routes(routes!(variation))
        .routes(routes!(variation_svg))
}

type Query = BTreeMap<String, String>;

async fn answer(app: App, id: SweepId, what: Analysis, query: Query) -> Answer<Json<Value>> {
    Ok(Json(app.analyse(id, what, filters(&query)?).await?))
}

async fn picture(app: App, id: SweepId, what: Analysis, query: Query) -> Answer<impl IntoResponse> {
    let svg = app.picture(id, what, filters(&query)?).await?;
    Ok(([(CONTENT_TYPE, "image/svg+xml")], svg))
}

fn filters(query: &Query) -> Answer<Filters> {
    Ok(Filters::read(query.iter().map(|(name, text)| (name.as_str(), text.as_str())))?)
}

/// Plateau and collapse: relative void ratio against η*
///
/// e_min, plateau e_max (15) and relative void ratio e_r (17) of every finished point, with standard errors;
/// outliers flagged. Query parameters filter the rows as for results. Answers also while the sweep runs; what
/// the data do not
/// determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/collapse", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn collapse(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, Analysis::Collapse, query).await
}

/// Plateau and collapse: relative void ratio against η*, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/collapse.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn collapse_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, Analysis::Collapse, query).await
}

/// The master curve through the collapse
///
/// Master curve (30)/(31) with covariance and residuals. Query parameters filter the rows as for results.
/// Answers also while the sweep runs; what the data do not
/// determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/fit", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn fit(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, Analysis::Fit, query).await
}

/// The master curve through the collapse, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/fit.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn fit_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, Analysis::Fit, query).await
}

/// Exponents of the scaling found by the data
///
/// Exponents b and c that collapse the data best, with bootstrap errors, beside the paper's. Query parameters
/// filter the rows as for results. Answers also while the sweep runs; what the data do not
/// determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/exponents", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn exponents(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, Analysis::Exponents, query).await
}

/// Exponents of the scaling found by the data, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/exponents.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn exponents_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, Analysis::Exponents, query).await
}

/// Force exponents β± against η and η*
///
/// Exponents of the force distribution of every run, and which variable orders them better. Query parameters
/// filter the rows as for results. Answers also while the sweep runs; what the data do not
/// determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/forces", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn forces(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, Analysis::Forces, query).await
}

/// Force exponents β± against η and η*, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/forces.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn forces_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, Analysis::Forces, query).await
}

/// Coordination Z± against η and η*
///
/// Compressive and tensile coordination of every run, and which variable orders them better. Query parameters
/// filter the rows as for results. Answers also while the sweep runs; what the data do not
/// determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/bonds", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn bonds(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<Json<Value>> {
    answer(app, id, Analysis::Bonds, query).await
}

/// Coordination Z± against η and η*, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/bonds.svg", tag = "analysis", params(("id" = SweepId, Path)),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn bonds_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<Query>,
) -> Answer<impl IntoResponse> {
    picture(app, id, Analysis::Bonds, query).await
}

/// Whether a key beside the groups of the collapse changes the void ratio
///
/// Blocks of runs that differ only in the key `of` (`alpha_n`, `mw` or `ei`), and the F test of its effect on e.
/// Other query parameters filter the rows as for results. Answers also while the sweep runs; what the data do not
/// determine is a problem document with the reason.
#[utoipa::path(get, path = "/v1/sweeps/{id}/variation", tag = "analysis",
    params(("id" = SweepId, Path), ("of" = String, Query, description = "The varied key: alpha_n, mw or ei")),
    responses((status = 200, body = Object),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn variation(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(mut query): Params<Query>,
) -> Answer<Json<Value>> {
    let varied = varied(&mut query)?;
    answer(app, id, Analysis::Variation(varied), query).await
}

/// Whether a key beside the groups of the collapse changes the void ratio, as a picture
#[utoipa::path(get, path = "/v1/sweeps/{id}/variation.svg", tag = "analysis",
    params(("id" = SweepId, Path), ("of" = String, Query, description = "The varied key: alpha_n, mw or ei")),
    responses((status = 200, body = String, content_type = "image/svg+xml"),
        (status = 422, body = ProblemDocument, content_type = "application/problem+json", description = "Not determined by the data")))]
pub(super) async fn variation_svg(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(mut query): Params<Query>,
) -> Answer<impl IntoResponse> {
    let varied = varied(&mut query)?;
    picture(app, id, Analysis::Variation(varied), query).await
}

/// Takes the varied key out of the query; what is left filters the rows.
fn varied(query: &mut Query) -> Answer<Varied> {
    let of = query.remove("of").unwrap_or_default();
    let known = match of.as_str() {
        "alpha_n" => Varied::AlphaN,
        "mw" => Varied::Mw,
        "ei" => Varied::Ei,
        _ => {
            return Err(AppError::field(
                "query",
                "of",
                of,
                "is none of alpha_n, mw and ei",
                "name the varied key, as in ?of=alpha_n",
            )
            .into());
        }
    };
    Ok(known)
}
