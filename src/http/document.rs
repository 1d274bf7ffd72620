//! The contract as a document: what the routes say of themselves, and what follows from their bodies, paths and parameters.

use utoipa::openapi::path::{Operation, Parameter, ParameterIn};
use utoipa::openapi::{
    ArrayBuilder, ContentBuilder, HeaderBuilder, Object, ObjectBuilder, OpenApi, Ref, RefOr, Response,
    ResponseBuilder, Schema, Type,
};

use super::form::Form;
use super::kinds::label_requests;
use super::problem::MEDIA_TYPE;
use super::router::routes;

/// Problem that many routes answer, said once under `components`.
struct Common {
    /// Name of the component.
    name: &'static str,
    status: &'static str,
    description: &'static str,
    /// Whether a route of this path answers it.
    is_of: fn(path: &str, operation: &Operation) -> bool,
}

/// Problems in the order in which a route gets them, unless it describes the status itself.
const COMMON: [Common; 17] = [
    Common {
        name: "NotJson",
        status: "400",
        description: "The body is not JSON; `errors` has line and column.",
        is_of: |_, operation| takes_json(operation),
    },
    Common {
        name: "InvalidParameter",
        status: "400",
        description: "A parameter is not valid.",
        is_of: |_, _| true,
    },
    Common {
        name: "NoToken",
        status: "401",
        description: "The service wants a token, and the request has none that it knows.",
        is_of: |_, _| true,
    },
    Common {
        name: "NotAllowed",
        status: "403",
        description: "The token may only read, or a page of another site asks a service without tokens for a change.",
        is_of: |_, _| true,
    },
    Common {
        name: "NoSuchJob",
        status: "404",
        description: "There is no such job.",
        is_of: |path, _| path.starts_with("/v1/jobs/{id}"),
    },
    Common {
        name: "NoSuchModel",
        status: "404",
        description: "There is no such model.",
        is_of: |path, _| path.starts_with("/v1/models/{id}"),
    },
    Common {
        name: "NotInThatForm",
        status: "406",
        description: "The result does not come in the form that `Accept` asks for; `detail` says in which it does.",
        is_of: |_, operation| operation.parameters.iter().flatten().any(is_form),
    },
    Common {
        name: "BodyStopped",
        status: "408",
        description: "The client stopped sending the body.",
        is_of: |_, operation| operation.request_body.is_some(),
    },
    Common {
        name: "BodyTooLarge",
        status: "413",
        description: "The body is too large.",
        is_of: |_, operation| operation.request_body.is_some(),
    },
    Common {
        name: "NotDeclaredJson",
        status: "415",
        description: "The body is not declared as application/json.",
        is_of: |_, operation| takes_json(operation),
    },
    Common {
        name: "WrongHost",
        status: "421",
        description: "The service does not go by the name in the Host header.",
        is_of: |_, _| true,
    },
    Common {
        name: "ImpossibleJob",
        status: "422",
        description: "A field is unknown, missing or impossible, the model is unknown (`errors` points at each), or the idempotency key \
                      belongs to another request.",
        is_of: |_, operation| takes_json(operation) && operation.parameters.iter().flatten().any(is_key),
    },
    Common {
        name: "ImpossibleRequest",
        status: "422",
        description: "A field is unknown, missing or impossible, or the model is unknown: `errors` points at each.",
        is_of: |_, operation| takes_json(operation),
    },
    Common {
        name: "LimitReached",
        status: "429",
        description: "The owner has too many models, bytes, waiting speeds, or requests that are being planned; Retry-After says when to \
                      try again.",
        is_of: |_, _| true,
    },
    Common {
        name: "Defect",
        status: "500",
        description: "A defect, or the storage failed: the service's log says more.",
        is_of: |_, _| true,
    },
    Common {
        name: "StorageUnavailable",
        status: "503",
        description: "The storage cannot be used for the moment; Retry-After says when to try again.",
        is_of: |_, _| true,
    },
    Common {
        name: "StorageFull",
        status: "507",
        description: "The storage is full; Retry-After says when to try again.",
        is_of: |_, _| true,
    },
];

/// Name of the answer to a client that has the result already.
const UNCHANGED: &str = "Unchanged";

/// Name of the answer to a request for a job.
const ACCEPTED: &str = "Accepted";

