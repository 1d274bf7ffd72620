//! Checks of query strings: a parameter that its route does not know, or a value that it cannot take, is refused and never ignored.

use std::sync::Arc;

use axum::extract::{MatchedPath, Query, Request, State};
use axum::http::{Method, Uri};
use axum::middleware::Next;
use axum::response::Response;

use super::super::problem::{Kind, Problem, excerpt};
use super::published::{Contract, Parameter};
use super::shape::{Scalar, Shape};

/// Middleware around all routes: checks the query string against the contract. A path that is not in the contract takes no parameters.
pub(crate) async fn refuse_unknown_parameters(
    contract: State<Arc<Contract>>,
    path: Option<MatchedPath>,
    request: Request,
    next: Next,
) -> Result<Response, Problem> {
    if let Some(path) = path {
        let methods = contract.parameters.get(path.as_str());
        // A method that a path does not have is another problem.
        let method = if request.method() == Method::HEAD { &Method::GET } else { request.method() };
        match methods.map(|methods| methods.get(method.as_str())) {
            Some(Some(parameters)) => check(parameters, request.uri())?,
            Some(None) => {}
            None => check(&[], request.uri())?,
        }
    }
    Ok(next.run(request).await)
}

fn check(parameters: &[Parameter], query: &Uri) -> Result<(), Problem> {
    let Query(given) = Query::<Vec<(String, String)>>::try_from_uri(query)
        .map_err(|error| Problem::new(Kind::InvalidParameter, error.body_text()))?;
    for (index, (name, value)) in given.iter().enumerate() {
        let Some(parameter) = parameters.iter().find(|parameter| parameter.name == *name) else {
            let names: Vec<_> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
            let what_exists = match &names[..] {
                [] => "takes no parameters".to_owned(),
                names => format!("takes {}", names.join(", ")),
            };
            let detail = format!("there is no such parameter; this path {what_exists}");
            return Err(Problem::parameter(&excerpt(name), detail));
        };
        if given[..index].iter().any(|(earlier, _)| earlier == name) {
            return Err(Problem::parameter(name, "this parameter is given twice; give it once"));
        }
        let shape = &parameter.shape;
        if !admits(shape, value) {
            let detail = format!("expected {}, not {:?}", without_null(shape), excerpt(value));
            return Err(Problem::parameter(name, detail));
        }
    }
    Ok(())
}

/// Whether `text` may be read as a value of this shape.
fn admits(shape: &Shape, text: &str) -> bool {
    let finite = text.parse().ok().filter(|number: &f64| number.is_finite());
    shape.admits(Scalar::Text(text))
        || text.parse().is_ok_and(|truth| shape.admits(Scalar::Truth(truth)))
        || text.parse().is_ok_and(|number| shape.admits(Scalar::Whole(number)))
        || finite.is_some_and(|number| shape.admits(Scalar::Number(number)))
}

/// Shape of a parameter as messages describe it: without `null`, which only means that the parameter may be left out.
fn without_null(shape: &Shape) -> Shape {
    match shape {
        Shape::OneOf(choices) => {
            Shape::OneOf(choices.iter().filter(|choice| **choice != Shape::Null).cloned().collect())
        }
        shape => shape.clone(),
    }
}
