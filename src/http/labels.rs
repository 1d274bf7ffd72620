//! Labels of jobs and models: beside the request for a job, in the query of an upload, or changed later.

use std::collections::BTreeSet;

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;
use utoipa::openapi::{Object, RefOr, Schema};
use utoipa::{IntoParams, PartialSchema, ToSchema};

use super::problem::{Kind, Problem};
use crate::analysis::error::Violation;
use crate::store::labels::{LabelChanges, Labels};

/// Longest name, in characters.
const NAME: usize = 200;

/// Largest number of tags.
const TAGS: usize = 20;

/// Longest tag, in characters.
const TAG: usize = 50;

/// Longest notes, in characters.
const NOTES: usize = 4000;

/// Labels that come with a request.
#[derive(Debug, Default, Deserialize, ToSchema)]
#[serde(default)]
pub(super) struct Given {
    /// Name of the job or model; a job without one is called by model, speeds and clearance.
    #[schema(max_length = 200)]
    name: Option<String>,
    /// Words to group by, of up to 50 characters without commas.
    #[schema(max_items = 20)]
    tags: Vec<String>,
    /// Notes: anything worth remembering.
    #[schema(max_length = 4000)]
    notes: Option<String>,
}

impl Given {
    /// Labels that were given.
    ///
    /// # Errors
    /// If a label is not valid.
    pub(super) fn labels(self) -> Result<Labels, Problem> {
        let labels = Labels { name: self.name, tags: self.tags, notes: self.notes };
        let violations = check(labels.name.as_deref(), &labels.tags, labels.notes.as_deref());
        if violations.is_empty() { Ok(labels) } else { Err(refused(violations)) }
    }
}

/// Labels of an upload, and settings of a bare mesh.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct LabelQuery {
    /// Name of the model in place of that of an uploaded package, in up to 200 characters.
    name: Option<String>,
    /// Words to group an uploaded package by: up to 20, with commas between them.
    tags: Option<String>,
    /// Notes on an uploaded package: anything worth remembering, in up to 4000 characters.
    notes: Option<String>,
    /// Settings of the model of a bare mesh (`application/octet-stream`): a JSON object of the schema `MeshSettings`; `top_speed_rad_s` at
    /// least.
    pub(super) settings: Option<String>,
}

impl LabelQuery {
    /// Reads the labels.
    ///
    /// # Errors
    /// If a label is not valid.
    pub(super) fn labels(self) -> Result<Labels, Problem> {
        let tags = self.tags.as_deref().unwrap_or_default().split(',').filter(|tag| !tag.is_empty());
        let labels =
            Labels { name: self.name, tags: tags.map(ToOwned::to_owned).collect(), notes: self.notes };
        match check(labels.name.as_deref(), &labels.tags, labels.notes.as_deref()).first() {
            None => Ok(labels),
            Some(Violation { pointer, message }) => {
                let parameter = pointer.split('/').nth(1).unwrap_or_default();
                Err(Problem::parameter(parameter, message.as_str()))
            }
        }
    }

    /// Name of the model, if the query has one.
    pub(super) fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Whether the query has neither labels nor settings.
    pub(super) fn is_empty(&self) -> bool {
        self.name.is_none() && self.tags.is_none() && self.notes.is_none() && self.settings.is_none()
    }
}

/// Changes of labels as a merge patch (RFC 7396): a label that is left out stays, null removes it.
#[derive(Debug, Default, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct LabelPatch {
    /// Name of the job or model.
    #[schema(max_length = 200)]
    #[serde(deserialize_with = "some")]
    #[schema(value_type = Option<String>)]
    name: Option<Option<String>>,
    /// Words to group by, which replace those there are, of up to 50 characters without commas.
    #[schema(max_items = 20)]
    #[serde(deserialize_with = "some")]
    #[schema(value_type = Option<Vec<String>>)]
    tags: Option<Option<Vec<String>>>,
    /// Notes: anything worth remembering.
    #[schema(max_length = 4000)]
    #[serde(deserialize_with = "some")]
    #[schema(value_type = Option<String>)]
    notes: Option<Option<String>>,
}

/// Reads a field that is present: null is something else than a field that is left out.
fn some<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

impl LabelPatch {
    /// Reads the changes.
    ///
    /// # Errors
    /// If a label is not valid.
    pub(super) fn changes(self) -> Result<LabelChanges, Problem> {
        let changes = LabelChanges {
            name: self.name,
            tags: self.tags.map(Option::unwrap_or_default),
            notes: self.notes,
        };
        let text = |change: &Option<Option<String>>| change.clone().flatten();
        let (name, notes) = (text(&changes.name), text(&changes.notes));
        let tags = changes.tags.as_deref().unwrap_or_default();
        let violations = check(name.as_deref(), tags, notes.as_deref());
        if violations.is_empty() { Ok(changes) } else { Err(refused(violations)) }
    }
}

