//! The contract as a document: what the routes say of themselves, and what follows from their bodies, paths and parameters.

use std::collections::BTreeSet;

use utoipa::openapi::path::{Operation, Parameter, ParameterIn};
use utoipa::openapi::schema::SchemaType;
use utoipa::openapi::{
    ArrayBuilder, ContentBuilder, Header, HeaderBuilder, Object, ObjectBuilder, OpenApi, Ref, RefOr,
    Response, ResponseBuilder, Schema, Type,
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
const COMMON: [Common; 5] = [
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
];

/// Problems that any route may answer, by status; listed once, in the `default` answer.
const EVERYWHERE: [(&str, &str); 11] = [
    ("400", "A parameter is not valid, or the body is not JSON; `errors` has line and column."),
    ("401", "The service wants a token, and the request has none that it knows."),
    ("403", "The token may only read, or a page of another site asks a service without tokens for a change."),
    ("408", "The client stopped sending the body."),
    ("413", "The body is too large."),
    ("415", "The body is not declared as application/json."),
    ("421", "The service does not go by the name in the Host header."),
    (
        "429",
        "The owner has too many models, bytes, waiting speeds, or requests that are being planned; Retry-After says when to try again.",
    ),
    ("500", "A defect, or the storage failed: the service's log says more."),
    ("503", "The storage cannot be used for the moment; Retry-After says when to try again."),
    ("507", "The storage is full; Retry-After says when to try again."),
];

/// Name of the `default` answer.
const REFUSED: &str = "Refused";

/// Name of the problem that routes describe themselves.
const PROBLEM: &str = "Problem";

/// Name of the header that identifies a result.
const TAG: &str = "ETag";

/// Name of the schema of a figure.
const FIGURE: &str = "Figure";

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
        let answers = &mut operation.responses.responses;
        answers.values_mut().for_each(refer_to_problem);
        answers.insert("default".to_owned(), Ref::from_response_name(REFUSED).into());
    }
    let requested = request_schemas(&document);
    let shared = shared_parameters(&mut document);
    let components = document.components.get_or_insert_default();
    label_requests(components);
    for Common { name, description, .. } in COMMON {
        components.responses.insert(name.to_owned(), problem(description).into());
    }
    let of_status = |(status, words): &(&str, &str)| format!("\n- {status}: {words}");
    let refused: String = EVERYWHERE.iter().map(of_status).collect();
    components.responses.insert(
        REFUSED.to_owned(),
        problem(&format!("Problem that any route may answer:\n{refused}")).into(),
    );
    components.responses.insert(PROBLEM.to_owned(), problem("The request cannot be answered.").into());
    components.headers.insert(TAG.to_owned(), tag().into());
    components.schemas.insert(FIGURE.to_owned(), figure().into());
    for (name, schema) in &mut components.schemas {
        if let (RefOr::T(schema), false) = (schema, requested.contains(name)) {
            absent_rather_than_null(schema);
        }
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

/// Names of all schemas that bodies of requests use.
fn request_schemas(document: &OpenApi) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut open: Vec<serde_json::Value> = Vec::new();
    let operations =
        document.paths.paths.values().flat_map(|item| {
            [&item.get, &item.post, &item.put, &item.patch, &item.delete].into_iter().flatten()
        });
    open.extend(operations.filter_map(|operation| serde_json::to_value(&operation.request_body).ok()));
    let schemas = document.components.as_ref().map(|components| &components.schemas);
    while let Some(value) = open.pop() {
        match value {
            serde_json::Value::Object(fields) => {
                let name = fields.get("$ref").and_then(|path| path.as_str()?.rsplit('/').next());
                if let Some(name) = name
                    && names.insert(name.to_owned())
                {
                    let schema = schemas.and_then(|schemas| schemas.get(name));
                    open.extend(schema.and_then(|schema| serde_json::to_value(schema).ok()));
                }
                open.extend(fields.into_iter().map(|(_, value)| value));
            }
            serde_json::Value::Array(values) => open.extend(values),
            _ => {}
        }
    }
    names
}

/// Removes `null` from the optional fields of an answer: they are left out instead.
fn absent_rather_than_null(answer: &mut Schema) {
    let Object { properties, required, .. } = match answer {
        Schema::Object(object) => object,
        Schema::AllOf(parts) => {
            for part in &mut parts.items {
                if let RefOr::T(part) = part {
                    absent_rather_than_null(part);
                }
            }
            return;
        }
        _ => return,
    };
    for (_, property) in properties.iter_mut().filter(|(name, _)| !required.contains(*name)) {
        match property {
            RefOr::T(Schema::Object(Object { schema_type, .. })) => {
                let SchemaType::Array(types) = schema_type else { continue };
                types.retain(|found| *found != Type::Null);
                if let [only] = &types[..] {
                    *schema_type = SchemaType::Type(only.clone());
                }
            }
            RefOr::T(Schema::OneOf(choice)) => {
                choice.items.retain(|item| !is_null(item));
                if let [RefOr::Ref(only)] = &choice.items[..] {
                    *property = RefOr::Ref(only.clone());
                }
            }
            _ => {}
        }
    }
}

fn is_null(schema: &RefOr<Schema>) -> bool {
    let RefOr::T(Schema::Object(object)) = schema else { return false };
    object.schema_type == SchemaType::Type(Type::Null)
}

/// Replaces a problem that has only a description of its own by a reference to the common one, with that description.
fn refer_to_problem(answer: &mut RefOr<Response>) {
    if let RefOr::T(Response { description, headers, content, .. }) = answer
        && headers.is_empty()
        && content.keys().eq([MEDIA_TYPE])
    {
        let mut problem = Ref::from_response_name(PROBLEM);
        problem.description = std::mem::take(description);
        *answer = RefOr::Ref(problem);
    }
}

/// Header that identifies a result.
fn tag() -> Header {
    HeaderBuilder::new()
        .schema(Some(Object::with_type(Type::String)))
        .description(Some(
            "Identity of a result that does not change any more: sent back in `If-None-Match` it is answered with 304.",
        ))
        .build()
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
        Some("wheel" | "verdict") => &Form::NUMBERS,
        _ => &Form::ALL,
    }
}

/// The forms of a result beside its json, and what goes with them.
fn add_forms(operation: &mut Operation, forms: &[Form]) {
    let responses = &mut operation.responses.responses;
    if let Some(RefOr::T(answer)) = responses.get_mut("200") {
        for form in forms.iter().filter(|form| **form != Form::Json) {
            // Binary content has no schema (OpenAPI 3.1, 4.8.14).
            let schema = match form {
                Form::Csv | Form::Svg => Some(RefOr::T(Object::with_type(Type::String).into())),
                Form::Plotly => Some(RefOr::Ref(Ref::from_schema_name(FIGURE))),
                _ => None,
            };
            answer
                .content
                .insert(form.media_type().to_owned(), ContentBuilder::new().schema(schema).build().into());
        }
        answer.headers.insert(TAG.to_owned(), RefOr::Ref(Ref::new(format!("#/components/headers/{TAG}"))));
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
