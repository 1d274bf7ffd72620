//! Choice of one matrix from a file of several.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

/// Most names that a refusal lists.
const LISTED: usize = 20;

/// Name of the matrix to read: the one asked for, or the only one.
pub(super) fn of(mut names: Vec<String>, asked: Option<&str>, format: &str) -> Result<String, MeshFileError> {
    if let Some(asked) = asked {
        let found = names.into_iter().find(|name| name.eq_ignore_ascii_case(asked.trim()));
        let missing = || MeshProblem::NoSuch { what: "matrix", name: fields::quoted(asked) };
        return found.ok_or_else(|| missing().at(0, format));
    }
    match (names.pop(), names.len()) {
        (Some(only), 0) => Ok(only),
        (last, _) => {
            names.extend(last);
            let mut listed: Vec<String> =
                names.iter().take(LISTED).map(|name| fields::quoted(name)).collect();
            if names.len() > LISTED {
                listed.push("…".to_owned());
            }
            Err(MeshProblem::WhichMatrix { names: listed.join(", ") }.at(0, format))
        }
    }
}
