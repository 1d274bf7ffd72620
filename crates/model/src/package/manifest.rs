//! Reader of `sector.json`, with the field of every error as a JSON pointer.

use serde::de::DeserializeOwned;

use super::error::{ManifestProblem, PackageError};
use super::quote::{bounded_message, quoted};

/// Parses the manifest's text.
pub(super) fn parse<T: DeserializeOwned>(text: &[u8]) -> Result<T, PackageError> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let mut json = serde_json::Deserializer::from_slice(text);
    let manifest = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let mut field = pointer(error.path());
        let error = error.into_inner();
        if let Some(name) = missing_field(&error) {
            field = format!("{field}/{name}");
        }
        syntax(field, &error)
    })?;
    json.end().map_err(|error| syntax(String::new(), &error))?;
    Ok(manifest)
}

fn syntax(field: String, error: &serde_json::Error) -> PackageError {
    let text = error.to_string();
    let message = text.rsplit_once(" at line ").map_or(text.as_str(), |(message, _)| message);
    // The names of Rust types mean nothing to those who write packages.
    let message = message
        .replace("expected usize", "expected an integer from 0")
        .replace("expected u64", "expected an integer from 0")
        .replace("expected f64", "expected a number");
    PackageError::manifest(
        field,
        ManifestProblem::Syntax {
            message: bounded_message(&message),
            line: error.line(),
            column: error.column(),
        },
    )
}

/// Path of a missing field, which serde names only in its message; the path it reports is the object that lacks the field.
fn missing_field(error: &serde_json::Error) -> Option<String> {
    let text = error.to_string();
    let (name, _) = text.strip_prefix("missing field `")?.split_once('`')?;
    Some(name.to_owned())
}

/// JSON pointer of a path (RFC 6901).
fn pointer(path: &serde_path_to_error::Path) -> String {
    use serde_path_to_error::Segment;
    let mut pointer = String::new();
    for segment in path {
        match segment {
            Segment::Seq { index } => pointer += &format!("/{index}"),
            Segment::Map { key } => {
                pointer += &format!("/{}", quoted(key).replace('~', "~0").replace('/', "~1"))
            }
            Segment::Enum { .. } | Segment::Unknown => {}
        }
    }
    pointer
}

#[cfg(test)]
mod tests {
    use super::super::raw::Manifest;
    use super::*;

    fn refused(text: &str) -> (String, String) {
        let error = parse::<Manifest>(text.as_bytes()).expect_err("refused");
        (error.field().unwrap_or_default().to_owned(), error.to_string())
    }

    #[test]
    fn errors_point_at_their_field() {
        assert_eq!(refused("{\"sectors\": -1}").0, "/sectors");
        assert_eq!(refused("{\"units\": {\"length\": \"mm\"}}").0, "/units/force");
        assert_eq!(refused("{\"cyclic\": [[1, 2], [3]]}").0, "/cyclic/1");
        assert_eq!(
            refused("{\"contact\": [{\"node\": 1, \"normal\": [0, \"1\", 0]}]}").0,
            "/contact/0/normal/1"
        );
        assert_eq!(refused("{\"colour\": 1}").0, "/colour");
        assert_eq!(refused("{").0, "");
        assert_eq!(
            refused("{\"frame\": \"polar\"}"),
            (
                "/frame".into(),
                "sector.json, /frame: unknown variant `polar`, expected `cartesian` or `cylindrical` (line 1, column 17)"
                    .into()
            )
        );
    }
}
