//! Lines and numbers of CalculiX's text files.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::error::{CalculixError, LineProblem};
use crate::package::lines::{Fault, Lines};
use crate::package::quote::quoted;

/// Text file read line by line, with its name and line number for errors.
pub(super) struct TextLines {
    path: PathBuf,
    lines: Lines<File>,
}

impl TextLines {
    pub(super) fn open(path: &Path) -> Result<Self, CalculixError> {
        Ok(Self { path: path.to_owned(), lines: Lines::new(open(path)?) })
    }

    /// Next line as bytes without its end.
    pub(super) fn next_bytes(&mut self) -> Result<Option<&[u8]>, CalculixError> {
        let path = &self.path;
        let too_long = |_| LineProblem::Words { expected: "lines of text; is this a text file?" };
        self.lines.next(too_long).map_err(|fault| match fault {
            Fault::Io(source) => CalculixError::Io { path: path.clone(), source },
            Fault::At { line, problem } => CalculixError::Line { path: path.clone(), line, problem },
        })
    }

    /// Next line as text; bytes that are not text (in comments) are replaced.
    pub(super) fn next(&mut self) -> Result<Option<String>, CalculixError> {
        Ok(self.next_bytes()?.map(|line| String::from_utf8_lossy(line).into_owned()))
    }

    /// Number of the line read last.
    pub(super) fn number(&self) -> u64 {
        self.lines.number()
    }

    /// Error for a problem on the line read last.
    pub(super) fn fault(&self, problem: LineProblem) -> CalculixError {
        CalculixError::Line { path: self.path.clone(), line: self.lines.number(), problem }
    }
}

/// Opens `path`, naming it in the error.
fn open(path: &Path) -> Result<File, CalculixError> {
    File::open(path).map_err(|source| CalculixError::Io { path: PathBuf::from(path), source })
}

/// Parses a node number.
pub(super) fn node(word: &str) -> Result<u64, LineProblem> {
    number(word, "a node number")
}

/// Parses an integer from 0.
pub(super) fn number(word: &str, expected: &'static str) -> Result<u64, LineProblem> {
    word.parse().map_err(|_| LineProblem::NotA { text: quoted(word), expected })
}

pub(super) use rubmap_mesh::inp::card::normal;

/// Parses a finite real number, in Fortran's spellings too.
pub(super) fn real(word: &str, expected: &'static str) -> Result<f64, LineProblem> {
    rubmap_mesh::fields::number(word).ok_or_else(|| LineProblem::NotA { text: quoted(word), expected })
}
