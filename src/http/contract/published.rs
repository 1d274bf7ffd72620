//! Shapes of bodies and parameters, read from the published contract.

use std::collections::BTreeMap;

use serde_json::Value;

use super::shape::Shape;

/// Contract of requests: the shapes of their bodies and parameters.
#[derive(Debug)]
pub struct Contract {
    /// JSON bodies by the name of their schema.
    bodies: BTreeMap<String, Shape>,
    /// Query parameters by path and method.
    pub(super) parameters: BTreeMap<String, BTreeMap<String, Vec<Parameter>>>,
}

/// A parameter of a query string.
#[derive(Debug)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) shape: Shape,
}

impl Contract {
    /// Reads the contract from an `OpenAPI` document.
    pub fn of(document: &Value) -> Self {
        let schemas = &document["components"]["schemas"];
        let mut contract = Self { bodies: BTreeMap::new(), parameters: BTreeMap::new() };
        for (path, methods) in document["paths"].as_object().into_iter().flatten() {
            for (method, operation) in methods.as_object().into_iter().flatten() {
                let body = &operation["requestBody"]["content"]["application/json"]["schema"];
                if let Some(name) = body["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
                    contract.bodies.entry(name.to_owned()).or_insert_with(|| Shape::of(body, schemas));
                }
                let parameters = operation["parameters"].as_array().into_iter().flatten();
                let parameters = parameters.map(|parameter| referred(parameter, document));
                let parameters = parameters.filter(|parameter| parameter["in"] == "query");
                let parameters = parameters.map(|parameter| Parameter {
                    name: parameter["name"].as_str().unwrap_or_default().to_owned(),
                    shape: Shape::of(&parameter["schema"], schemas),
                });
                let methods = contract.parameters.entry(path.clone()).or_default();
                methods.insert(method.to_uppercase(), parameters.collect());
            }
        }
        contract
    }

    /// Shape of the JSON body whose schema has this name.
    pub(crate) fn body(&self, name: &str) -> Option<&Shape> {
        self.bodies.get(name)
    }
}

/// The part of `document` that a reference leads to; what is no reference is itself.
fn referred<'a>(part: &'a Value, document: &'a Value) -> &'a Value {
    let path = part["$ref"].as_str().and_then(|path| path.strip_prefix('#'));
    path.and_then(|path| document.pointer(path)).unwrap_or(part)
}
