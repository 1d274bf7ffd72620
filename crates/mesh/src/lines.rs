//! Lines of a text file, with their numbers.

use std::borrow::Cow;

use crate::error::{MeshFileError, MeshProblem};

/// Lines from the beginning of a file, numbered from 1, without their ends.
#[derive(Clone)]
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    number: u64,
}

impl<'a> Lines<'a> {
    /// Lines of `bytes`, whose mark of the byte order is skipped.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 0 }
    }

    /// Number of the line that was read last.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Next line as bytes.
    pub(crate) fn bytes(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let mut halves = self.rest.splitn(2, |&b| b == b'\n');
        let line = halves.next()?;
        self.rest = halves.next().unwrap_or_default();
        self.number += 1;
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Next line of a block, as bytes.
    ///
    /// # Errors
    /// [`MeshProblem::CutShort`] where the file ends.
    pub(crate) fn expect(&mut self, card: &str, expected: &str) -> Result<&'a [u8], MeshFileError> {
        let cut = MeshProblem::CutShort { expected: expected.to_owned() };
        self.bytes().ok_or_else(|| cut.at(self.number, card))
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (u64, Cow<'a, str>);

    fn next(&mut self) -> Option<Self::Item> {
        let line = self.bytes()?;
        Some((self.number, String::from_utf8_lossy(line)))
    }
}

/// Words of a line, separated by commas or blanks.
pub(crate) fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::{Lines, words};

    #[test]
    fn ends_of_lines() {
        let lines: Vec<(u64, String)> = Lines::new(b"\xef\xbb\xbfa\r\n\nb\xff")
            .map(|(number, line)| (number, line.into_owned()))
            .collect();
        assert_eq!(lines, [(1, "a".to_owned()), (2, String::new()), (3, "b\u{fffd}".to_owned())]);
        assert_eq!(Lines::new(b"a\n").count(), 1);
        assert_eq!(words(" 1,2,  3\t4 ").collect::<Vec<_>>(), ["1", "2", "3", "4"]);
    }
}
