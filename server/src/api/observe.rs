//! Every request is counted, timed and, at level debug, logged.

use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::middleware::Next;
use axum::response::Response;

use crate::app::App;
use crate::metrics::RequestLabels;

/// Routes that wait on purpose.
const WAITING: [&str; 2] = ["/v1/claims", "/v1/events"];

pub(super) async fn observe(State(app): State<App>, request: Request, next: Next) -> Response {
    let start = Instant::now();
    let method = request.method().to_string();
    let route = request
        .extensions()
        .get::<MatchedPath>()
        .map_or_else(|| "none".to_owned(), |path| path.as_str().to_owned());
    let response = next.run(request).await;
    let took = start.elapsed();
    let status = response.status().as_u16();
    tracing::debug!(%method, %route, status, took_ms = took.as_millis(), "request");
    let timed = (!WAITING.contains(&route.as_str())).then_some(took);
    app.metrics().request(&RequestLabels { method, route, status: status.into() }, timed);
    response
}
