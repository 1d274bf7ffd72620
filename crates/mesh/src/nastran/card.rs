//! Card: name and fields.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::place::Place;

/// Card with the fields of its continuations.
#[derive(Debug)]
pub(super) struct Card {
    /// Name in capitals, without the `*` of the long format.
    pub(super) name: String,
    /// Fields behind the name, without those for continuation.
    pub(super) fields: Vec<String>,
    /// Place of its first line.
    pub(super) place: Place,
}

impl Card {
    /// Field behind the name, from 1; empty where there is none.
    pub(super) fn text(&self, field: usize) -> &str {
        field.checked_sub(1).and_then(|k| self.fields.get(k)).map_or("", String::as_str)
    }

    /// Error of this card.
    pub(super) fn error(&self, problem: MeshProblem) -> MeshFileError {
        self.place.error(problem, &self.name)
    }

    /// Error that names what is expected.
    pub(super) fn expected(&self, expected: &str) -> MeshFileError {
        self.error(MeshProblem::Expected { expected: expected.to_owned() })
    }

    /// Refusal of what a model cannot carry over.
    pub(super) fn not_carried(&self, what: &str, advice: &'static str) -> MeshFileError {
        self.error(MeshProblem::NotCarried { what: what.to_owned(), advice })
    }

    /// Integer from 0, if the field is filled.
    pub(super) fn optional(
        &self,
        field: usize,
        expected: &'static str,
    ) -> Result<Option<u64>, MeshFileError> {
        match self.text(field) {
            "" => Ok(None),
            text => fields::integer(text, expected).map(Some).map_err(|problem| self.error(problem)),
        }
    }

    /// Integer from 0.
    pub(super) fn integer(&self, field: usize, expected: &'static str) -> Result<u64, MeshFileError> {
        self.optional(field, expected)?.ok_or_else(|| self.expected(expected))
    }

    /// Real number, if the field is filled.
    pub(super) fn real(&self, field: usize, expected: &'static str) -> Result<Option<f64>, MeshFileError> {
        match self.text(field) {
            "" => Ok(None),
            text => fields::real(text, expected).map(Some).map_err(|problem| self.error(problem)),
        }
    }

    /// Three coordinates from a field on; an empty one is 0.
    pub(super) fn point(&self, field: usize) -> Result<[f64; 3], MeshFileError> {
        let mut point = [0.0; 3];
        for (k, x) in point.iter_mut().enumerate() {
            *x = self.real(field + k, "a coordinate")?.unwrap_or_default();
        }
        Ok(point)
    }
}
