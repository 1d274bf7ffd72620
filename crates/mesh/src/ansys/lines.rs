//! Lines of an archive, numbered, and the fields of a command.

use crate::error::{MeshFileError, MeshProblem};

/// Lines of a file, one after the other.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: u64,
}

impl<'a> Lines<'a> {
    /// Lines of a whole file.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 0 }
    }

    /// Number of the line that was taken last, from 1.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Next line, without its end.
    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let mut parts = self.rest.splitn(2, |&b| b == b'\n');
        let line = parts.next().unwrap_or_default();
        self.rest = parts.next().unwrap_or_default();
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Next line of a block.
    ///
    /// # Errors
    /// [`MeshProblem::CutShort`] where the file ends.
    pub(super) fn expect(&mut self, card: &str, expected: &str) -> Result<&'a [u8], MeshFileError> {
        let cut = MeshProblem::CutShort { expected: expected.to_owned() };
        self.next().ok_or_else(|| cut.at(self.number, card))
    }
}

/// Fields of a command, without blanks around them.
pub(super) struct Fields<'a>(Vec<&'a str>);

impl<'a> Fields<'a> {
    /// Fields of a line, without its comment.
    pub(super) fn of(line: &'a str) -> Self {
        let command = line.split('!').next().unwrap_or_default();
        Self(command.split(',').map(str::trim).collect())
    }

    /// Field at a place, from 0, which is the command's name; empty where it is left out.
    pub(super) fn get(&self, place: usize) -> &'a str {
        self.0.get(place).copied().unwrap_or_default()
    }

    /// Field in capitals.
    pub(super) fn upper(&self, place: usize) -> String {
        self.get(place).to_uppercase()
    }

    /// Fields from a place on.
    pub(super) fn from(&self, place: usize) -> &[&'a str] {
        self.0.get(place..).unwrap_or_default()
    }

    /// Whether a field is there and has text.
    pub(super) fn has(&self, place: usize) -> bool {
        !self.get(place).is_empty()
    }
}
