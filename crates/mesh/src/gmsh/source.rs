//! Sections, rows and numbers of a file, the same for ASCII and binary.

use std::borrow::Cow;

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

/// Most bytes of the name of a section.
const LONGEST_NAME: usize = 100;

/// Rest of a file.
///
/// A row is a line of an ASCII file; a binary file has rows where the format has lines of text in it all the same.
pub(super) struct Source<'a> {
    rest: &'a [u8],
    /// Number of the line at which the rest begins.
    next: u64,
    /// Rest of the row, and its number.
    row: &'a [u8],
    line: u64,
    section: String,
    binary: bool,
}

impl<'a> Source<'a> {
    /// Whole file.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Self { rest, next: 1, row: &[], line: 1, section: String::new(), binary: false }
    }

    /// Whether numbers are binary.
    pub(super) fn is_binary(&self) -> bool {
        self.binary
    }

    /// Takes numbers as binary ones from here.
    pub(super) fn set_binary(&mut self) {
        self.binary = true;
    }

    /// Number of the current line; 0 in a binary file.
    pub(super) fn line(&self) -> u64 {
        if self.binary { 0 } else { self.line }
    }

    /// Error here.
    pub(super) fn error(&self, problem: MeshProblem) -> MeshFileError {
        let card = if self.section.is_empty() { String::new() } else { format!("${}", self.section) };
        problem.at(self.line(), &fields::quoted(&card))
    }

    fn cut_short(&self, expected: &str) -> MeshFileError {
        self.error(MeshProblem::CutShort { expected: expected.to_owned() })
    }

    fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let mut parts = self.rest.splitn(2, |&byte| byte == b'\n');
        let line = parts.next().unwrap_or_default();
        self.rest = parts.next().unwrap_or_default();
        self.line = self.next;
        self.next += 1;
        Some(line.trim_ascii())
    }

    fn next_filled_line(&mut self) -> Option<&'a [u8]> {
        loop {
            match self.next_line()? {
                b"" => {}
                line => return Some(line),
            }
        }
    }

    /// Name of the next section, without its `$`.
    pub(super) fn section(&mut self) -> Option<String> {
        loop {
            if let Some(name) = self.next_line()?.strip_prefix(b"$") {
                // A longer name is no section of Gmsh's; its end is searched for, which costs as much as it is long.
                let name = name.get(..LONGEST_NAME).unwrap_or(name);
                self.section = String::from_utf8_lossy(name).into_owned();
                return Some(self.section.clone());
            }
        }
    }

    /// Expects the end of the section.
    pub(super) fn end(&mut self) -> Result<(), MeshFileError> {
        let end = format!("$End{}", self.section);
        match self.next_filled_line() {
            None => Err(self.cut_short(&end)),
            Some(line) if line == end.as_bytes() => Ok(()),
            Some(_) => Err(self.error(MeshProblem::Expected { expected: end })),
        }
    }

    /// Skips the rest of the section.
    pub(super) fn skip(&mut self) -> Result<(), MeshFileError> {
        let end = format!("$End{}", self.section);
        let mut from = 0;
        loop {
            let rest = self.rest.get(from..).unwrap_or_default();
            let Some(place) = rest.iter().position(|&byte| byte == b'$') else {
                return Err(self.cut_short(&fields::quoted(&end)));
            };
            let (before, here) = rest.split_at(place);
            self.next += before.iter().filter(|&&byte| byte == b'\n').count() as u64;
            if here.starts_with(end.as_bytes()) {
                self.rest = here;
                return self.end();
            }
            from += place + 1;
        }
    }

    /// Begins a row of text.
    pub(super) fn text_row(&mut self, expected: &str) -> Result<(), MeshFileError> {
        match self.next_filled_line() {
            Some(row) => {
                self.row = row;
                Ok(())
            }
            None => Err(self.cut_short(expected)),
        }
    }

    /// Begins a row of numbers.
    pub(super) fn row(&mut self, expected: &str) -> Result<(), MeshFileError> {
        if self.binary { Ok(()) } else { self.text_row(expected) }
    }

    /// Expects the end of a row of numbers.
    pub(super) fn end_row(&self) -> Result<(), MeshFileError> {
        if self.binary || self.row.trim_ascii().is_empty() {
            return Ok(());
        }
        let rest = fields::quoted(&String::from_utf8_lossy(self.row.trim_ascii()));
        Err(self.error(MeshProblem::Expected { expected: format!("the end of the line before \"{rest}\"") }))
    }

    /// Rest of the row as text.
    pub(super) fn rest_of_row(&mut self) -> String {
        String::from_utf8_lossy(std::mem::take(&mut self.row).trim_ascii()).into_owned()
    }

    /// Next word of the row.
    pub(super) fn word(&mut self, expected: &str) -> Result<Cow<'a, str>, MeshFileError> {
        let row = self.row.trim_ascii_start();
        if row.is_empty() {
            return Err(match self.rest {
                [] => self.cut_short(expected),
                _ => self.error(MeshProblem::Expected { expected: expected.to_owned() }),
            });
        }
        let length = row.iter().position(u8::is_ascii_whitespace).unwrap_or(row.len());
        let (word, rest) = row.split_at(length);
        self.row = rest;
        Ok(String::from_utf8_lossy(word))
    }

    fn take<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], MeshFileError> {
        let (taken, rest) = self.rest.split_first_chunk().ok_or_else(|| self.cut_short(expected))?;
        self.rest = rest;
        Ok(*taken)
    }

    /// Integer of text from 0, also in a binary file.
    pub(super) fn text_size(&mut self, expected: &'static str) -> Result<u64, MeshFileError> {
        let word = self.word(expected)?;
        fields::integer(&word, expected).map_err(|problem| self.error(problem))
    }

    /// Integer from 0, of eight bytes in a binary file.
    pub(super) fn size(&mut self, expected: &'static str) -> Result<u64, MeshFileError> {
        if self.binary { Ok(u64::from_le_bytes(self.take(expected)?)) } else { self.text_size(expected) }
    }

    /// Integer, of four bytes in a binary file.
    pub(super) fn integer(&mut self, expected: &'static str) -> Result<i64, MeshFileError> {
        if self.binary {
            return Ok(i32::from_le_bytes(self.take(expected)?).into());
        }
        let word = self.word(expected)?;
        let not = || MeshProblem::NotA { text: fields::quoted(&word), expected };
        word.parse().map_err(|_| self.error(not()))
    }

    /// Integer from 0, of four bytes in a binary file.
    pub(super) fn small(&mut self, expected: &'static str) -> Result<u64, MeshFileError> {
        let integer = self.integer(expected)?;
        let not = |_| MeshProblem::NotA { text: integer.to_string(), expected };
        u64::try_from(integer).map_err(|e| self.error(not(e)))
    }

    /// Finite real number.
    pub(super) fn real(&mut self, expected: &'static str) -> Result<f64, MeshFileError> {
        if !self.binary {
            let word = self.word(expected)?;
            return fields::real(&word, expected).map_err(|problem| self.error(problem));
        }
        let number = f64::from_le_bytes(self.take(expected)?);
        if number.is_finite() {
            return Ok(number);
        }
        Err(self.error(MeshProblem::NotA { text: number.to_string(), expected }))
    }

    /// Refuses a count of things, each of so many bytes at least in a binary file, for which the rest of the file is too short.
    pub(super) fn claim(&self, count: u64, bytes: u64, things: &str) -> Result<(), MeshFileError> {
        let least = if self.binary { bytes } else { 1 };
        if count.saturating_mul(least) > self.rest.len() as u64 {
            return Err(self.cut_short(&format!("the end of {count} {things}")));
        }
        Ok(())
    }
}
