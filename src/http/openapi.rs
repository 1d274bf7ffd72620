//! The contract, generated from the routes themselves.

use std::collections::BTreeMap;

use axum::extract::State;
use axum::http::header;
use axum::response::IntoResponse;
use utoipa::OpenApi;
use utoipa::openapi::{ContentBuilder, Ref, RefOr, Response, ResponseBuilder};

use super::AppState;
use super::problem::MEDIA_TYPE;
use super::router::routes;

/// All that the document says beside its paths.
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
    tags(
        (name = "models", description = "Impeller sectors."),
        (name = "jobs", description = "Computations on them."),
        (name = "results", description = "What jobs found."),
        (name = "service", description = "The service itself."),
    )
)]
pub(super) struct Contract;

/// The `OpenAPI` document of the service.
pub fn document() -> utoipa::openapi::OpenApi {
    let mut document = routes().into_openapi();
    for path in document.paths.paths.values_mut() {
        let operations = [&mut path.get, &mut path.post, &mut path.put, &mut path.patch, &mut path.delete];
        for operation in operations.into_iter().flatten() {
            add_common_answers(&mut operation.responses.responses);
        }
    }
    document
}

/// What every route may answer, unless it says so itself.
fn add_common_answers(responses: &mut BTreeMap<String, RefOr<Response>>) {
    for (status, description) in [
        ("400", "A parameter is not valid."),
        ("401", "The service wants a token, and the request has none that it knows."),
        ("403", "The token may only read."),
        ("421", "The service does not go by the name in the Host header."),
        (
            "429",
            "The owner has too many models, bytes or waiting speeds; Retry-After says when to try again.",
        ),
        ("503", "The data folder cannot be used for the moment; Retry-After says when to try again."),
        ("507", "The disk of the data folder is full; Retry-After says when to try again."),
        ("500", "A defect, or the data folder failed: the service's log says more."),
    ] {
        responses.entry(status.to_owned()).or_insert_with(|| {
            let content = ContentBuilder::new().schema(Some(Ref::from_schema_name("Problem"))).build();
            ResponseBuilder::new().description(description).content(MEDIA_TYPE, content).build().into()
        });
    }
}

/// Read this document.
#[utoipa::path(get, path = "/openapi.json", operation_id = "get_openapi", tag = "service",
    responses((status = 200, description = "The OpenAPI 3.1 document.", body = Object)))]
pub(super) async fn get_openapi(state: State<AppState>) -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "application/json")], state.openapi.to_string())
}
