//! Reader of one array in numpy's npy format, streamed.
//!
//! The header is a Python literal. Only the form numpy itself writes is understood, in one pass over at most
//! [`LONGEST_HEADER`] bytes: general literal parsers (npyz 0.9) need exponential time on nested brackets.
//!
//! With a check of the header before it, npyz could do two of the steps: find the value of a key, and turn bytes into numbers. The check
//! would need all the rest (mark, version, length of the header), errors their own messages, and the number of elements and the bytes after
//! them would still have to be compared with the header here.

use std::io::{self, Read};

use super::error::{ExpectedShape, NpzProblem};
use super::quote::quoted;

/// Longest header, numpy's own limit for headers it does not trust.
const LONGEST_HEADER: usize = 10_000;

/// Number of elements read at a time.
const CHUNK: usize = 8192;

/// Reason why an array could not be read: its storage, or its content.
#[derive(Debug)]
pub(super) enum NpyFault {
    Io(io::Error),
    Problem(NpzProblem),
}

impl From<io::Error> for NpyFault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<NpzProblem> for NpyFault {
    fn from(problem: NpzProblem) -> Self {
        Self::Problem(problem)
    }
}

/// Array whose header has been read and whose elements come next.
pub(super) struct Npy<'a> {
    name: &'static str,
    source: &'a mut dyn Read,
    /// Name of the element type in numpy, such as `<f8`.
    descr: String,
    shape: Vec<u64>,
}

impl<'a> Npy<'a> {
    /// Reads the header; `name` is the name of the array in errors.
    pub(super) fn open(name: &'static str, source: &'a mut dyn Read) -> Result<Self, NpyFault> {
        let wrong = |reason| NpyFault::Problem(NpzProblem::NotNpy { array: name, reason });
        let mut magic = [0; 8];
        if !fill(source, &mut magic)? || magic[..6] != *b"\x93NUMPY" {
            return Err(wrong("it does not start with numpy's mark"));
        }
        let mut length = [0; 4];
        let bytes = if magic[6] == 1 { 2 } else { 4 };
        if !matches!(magic[6], 1..=3) || !fill(source, &mut length[..bytes])? {
            return Err(wrong("its version is not known"));
        }
        let length = u32::from_le_bytes(length) as usize;
        if length > LONGEST_HEADER {
            return Err(wrong("its header is too long"));
        }
        let mut header = vec![0; length];
        if !fill(source, &mut header)? {
            return Err(wrong("its header is cut off"));
        }
        let header = String::from_utf8(header).map_err(|_| wrong("its header is no text"))?;
        let descr = value(&header, "descr").ok_or_else(|| wrong("its header names no type"))?;
        let shape =
            value(&header, "shape").and_then(tuple).ok_or_else(|| wrong("its header names no shape"))?;
        let descr = descr.strip_prefix(['\'', '"']).and_then(|text| text.split(['\'', '"']).next());
        Ok(Self { name, source, descr: descr.unwrap_or("a structure").to_owned(), shape })
    }

    /// Number of elements of a one-dimensional array.
    pub(super) fn length(&self) -> Result<u64, NpzProblem> {
        match self.shape[..] {
            [length] => Ok(length),
            _ => Err(self.shape_problem(ExpectedShape::OneDimensional)),
        }
    }

    /// Problem of a shape other than `expected`.
    pub(super) fn shape_problem(&self, expected: ExpectedShape) -> NpzProblem {
        NpzProblem::Shape { array: self.name, found: self.shape.clone(), expected }
    }

    /// Passes every integer to `take`, with its position.
    pub(super) fn integers(
        self,
        mut take: impl FnMut(u64, i64) -> Result<(), NpzProblem>,
    ) -> Result<(), NpyFault> {
        match &self.descr[..] {
            "<i4" => self.elements(|k, bytes| take(k, i32::from_le_bytes(bytes).into())),
            ">i4" => self.elements(|k, bytes| take(k, i32::from_be_bytes(bytes).into())),
            "<i8" => self.elements(|k, bytes| take(k, i64::from_le_bytes(bytes))),
            ">i8" => self.elements(|k, bytes| take(k, i64::from_be_bytes(bytes))),
            _ => Err(self.type_problem("int32 or int64").into()),
        }
    }

