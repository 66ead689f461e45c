//! `/v1/sweeps/{id}/results` and `/states`: rows as JSON, NDJSON or CSV, filtered.

use std::collections::BTreeMap;

use axum::Json;
use axum::body::{Body, Bytes};
use axum::extract::State;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::http::{HeaderMap, HeaderValue};
use axum::response::{IntoResponse, Response};
use futures_util::stream;
use protocol::api::ResultPage;
use protocol::{ProblemDocument, SweepId};
use record::Row;

use super::extract::{Id, Params, cursor, limit};
use super::negotiate::{Offer, choose};
use super::problem::Answer;
use crate::app::{App, Filters, ResultQuery, RowStream};
use crate::error::{AppError, AppResult};

#[derive(Clone, Copy)]
enum Format {
    Json,
    Ndjson,
    Csv,
}

const OFFERS: &[Offer<Format>] = &[
    Offer { name: "json", media: &["application/json"], format: Format::Json },
    Offer { name: "ndjson", media: &["application/x-ndjson", "application/ndjson"], format: Format::Ndjson },
    Offer { name: "csv", media: &["text/csv"], format: Format::Csv },
];

/// Rows of finished runs, in the sweep's order
///
/// One flat row per finished point: scene keys in SI units, `reduced.…`, derived quantities, record, execution.
/// Every other query parameter is a filter on a column: `p=1e5`, `sigma_c.min=1e6`, `sigma_c.max=1e8`,
/// `status=equilibrium`. JSON comes in pages; NDJSON and CSV are streamed whole unless `limit` is given. To page
/// through NDJSON or CSV, give the last `point` as `cursor`.
#[utoipa::path(get, path = "/v1/sweeps/{id}/results", tag = "results",
    params(("id" = SweepId, Path),
        ("limit" = Option<u32>, Query, description = "rows per page, 1 to 10000 [default: 1000 as JSON, all otherwise]"),
        ("cursor" = Option<String>, Query, description = "`next` of the page before"),
        ("format" = Option<String>, Query, description = "json, ndjson or csv; or by `Accept`")),
    responses((status = 200, content((ResultPage = "application/json"), (String = "application/x-ndjson"), (String = "text/csv"))),
        (status = 400, body = ProblemDocument, content_type = "application/problem+json"),
        (status = 406, body = ProblemDocument, content_type = "application/problem+json")))]
pub(super) async fn results(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<BTreeMap<String, String>>,
    headers: HeaderMap,
) -> Answer<Response> {
    Ok(rows(app, id, query, &headers, false).await?)
}

/// Rows of the states of loading paths
///
/// One row per equilibrium state, with the scene's columns and `state_index`; empty for models with one final state.
/// Filters, formats and pages as for results.
#[utoipa::path(get, path = "/v1/sweeps/{id}/states", tag = "results",
    params(("id" = SweepId, Path),
        ("limit" = Option<u32>, Query, description = "rows per page, 1 to 10000 [default: 1000 as JSON, all otherwise]"),
        ("cursor" = Option<String>, Query, description = "`next` of the page before"),
        ("format" = Option<String>, Query, description = "json, ndjson or csv; or by `Accept`")),
    responses((status = 200, content((ResultPage = "application/json"), (String = "application/x-ndjson"), (String = "text/csv")))))]
pub(super) async fn states(
    State(app): State<App>,
    Id(id): Id<SweepId>,
    Params(query): Params<BTreeMap<String, String>>,
    headers: HeaderMap,
) -> Answer<Response> {
    Ok(rows(app, id, query, &headers, true).await?)
}

async fn rows(
    app: App,
    id: SweepId,
    mut parameters: BTreeMap<String, String>,
    headers: &HeaderMap,
    states: bool,
) -> AppResult<Response> {
    let format = parameters.remove("format");
    let format = choose(
        format.as_deref(),
        headers,
        OFFERS,
        "json, ndjson or csv (Parquet is not made here: convert the CSV)",
    )?;
    let asked = parameters
        .remove("limit")
        .map(|text| {
            text.parse::<u32>().map_err(|_| {
                AppError::field("query", "limit", format!("{text:.40?}"), "is no number", "give 1 to 10000")
            })
        })
        .transpose()?;
    let after = cursor(parameters.remove("cursor").as_deref())?;
    let filters = Filters::read(parameters.iter().map(|(name, text)| (name.as_str(), text.as_str())))?;
    let page = limit(asked, 1_000, 10_000)?;
    let query = ResultQuery { filters, after, limit: asked, states };
    match format {
        Format::Json => Ok(Json(app.results(id, query, page).await?).into_response()),
        Format::Ndjson => {
            let rows = app.result_stream(id, query).await?;
            Ok(streamed("application/x-ndjson", id, "ndjson", Lines { rows, head: None, columns: None }))
        }
        Format::Csv => {
            let columns = app.columns(id, query.clone()).await?;
            let rows = app.result_stream(id, query).await?;
            let head = csv_line(columns.iter().map(String::as_str))?;
            let lines = Lines { rows, head: Some(head), columns: Some(columns) };
            Ok(streamed("text/csv; charset=utf-8", id, "csv", lines))
        }
    }
}

struct Lines {
    rows: RowStream,
    head: Option<Vec<u8>>,
    columns: Option<Vec<String>>,
}

impl Lines {
    async fn next(&mut self) -> AppResult<Option<Bytes>> {
        let mut chunk = self.head.take().unwrap_or_default();
        while chunk.len() < 64 << 10 {
            let Some(row) = self.rows.next().await? else { break };
            match &self.columns {
                Some(columns) => chunk.extend(csv_row(columns, &row)?),
                None => {
                    serde_json::to_writer(&mut chunk, &row)
                        .map_err(|error| AppError::Bug(error.to_string()))?;
                    chunk.push(b'\n');
                }
            }
        }
        Ok(if chunk.is_empty() { None } else { Some(chunk.into()) })
    }
}

fn csv_row(columns: &[String], row: &Row) -> AppResult<Vec<u8>> {
    let cells: Vec<String> = columns
        .iter()
        .map(|column| match row.get(column) {
            None => String::new(),
            Some(cell) => cell.text().map_or_else(|| cell.to_json().to_string(), str::to_owned),
        })
        .collect();
    csv_line(cells.iter().map(String::as_str))
}

fn csv_line<'a>(cells: impl Iterator<Item = &'a str>) -> AppResult<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(cells).map_err(|error| AppError::Bug(error.to_string()))?;
    writer.into_inner().map_err(|error| AppError::Bug(error.to_string()))
}

fn streamed(media: &'static str, id: SweepId, extension: &str, lines: Lines) -> Response {
    let chunks = stream::try_unfold(lines, |mut lines| async move {
        let chunk = lines.next().await.map_err(|error| {
            // The head of the answer is sent already: break the stream off, so that nobody takes it for whole.
            tracing::error!(%error, "a stream of results broke off");
            std::io::Error::other(error.to_string())
        })?;
        Ok::<_, std::io::Error>(chunk.map(|chunk| (chunk, lines)))
    });
    let mut response = Body::from_stream(chunks).into_response();
    let headers = response.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(media));
    if let Ok(name) = HeaderValue::from_str(&format!("inline; filename=\"tamp-{id}.{extension}\"")) {
        headers.insert(CONTENT_DISPOSITION, name);
    }
    response
}
