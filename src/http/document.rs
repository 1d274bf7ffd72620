//! The contract as a document: what the routes say of themselves, and what all of them may answer.

use std::collections::BTreeMap;

use utoipa::openapi::path::Parameter;
use utoipa::openapi::{
    ArrayBuilder, ContentBuilder, HeaderBuilder, Object, ObjectBuilder, Ref, RefOr, Response,
    ResponseBuilder, Schema, Type,
};

use super::form::Form;
use super::problem::MEDIA_TYPE;
use super::router::routes;

/// The `OpenAPI` document of the service.
pub fn document() -> utoipa::openapi::OpenApi {
    let mut document = routes().into_openapi();
    for (path, item) in &mut document.paths.paths {
        let operations = [&mut item.get, &mut item.post, &mut item.put, &mut item.patch, &mut item.delete];
        for operation in operations.into_iter().flatten() {
            if let Some(wanted) = operation.parameters.iter_mut().flatten().find_map(form_wanted) {
                let forms = forms_of(path);
                wanted.enum_values = Some(forms.iter().map(|form| form.word().into()).collect());
                add_forms(&mut operation.responses.responses, forms);
            }
            if operation.request_body.is_some() {
                let stopped = "The client stopped sending the body.";
                let answers = &mut operation.responses.responses;
                answers.entry("408".to_owned()).or_insert_with(|| problem(stopped));
            }
            add_common_answers(&mut operation.responses.responses);
        }
    }
    document
}

/// A figure; Plotly's own schema says what is in both.
fn figure() -> Object {
    ObjectBuilder::new()
        .property("data", ArrayBuilder::new().items(Object::with_type(Type::Object)))
        .property("layout", Object::with_type(Type::Object))
        .required("data")
        .required("layout")
        .build()
}

/// What a parameter that says in which form a result is wanted takes.
fn form_wanted(parameter: &mut RefOr<Parameter>) -> Option<&mut Object> {
    match parameter {
        RefOr::T(Parameter { name, schema: Some(RefOr::T(Schema::Object(words))), .. })
            if name == "format" =>
        {
            Some(words)
        }
        _ => None,
    }
}

/// The forms of a route's result: those that its handler chooses from.
fn forms_of(path: &str) -> &'static [Form] {
    match path.rsplit('/').next() {
        Some("fields") => &Form::FIELDS,
        Some("modes") => &Form::LIST_AND_FIELDS,
        Some("mesh") => &Form::MESH,
        Some("wheel") => &Form::NUMBERS,
        _ => &Form::ALL,
    }
}

/// The forms of a result beside its json, and what goes with them.
fn add_forms(responses: &mut BTreeMap<String, RefOr<Response>>, forms: &[Form]) {
    if let Some(RefOr::T(answer)) = responses.get_mut("200") {
        for form in forms.iter().filter(|form| **form != Form::Json) {
            // Of what is no text there is nothing more to say (OpenAPI 3.1, 4.8.14).
            let schema = match form {
                Form::Csv | Form::Svg => Some(Object::with_type(Type::String)),
                Form::Plotly => Some(figure()),
                _ => None,
            };
            answer
                .content
                .insert(form.media_type().to_owned(), ContentBuilder::new().schema(schema).build().into());
        }
        let tag = HeaderBuilder::new().description(Some(
            "Of what does not change any more: sent back in `If-None-Match` it is answered with 304.",
        ));
        answer.headers.insert("ETag".to_owned(), tag.build().into());
    }
    let unchanged =
        ResponseBuilder::new().description("The client has it: its `If-None-Match` names the ETag.");
    responses.insert("304".to_owned(), unchanged.build().into());
    let refused =
        "The result does not come in the form that `Accept` asks for; `detail` says in which it does.";
    responses.insert("406".to_owned(), problem(refused));
}

/// What every route may answer, unless it says so itself.
fn add_common_answers(responses: &mut BTreeMap<String, RefOr<Response>>) {
    for (status, description) in [
        ("400", "A parameter is not valid."),
        ("401", "The service wants a token, and the request has none that it knows."),
        (
            "403",
            "The token may only read, or a page of another site asks a service without tokens for a change.",
        ),
        ("421", "The service does not go by the name in the Host header."),
        (
            "429",
            "The owner has too many models, bytes, waiting speeds, or requests that are being planned; Retry-After says when to try again.",
        ),
        ("503", "The storage cannot be used for the moment; Retry-After says when to try again."),
        ("507", "The storage is full; Retry-After says when to try again."),
        ("500", "A defect, or the storage failed: the service's log says more."),
    ] {
        responses.entry(status.to_owned()).or_insert_with(|| problem(description));
    }
}

fn problem(description: &str) -> RefOr<Response> {
    let content = ContentBuilder::new().schema(Some(Ref::from_schema_name("Problem"))).build();
    ResponseBuilder::new().description(description).content(MEDIA_TYPE, content).build().into()
}
