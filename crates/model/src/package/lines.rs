//! Lines of a text file, one at a time and with their numbers, in constant memory.

use std::io::{self, Read};

/// Longest line accepted. Matrix Market allows 1024 characters; tables and comments may be more generous.
pub(super) const LONGEST_LINE: usize = 64 * 1024;

/// Number of bytes read at a time.
const BUFFER: usize = 4 * LONGEST_LINE;

/// Reason why a file could not be read to its end: its storage, or a `problem` found on line `line`.
#[derive(Debug)]
pub(super) enum Fault<P> {
    Io(io::Error),
    At { line: u64, problem: P },
}

impl<P> From<io::Error> for Fault<P> {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Reader that splits a byte stream at `
/// `, dropping `\r` before it; never holds more than a buffer.
pub(super) struct Lines<R> {
    source: R,
    buffer: Vec<u8>,
    /// Start of the unread bytes of the buffer; `end` is their end.
    start: usize,
    end: usize,
    at_end: bool,
    number: u64,
}

impl<R: Read> Lines<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, buffer: vec![0; BUFFER], start: 0, end: 0, at_end: false, number: 0 }
    }

    /// Number of the line returned last, from 1.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Next line without its end; `None` at the end of the file.
    ///
    /// # Errors
    ///
    /// Errors of the source, and `too_long` for a line of more than [`LONGEST_LINE`] bytes.
    pub(super) fn next<P>(&mut self, too_long: fn(usize) -> P) -> Result<Option<&[u8]>, Fault<P>> {
        let mut searched = 0;
        let (length, consumed) = loop {
            let unread = &self.buffer[self.start..self.end];
            if let Some(at) = memchr::memchr(b'\n', &unread[searched..]) {
                break (searched + at, searched + at + 1);
            }
            searched = unread.len();
            if self.at_end {
                if searched == 0 {
                    return Ok(None);
                }
                break (searched, searched);
            }
            if searched > LONGEST_LINE {
                break (searched, searched);
            }
            self.fill()?;
        };
        self.number += 1;
        if length > LONGEST_LINE {
            return Err(Fault::At { line: self.number, problem: too_long(LONGEST_LINE) });
        }
        let line = &self.buffer[self.start..self.start + length];
        self.start += consumed;
        Ok(Some(line.strip_suffix(b"\r").unwrap_or(line)))
    }

    fn fill(&mut self) -> io::Result<()> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        loop {
            match self.source.read(&mut self.buffer[self.end..]) {
                Ok(0) => self.at_end = true,
                Ok(count) => self.end += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            }
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &[u8]) -> Result<Vec<(u64, String)>, Fault<usize>> {
        let mut lines = Lines::new(text);
        let mut all = Vec::new();
        while let Some(line) = lines.next(|limit| limit)? {
            let text = String::from_utf8_lossy(line).into_owned();
            all.push((lines.number(), text));
        }
        Ok(all)
    }

    #[test]
    fn every_kind_of_line_end_gives_the_same_lines() {
        let expected: Vec<_> = [(1, "a"), (2, ""), (3, "b")].map(|(n, s)| (n, s.to_owned())).into();
        for text in ["a\n\nb", "a\n\nb\n", "a\r\n\r\nb\r\n", "a\n\r\nb\r"] {
            assert_eq!(lines(text.as_bytes()).expect("readable"), expected, "{text:?}");
        }
        assert!(lines(b"").expect("readable").is_empty());
    }

    #[test]
    fn lines_that_straddle_buffers_are_whole() {
        let text: String = (0..100_000).map(|k| format!("{k} {}\n", "x".repeat(k % 37))).collect();
        let read = lines(text.as_bytes()).expect("readable");
        assert!(read.iter().map(|(_, s)| s.as_str()).eq(text.lines()));
    }

    #[test]
    fn a_line_without_end_is_refused_without_being_held() {
        let endless = io::repeat(b'7').take(1 << 30);
        let mut lines = Lines::new(endless);
        assert!(matches!(lines.next(|limit| limit), Err(Fault::At { line: 1, problem: LONGEST_LINE })));
    }
}
