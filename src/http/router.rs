//! Router of the service: all routes, and the layers around them.

use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::{HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware;
use axum::routing::get;
use tower::ServiceBuilder;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use tower_http::compression::predicate::{DefaultPredicate, NotForContentType, Predicate};
use tower_http::cors::{AllowOrigin, CorsLayer};
use tower_http::set_header::SetResponseHeaderLayer;
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::state::AppState;
use super::{
    access, archive, backbones, body, branches, campaigns, casings, contract, cross_site, events, extract,
    fields, forces, health, histories, host, interference, jobs, kinds, level, looks, maps, mesh, metrics,
    models, modes, openapi, principal, problem, report, results, run_ups, section, spectra, stream, stress,
    studies, verdict, version, web, wheel,
};

/// Routes with their descriptions.
pub(super) fn routes() -> OpenApiRouter<AppState> {
    kinds::routes(OpenApiRouter::with_openapi(openapi::ApiDoc::openapi()))
        .routes(routes!(models::create_model, models::list_models))
        .routes(routes!(models::get_model, models::label_model, models::delete_model))
        .routes(routes!(looks::look_at_mesh))
        .routes(routes!(casings::read_casing_table))
        .routes(routes!(section::get_section))
        .routes(routes!(mesh::get_mesh))
        .routes(routes!(modes::get_modes))
        .routes(routes!(jobs::list_jobs))
        .routes(routes!(jobs::get_job, jobs::label_job, jobs::delete_job))
        .routes(routes!(jobs::pause_job))
        .routes(routes!(jobs::continue_job))
        .routes(routes!(events::follow_job))
        .routes(routes!(archive::get_archive))
        .routes(routes!(report::get_report))
        .routes(routes!(results::get_campbell))
        .routes(routes!(interference::get_interference))
        .routes(routes!(backbones::get_backbones))
        .routes(routes!(maps::get_interaction_map))
        .routes(routes!(spectra::get_spectra))
        .routes(routes!(spectra::get_wear))
        .routes(routes!(results::get_critical_speeds))
        .routes(routes!(wheel::get_wheel_critical_speeds))
        .routes(routes!(verdict::get_verdict))
        .routes(routes!(level::get_level))
        .routes(routes!(studies::get_work_precision))
        .routes(routes!(histories::get_histories, histories::create_histories))
        .routes(routes!(branches::get_branches))
        .routes(routes!(run_ups::get_run_ups))
        .routes(routes!(run_ups::get_spectrogram))
        .routes(routes!(campaigns::get_campaign))
        .routes(routes!(fields::get_fields))
        .routes(routes!(forces::get_forces))
        .routes(routes!(stress::get_stress))
        .routes(routes!(health::get_health))
        .routes(routes!(health::get_readiness))
        .routes(routes!(metrics::get_metrics))
        .routes(routes!(version::get_version))
        .routes(routes!(openapi::get_openapi))
}

/// Routes of a process that serves nobody's jobs: whether it lives and can work, and its metrics.
pub fn observation(state: AppState) -> Router {
    Router::new()
        .route("/healthz", get(health::get_health))
        .route("/readyz", get(health::get_readiness))
        .route("/metrics", get(metrics::get_metrics))
        .fallback(|| async { StatusCode::NOT_FOUND })
        .layer(middleware::from_fn(problem::complete))
        .with_state(state)
}

/// Router of the service. From outside to inside: layers for every answer, layers that may refuse a request before its route sees it, and the routes.
pub fn router(state: AppState) -> Router {
    let sniffing = SetResponseHeaderLayer::overriding(
        header::X_CONTENT_TYPE_OPTIONS,
        HeaderValue::from_static("nosniff"),
    );
    let layers = ServiceBuilder::new()
        .layer(middleware::from_fn_with_state(state.clone(), access::follow))
        .layer(sniffing)
        // An archive is compressed already.
        .layer(
            CompressionLayer::new()
                .compress_when(DefaultPredicate::new().and(NotForContentType::const_new(stream::ZIP))),
        )
        // Turns the bare statuses of axum's own fallbacks into problems, too.
        .layer(middleware::from_fn(problem::complete))
        .layer(CatchPanicLayer::custom(problem::panicked))
        .layer(middleware::from_fn_with_state(state.clone(), host::check))
        // Answers what browsers ask in advance, which carries no credentials.
        .option_layer(cors(&state.transport.cors_origins))
        .layer(middleware::from_fn_with_state(state.clone(), cross_site::refuse))
        .layer(middleware::from_fn_with_state(state.tokens.clone(), principal::authenticate))
        .layer(middleware::from_fn_with_state(state.clone(), body::keep_coming))
        .layer(DefaultBodyLimit::max(extract::WHOLE_BYTES))
        .layer(middleware::from_fn_with_state(
            Arc::clone(&state.contract),
            contract::refuse_unknown_parameters,
        ));
    let (router, _) = routes().split_for_parts();
    router.merge(web::routes()).fallback(|| async { StatusCode::NOT_FOUND }).layer(layers).with_state(state)
}

/// Layer that lets pages from `origins`, if there are any, do all that other clients may.
fn cors(origins: &[HeaderValue]) -> Option<CorsLayer> {
    let idempotency_key = HeaderName::from_static("idempotency-key");
    let layer = CorsLayer::new()
        .allow_origin(AllowOrigin::list(origins.iter().cloned()))
        .allow_methods([Method::GET, Method::POST, Method::PATCH, Method::DELETE])
        .allow_headers([
            header::AUTHORIZATION,
            header::CONTENT_TYPE,
            header::IF_NONE_MATCH,
            idempotency_key,
            access::REQUEST_ID,
        ])
        .expose_headers([header::ETAG, header::LOCATION, header::RETRY_AFTER, access::REQUEST_ID]);
    (!origins.is_empty()).then_some(layer)
}