    /// Passes every real number to `take`, with its position.
    pub(super) fn reals(
        self,
        mut take: impl FnMut(u64, f64) -> Result<(), NpzProblem>,
    ) -> Result<(), NpyFault> {
        match &self.descr[..] {
            "<f8" => self.elements(|k, bytes| take(k, f64::from_le_bytes(bytes))),
            ">f8" => self.elements(|k, bytes| take(k, f64::from_be_bytes(bytes))),
            "<f4" => self.elements(|k, bytes| take(k, f32::from_le_bytes(bytes).into())),
            ">f4" => self.elements(|k, bytes| take(k, f32::from_be_bytes(bytes).into())),
            _ => Err(self.type_problem("float64 or float32; convert real data with .astype(float)").into()),
        }
    }

    /// Text of a zero-dimensional array of bytes or, from old versions, of unicode characters.
    pub(super) fn text(self) -> Result<String, NpyFault> {
        let expected = "a short text";
        let width =
            |prefix: &str| self.descr.strip_prefix(prefix).and_then(|width| width.parse::<usize>().ok());
        let bytes = match (width("|S"), width("<U")) {
            (Some(bytes @ 1..=16), _) => bytes,
            (_, Some(characters @ 1..=16)) => 4 * characters,
            _ => return Err(self.type_problem(expected).into()),
        };
        if !self.shape.is_empty() {
            return Err(self.shape_problem(ExpectedShape::SingleText).into());
        }
        let mut text = vec![0; bytes];
        if !fill(self.source, &mut text)? {
            return Err(NpzProblem::Length { array: self.name, announced: 1 }.into());
        }
        // Unicode is stored as UTF-32; the names in question are ASCII.
        text.retain(|byte| *byte != 0);
        Ok(String::from_utf8_lossy(&text).into_owned())
    }

    fn type_problem(&self, expected: &'static str) -> NpzProblem {
        let found = quoted(&self.descr);
        NpzProblem::Type { array: self.name, found, expected }
    }

    fn elements<const SIZE: usize>(
        self,
        mut take: impl FnMut(u64, [u8; SIZE]) -> Result<(), NpzProblem>,
    ) -> Result<(), NpyFault> {
        let total = self.length()?;
        let length_problem = || NpyFault::from(NpzProblem::Length { array: self.name, announced: total });
        let mut buffer = vec![0; CHUNK * SIZE];
        let mut done = 0;
        while done < total {
            let count = (total - done).min(CHUNK as u64);
            let bytes = &mut buffer[..count as usize * SIZE];
            if !fill(self.source, bytes)? {
                return Err(length_problem());
            }
            let (elements, _) = bytes.as_chunks::<SIZE>();
            for (position, element) in (done..).zip(elements) {
                take(position, *element)?;
            }
            done += count;
        }
        if fill(self.source, &mut [0])? { Err(length_problem()) } else { Ok(()) }
    }
}

/// Fills `buffer`; `false` if the source ends before.
fn fill(source: &mut dyn Read, buffer: &mut [u8]) -> io::Result<bool> {
    match source.read_exact(buffer) {
        Ok(()) => Ok(true),
        // An error of the decompressor carries a message of its own; only a plain end of the file has none.
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof && error.get_ref().is_none() => Ok(false),
        Err(error) => Err(error),
    }
}

/// Text after `'key':` in a header.
fn value<'h>(header: &'h str, key: &str) -> Option<&'h str> {
    let (_, after) = header.split_once(&format!("'{key}'"))?;
    Some(after.trim_start().strip_prefix(':')?.trim_start())
}

/// Numbers of `(3, 4)`, `(3,)` or `()` at the start of `text`.
fn tuple(text: &str) -> Option<Vec<u64>> {
    let (inside, _) = text.strip_prefix('(')?.split_once(')')?;
    let numbers = inside.split(',').map(str::trim).filter(|number| !number.is_empty());
    numbers.map(|number| number.parse().ok()).collect()
}

/// Header of an array as numpy writes it: version 1, padded to a multiple of 64 bytes.
pub(super) fn header(descr: &str, shape: &str) -> Vec<u8> {
    let text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (10 + text.len() + 1).next_multiple_of(64) - 10;
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend((length as u16).to_le_bytes());
    header.extend(text.bytes());
    header.resize(10 + length - 1, b' ');
    header.push(b'\n');
    header
}
