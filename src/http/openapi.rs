//! Head of the contract, which stands beside its paths, and the route that serves the whole.

use axum::extract::State;
use axum::http::header;
use axum::response::IntoResponse;
use utoipa::OpenApi;

use super::kinds::Receipt;
use super::state::AppState;
use crate::from_mesh::MeshSettings;

/// Parts of the document beside its paths.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "rubmap",
        description = "At which rotational speeds do the blade tips of a centrifugal impeller interact dangerously \
            with their casing? Upload one finite-element sector, post a modal analysis or a sweep of contact \
            simulations, follow the job, download its results.\n\n\
            Every error is a problem (RFC 9457) whose `errors` point at the offending fields. Timestamps are RFC 3339 \
            in UTC. Lengths, forces, times and masses are in the units of the model's package.\n\n\
            A POST may carry an `Idempotency-Key`: for seven days, repeating it with the same body repeats the first \
            answer, and using the key for another request is refused with 422.\n\n\
            Whatever the path, a request is refused with 400 if it does not name exactly one `Host`, with 421 if that is none of \
            the service's, and with 408 if its body stops coming. Every answer has an `X-Request-Id`, which is the client's \
            own if it sent one of 1 to 64 visible ASCII characters, and under which the service's log has the request.",
    ),
    components(schemas(Receipt, MeshSettings)),
    tags(
        (name = "models", description = "Impeller sectors."),
        (name = "jobs", description = "Computations on them."),
        (name = "results", description = "What jobs found."),
        (name = "service", description = "The service itself."),
    )
)]
pub(super) struct ApiDoc;

/// Read this contract as a document.
#[utoipa::path(get, path = "/openapi.json", operation_id = "get_openapi", tag = "service",
    responses((status = 200, description = "The OpenAPI 3.1 document.", body = Object)))]
pub(super) async fn get_openapi(state: State<AppState>) -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "application/json")], state.openapi.to_string())
}
