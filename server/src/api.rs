//! The HTTP edge: thin handlers, one file per resource; router and description come from the same registration.

mod analysis;
mod auth;
mod disc_analysis;
mod docs;
mod events;
mod extract;
mod health;
mod jobs;
mod leases;
mod negotiate;
mod observe;
mod plastic_analysis;
mod points;
mod problem;
mod results;
mod sweeps;
mod workers;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::middleware::{from_fn, from_fn_with_state};
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;

#[derive(OpenApi)]
#[openapi(
    info(
        title = "Tamp",
        description = "Parameter sweeps of granular compaction. Pressures and stresses in Pa; lengths in m; results \
                       dimensionless as in the papers. Errors are problem documents (RFC 9457) with a stable `type`, \
                       the field path and a remedy. Every list has a limit and a cursor.",
        license(name = "Apache-2.0 OR MIT")
    ),
    tags(
        (name = "sweeps", description = "Submit, follow and control sweeps"),
        (name = "results", description = "Rows of finished runs"),
        (name = "analysis", description = "Collapse, fits, exponents, forces and bonds; also while the sweep runs"),
        (name = "jobs", description = "Single runs"),
        (name = "workers", description = "The worker protocol"),
        (name = "service", description = "Health, metrics, description")
    )
)]
struct Description;

fn routed() -> OpenApiRouter<App> {
    OpenApiRouter::with_openapi(Description::openapi())
        .routes(routes!(sweeps::submit, sweeps::list))
        .routes(routes!(sweeps::show))
        .routes(routes!(sweeps::cancel))
        .routes(routes!(sweeps::pause))
        .routes(routes!(sweeps::resume))
        .routes(routes!(sweeps::retry))
        .routes(routes!(sweeps::points))
        .routes(routes!(results::results))
        .routes(routes!(results::states))
        .merge(analysis::routes())
        .merge(disc_analysis::routes())
        .merge(plastic_analysis::routes())
        .routes(routes!(jobs::show))
        .routes(routes!(jobs::series))
        .routes(routes!(jobs::snapshot))
        .routes(routes!(points::explain))
        .routes(routes!(workers::register, workers::list))
        .routes(routes!(workers::claim))
        .routes(routes!(leases::heartbeat))
        .routes(routes!(leases::put_checkpoint, leases::get_checkpoint))
        .routes(routes!(leases::result))
        .routes(routes!(leases::failure))
        .routes(routes!(leases::release))
        .routes(routes!(events::events))
        .routes(routes!(health::healthz))
        .routes(routes!(health::readyz))
        .routes(routes!(health::metrics))
}

/// The API description, as committed in `api.yaml`.
///
/// # Panics
/// Never: the description is plain data.
#[must_use]
pub fn description() -> String {
    let (_, api) = routed().split_for_parts();
    api.to_yaml().expect("the description is plain data")
}

/// The router over a service.
pub fn router(app: App) -> Router {
    let (router, api) = routed().split_for_parts();
    let pages = docs::routes(&api);
    router
        .merge(pages)
        .fallback(problem::no_route)
        .method_not_allowed_fallback(problem::no_method)
        .layer(from_fn_with_state(app.clone(), auth::require_token))
        .layer(CatchPanicLayer::custom(problem::panicked))
        .layer(CompressionLayer::new())
        .layer(from_fn_with_state(app.clone(), observe::observe))
        .layer(from_fn(problem::finish))
        .layer(DefaultBodyLimit::disable())
        .with_state(app)
}