/// The `OpenAPI` document of the service.
pub fn document() -> OpenApi {
    let mut document = routes().into_openapi();
    for (path, operation) in operations(&mut document) {
        if let Some(wanted) = operation.parameters.iter_mut().flatten().find_map(form_wanted) {
            let forms = forms_of(path);
            wanted.enum_values = Some(forms.iter().map(|form| form.word().into()).collect());
            add_forms(operation, forms);
        }
        if takes_json(operation) && operation.parameters.iter().flatten().any(is_key) {
            let answers = &mut operation.responses.responses;
            answers.entry("202".to_owned()).or_insert_with(|| Ref::from_response_name(ACCEPTED).into());
        }
        let common = COMMON.iter().filter(|common| (common.is_of)(path, operation));
        for Common { name, status, .. } in common.collect::<Vec<_>>() {
            let answers = &mut operation.responses.responses;
            answers.entry((*status).to_owned()).or_insert_with(|| Ref::from_response_name(*name).into());
        }
    }
    let shared = shared_parameters(&mut document);
    let components = document.components.get_or_insert_default();
    label_requests(components);
    for Common { name, description, .. } in COMMON {
        components.responses.insert(name.to_owned(), problem(description).into());
    }
    components.responses.insert(ACCEPTED.to_owned(), accepted().into());
    let unchanged =
        ResponseBuilder::new().description("The client has it: its `If-None-Match` names the ETag.");
    components.responses.insert(UNCHANGED.to_owned(), unchanged.build().into());
    components
        .parameters
        .extend(shared.into_iter().map(|parameter| (component(&parameter), parameter.into())));
    document
}

fn operations(document: &mut OpenApi) -> impl Iterator<Item = (&str, &mut Operation)> {
    document.paths.paths.iter_mut().flat_map(|(path, item)| {
        let operations = [&mut item.get, &mut item.post, &mut item.put, &mut item.patch, &mut item.delete];
        operations.into_iter().flatten().map(|operation| (path.as_str(), operation))
    })
}

fn takes_json(operation: &Operation) -> bool {
    let body = match &operation.request_body {
        Some(RefOr::T(body)) => body,
        _ => return false,
    };
    body.content.contains_key("application/json")
}

fn is_form(parameter: &RefOr<Parameter>) -> bool {
    matches!(parameter, RefOr::T(parameter) if parameter.name == "format")
}

fn is_key(parameter: &RefOr<Parameter>) -> bool {
    matches!(parameter, RefOr::T(parameter) if parameter.name == "Idempotency-Key")
}

/// Takes parameters that several routes have out of them, and leaves references there. Of several that would have one name, the most frequent
/// one is shared.
fn shared_parameters(document: &mut OpenApi) -> Vec<Parameter> {
    let mut counted: Vec<(Parameter, usize)> = Vec::new();
    for (_, operation) in operations(document) {
        for parameter in operation.parameters.iter().flatten() {
            let RefOr::T(parameter) = parameter else { continue };
            match counted.iter_mut().find(|(known, _)| known == parameter) {
                Some((_, count)) => *count += 1,
                None => counted.push((parameter.clone(), 1)),
            }
        }
    }
    counted.retain(|(_, count)| *count > 1);
    counted.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let mut shared: Vec<Parameter> = Vec::new();
    for (parameter, _) in counted {
        if shared.iter().all(|known| component(known) != component(&parameter)) {
            shared.push(parameter);
        }
    }
    for (_, operation) in operations(document) {
        for parameter in operation.parameters.iter_mut().flatten() {
            if let RefOr::T(known) = parameter
                && shared.contains(known)
            {
                *parameter = RefOr::Ref(Ref::new(format!("#/components/parameters/{}", component(known))));
            }
        }
    }
    shared
}

/// Name of the component of a parameter: `SweepId` of "Id of a sweep.", `IdempotencyKey` of `Idempotency-Key`.
fn component(parameter: &Parameter) -> String {
    let of = parameter.description.iter().filter(|_| parameter.parameter_in == ParameterIn::Path);
    let noun = of.filter_map(|text| text.strip_prefix("Id of ")?.split(['.', ',']).next()).next();
    let name = match noun {
        Some(noun) => format!("{noun} id"),
        None => parameter.name.clone(),
    };
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !["a", "the", ""].contains(word));
    words
        .flat_map(|word| {
            let mut letters = word.chars();
            letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters)
        })
        .collect()
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

/// The schema of a parameter that says in which form a result is wanted.
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
fn add_forms(operation: &mut Operation, forms: &[Form]) {
    let responses = &mut operation.responses.responses;
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
    responses.insert("304".to_owned(), Ref::from_response_name(UNCHANGED).into());
}

fn accepted() -> Response {
    let receipt = ContentBuilder::new().schema(Some(Ref::from_schema_name("Receipt"))).build();
    let path = HeaderBuilder::new()
        .schema(Some(Object::with_type(Type::String)))
        .description(Some("Path of the job."));
    let accepted = ResponseBuilder::new().description("The job is accepted.");
    accepted.content("application/json", receipt).header("Location", path.build()).build()
}

fn problem(description: &str) -> Response {
    let content = ContentBuilder::new().schema(Some(Ref::from_schema_name("Problem"))).build();
    ResponseBuilder::new().description(description).content(MEDIA_TYPE, content).build()
}
