//! Places in the file and in the files that it includes.

use std::rc::Rc;

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

/// Line of a file.
#[derive(Debug, Clone, Default)]
pub(super) struct Place {
    /// Number of the line, from 1.
    pub(super) line: u64,
    /// Name of the file, if it is an included one.
    pub(super) file: Option<Rc<str>>,
}

impl Place {
    /// Error of a card here.
    pub(super) fn error(&self, problem: MeshProblem, card: &str) -> MeshFileError {
        let card = fields::quoted(card);
        match &self.file {
            None => problem.at(self.line, &card),
            Some(file) => problem.at(self.line, format!("{card} in {}", fields::quoted(file)).trim_start()),
        }
    }
}
