//! `/v1/jobs`.

use axum::Json;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use protocol::api::JobView;
use protocol::{JobId, ProblemDocument};
use record::{Packing, Table};
use serde::Deserialize;
use utoipa::IntoParams;

use super::extract::{Id, Params};
use super::negotiate::{Offer, choose};
use super::problem::Answer;
use crate::app::{App, SnapshotFormat, vtk};
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
        SeriesFormat::Csv => ([(CONTENT_TYPE, "text/csv; charset=utf-8")], csv_of(&table)?).into_response(),
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
            ([(CONTENT_TYPE, "application/vtk")], vtk(&packing, &format!("job {id}"))?).into_response()
        }
    })
}

fn csv_of(table: &Table) -> Result<Vec<u8>, AppError> {
    let bug = |error: csv::Error| AppError::Bug(error.to_string());
    let mut writer = csv::Writer::from_writer(Vec::new());
    if !table.columns().is_empty() {
        let head = table.columns().iter().map(|column| format!("{} [{}]", column.name, column.unit));
        writer.write_record(head).map_err(bug)?;
    }
    for row in 0..table.rows() {
        let cells = table.columns().iter().map(|column| column.values[row].get().to_string());
        writer.write_record(cells).map_err(bug)?;
    }
    writer.into_inner().map_err(|error| AppError::Bug(error.to_string()))
}
