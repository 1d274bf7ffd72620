//! The contract as a document: what the routes say of themselves, and what all of them may answer.

use std::collections::BTreeMap;

use utoipa::openapi::{ContentBuilder, Ref, RefOr, Response, ResponseBuilder};

use super::problem::MEDIA_TYPE;
use super::router::routes;

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