fn refused(violations: Vec<Violation>) -> Problem {
    Problem::violations(Kind::InvalidRequest, violations)
}

fn check(name: Option<&str>, tags: &[String], notes: Option<&str>) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut refuse = |pointer: String, message: &str| found.push(Violation::new(pointer, message));
    if name.is_some_and(|name| name.trim().is_empty() || is_longer(name, NAME) || has_control(name)) {
        refuse("/name".to_owned(), "a name has 1 to 200 characters, not all of them blank, on one line");
    }
    if tags.len() > TAGS {
        refuse("/tags".to_owned(), "there may be 20 tags at most");
    }
    let mut seen = BTreeSet::new();
    for (index, tag) in tags.iter().enumerate() {
        let pointer = || format!("/tags/{index}");
        if tag.trim().is_empty() || is_longer(tag, TAG) || has_control(tag) || tag.contains(',') {
            refuse(
                pointer(),
                "a tag has 1 to 50 characters, not all of them blank, on one line, and no commas",
            );
        } else if !seen.insert(tag) {
            refuse(pointer(), "this tag is given twice; give it once");
        }
    }
    if notes.is_some_and(|notes| is_longer(notes, NOTES)) {
        refuse("/notes".to_owned(), "notes have 4000 characters at most");
    }
    found
}

fn is_longer(text: &str, most: usize) -> bool {
    text.chars().nth(most).is_some()
}

fn has_control(text: &str) -> bool {
    text.chars().any(char::is_control)
}

/// Adds the fields of labels to the schema of a request.
pub(super) fn add_labels(request: &mut Object) {
    if let RefOr::T(Schema::Object(given)) = Given::schema() {
        request.properties.extend(given.properties);
    }
}

/// Takes the labels out of the body of a request: the request as JSON without them, and the labels.
///
/// # Errors
/// A body that is no object, or labels of other types. Fields given twice were refused before, by the contract.
pub(super) fn apart(body: &[u8]) -> serde_json::Result<(String, Given)> {
    let Fields(fields) = serde_json::from_slice(body)?;
    let (mut given, mut request) = (Given::default(), Vec::new());
    for (name, value) in fields {
        match name.as_str() {
            "name" => given.name = serde_json::from_str(value.get())?,
            "tags" => given.tags = serde_json::from_str(value.get())?,
            "notes" => given.notes = serde_json::from_str(value.get())?,
            _ => request.push(format!("{}:{}", serde_json::to_string(&name)?, value.get())),
        }
    }
    Ok((format!("{{{}}}", request.join(",")), given))
}

/// Fields of an object in their order, with their values as they are written.
struct Fields<'a>(Vec<(String, &'a RawValue)>);

impl<'de> Deserialize<'de> for Fields<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;

        impl<'de> Visitor<'de> for InOrder {
            type Value = Fields<'de>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Fields<'de>, A::Error> {
                let mut fields: Vec<(String, &RawValue)> = Vec::new();
                while let Some((name, value)) = map.next_entry::<String, _>()? {
                    fields.push((name, value));
                }
                Ok(Fields(fields))
            }
        }

        deserializer.deserialize_map(InOrder)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_no_part_of_a_request() {
        let body =
            r#"{"model": "m", "tags": ["a", "b"], "speeds": {"values": [0.1, 1e300, 3.00]}, "name": "Mine"}"#;
        let (request, given) = apart(body.as_bytes()).unwrap();
        assert_eq!(request, r#"{"model":"m","speeds":{"values": [0.1, 1e300, 3.00]}}"#);
        let labels = given.labels().unwrap();
        assert_eq!(labels.tags, ["a", "b"]);
        assert_eq!((labels.name.as_deref(), labels.notes), (Some("Mine"), None));
        let (request, given) = apart(br#"{"notes": "n"}"#).unwrap();
        assert_eq!((request.as_str(), given.notes.as_deref()), ("{}", Some("n")));
        assert!(apart(b"[]").is_err() && apart(br#"{"tags": 1}"#).is_err());
    }

    #[test]
    fn labels_that_cannot_be_are_pointed_at() {
        let tags = |tags: &[&str]| tags.iter().map(ToString::to_string).collect::<Vec<_>>();
        let long = |length: usize| "ä".repeat(length);
        let (name, tag, notes) = (long(NAME), long(TAG), long(NOTES));
        assert!(check(Some(&name), &tags(&[&tag, "a b"]), Some(&notes)).is_empty());
        let wrong =
            check(Some("two\nlines"), &tags(&["a", " ", "a", "b,c", &long(TAG + 1)]), Some(&long(NOTES + 1)));
        let pointers: Vec<_> = wrong.iter().map(|violation| violation.pointer.as_str()).collect();
        assert_eq!(pointers, ["/name", "/tags/1", "/tags/2", "/tags/3", "/tags/4", "/notes"]);
        assert_eq!(check(Some(&long(NAME + 1)), &vec!["t".to_owned(); TAGS + 1], None)[1].pointer, "/tags");
    }
}
