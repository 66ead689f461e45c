//! `/v1/jobs`.

use axum::Json;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use protocol::api::JobView;
use protocol::{JobId, ProblemDocument};
use record::Packing;
use serde::Deserialize;
use utoipa::IntoParams;

use super::extract::{Id, Params};
use super::negotiate::{Offer, choose};
use super::problem::Answer;
use crate::app::App;
use crate::error::AppError;

#[derive(Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
pub(super) struct FormatQuery {
    /// Format; or by `Accept`.
    format: Option<String>,
}

#[derive(Clone, Copy)]
enum SeriesFormat {
    Json,
    Csv,
}

#[derive(Clone, Copy)]
enum SnapshotFormat {
    Json,
    Vtk,
}

const SERIES: &[Offer<SeriesFormat>] = &[
    Offer { name: "json", media: &["application/json"], format: SeriesFormat::Json },
    Offer { name: "csv", media: &["text/csv"], format: SeriesFormat::Csv },
];

const SNAPSHOT: &[Offer<SnapshotFormat>] = &[
    Offer { name: "json", media: &["application/json"], format: SnapshotFormat::Json },
    Offer {
        name: "vtk",
        media: &["application/vtk", "application/x-vtk", "text/plain"],
        format: SnapshotFormat::Vtk,
    },
];

/// One run: scene, attempts, record
#[utoipa::path(get, path = "/v1/jobs/{id}", tag = "jobs", params(("id" = JobId, Path)),
    responses((status = 200, body = JobView),
        (status = 404, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn show(State(app): State<App>, Id(id): Id<JobId>) -> Answer<Json<JobView>> {
    Ok(Json(app.job(id).await?))
}

/// Time series of a finished run
///
/// Named columns with units, as JSON or CSV.
#[utoipa::path(get, path = "/v1/jobs/{id}/series", tag = "jobs", params(("id" = JobId, Path), FormatQuery),
    responses((status = 200, content((Object = "application/json"), (String = "text/csv"))),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Not done")))]
pub(super) async fn series(
    State(app): State<App>,
    Id(id): Id<JobId>,
    Params(query): Params<FormatQuery>,
    headers: HeaderMap,
) -> Answer<Response> {
    let format = choose(query.format.as_deref(), &headers, SERIES, "json or csv")?;
    let table = app.outcome(id).await?.series;
    Ok(match format {
        SeriesFormat::Json => Json(table).into_response(),
        SeriesFormat::Csv => {
            ([(CONTENT_TYPE, "text/csv; charset=utf-8")], record::csv(&table)).into_response()
        }
    })
}

/// Final packing of a finished run, with its contacts
///
/// Columnar JSON (tables of named columns with units) or VTK legacy (`format=vtk`, for ParaView).
#[utoipa::path(get, path = "/v1/jobs/{id}/snapshot", tag = "jobs", params(("id" = JobId, Path), FormatQuery),
    responses((status = 200, content((Object = "application/json"), (String = "application/vtk"))),
        (status = 409, body = ProblemDocument, content_type = "application/problem+json", description = "Not done")))]
pub(super) async fn snapshot(
    State(app): State<App>,
    Id(id): Id<JobId>,
    Params(query): Params<FormatQuery>,
    headers: HeaderMap,
) -> Answer<Response> {
    let format = choose(query.format.as_deref(), &headers, SNAPSHOT, "json or vtk")?;
    let packing: Packing = app.outcome(id).await?.packing;
    Ok(match format {
        SnapshotFormat::Json => Json(packing).into_response(),
        SnapshotFormat::Vtk => {
            let text = record::vtk(&packing, &format!("job {id}"))
                .map_err(|error| AppError::Analysis(error.to_string()))?;
            ([(CONTENT_TYPE, "application/vtk")], text).into_response()
        }
    })
}
