//! All routes.

use axum::Router;
use axum::http::StatusCode;
use axum::middleware;
use tower::ServiceBuilder;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use tower_http::trace::TraceLayer;
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::{
    AppState, contract, health, jobs, modal_analyses, models, openapi, problem, results, studies, sweeps,
};

/// The routes with their descriptions.
pub(super) fn routes() -> OpenApiRouter<AppState> {
    OpenApiRouter::with_openapi(openapi::Contract::openapi())
        .routes(routes!(models::create_model, models::list_models))
        .routes(routes!(models::plan_model_generation))
        .routes(routes!(models::get_model, models::delete_model))
        .routes(routes!(modal_analyses::create_modal_analysis))
        .routes(routes!(modal_analyses::plan_modal_analysis))
        .routes(routes!(sweeps::create_sweep))
        .routes(routes!(sweeps::plan_sweep))
        .routes(routes!(studies::create_study))
        .routes(routes!(jobs::list_jobs))
        .routes(routes!(jobs::get_job, jobs::cancel_job))
        .routes(routes!(results::get_campbell))
        .routes(routes!(results::get_interaction_map))
        .routes(routes!(results::get_spectra))
        .routes(routes!(results::get_critical_speeds))
        .routes(routes!(studies::get_work_precision))
        .routes(routes!(studies::get_histories))
        .routes(routes!(health::get_health))
        .routes(routes!(health::get_readiness))
        .routes(routes!(openapi::get_openapi))
}

/// The service.
pub fn router(state: AppState) -> Router {
    let layers = ServiceBuilder::new()
        .layer(TraceLayer::new_for_http())
        .layer(CompressionLayer::new())
        .layer(middleware::from_fn(problem::complete))
        .layer(CatchPanicLayer::custom(problem::panicked))
        .layer(middleware::from_fn(contract::refuse_unknown_parameters));
    let (router, _) = routes().split_for_parts();
    // `complete` turns the bare statuses of axum's own fallbacks into problems.
    router.fallback(|| async { StatusCode::NOT_FOUND }).layer(layers).with_state(state)
}
