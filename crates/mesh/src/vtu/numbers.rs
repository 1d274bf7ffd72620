//! Number types of data arrays, and their numbers from text and from bytes.

use roxmltree::Node;

use crate::error::MeshProblem;
use crate::fields::{quoted, real};

/// Number type of an array.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Type {
    /// Bytes of a number.
    pub(super) size: usize,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Signed,
    Unsigned,
    Float,
}

/// Numbers of an array.
pub(super) enum Numbers {
    /// Integers; those above the range are its end.
    Integers(Vec<i64>),
    /// Real numbers.
    Reals(Vec<f64>),
}

impl Type {
    /// Type that an array states.
    pub(super) fn of(array: Node) -> Result<Self, MeshProblem> {
        let name = array.attribute("type").unwrap_or_default();
        let (kind, bits) = [("UInt", Kind::Unsigned), ("Int", Kind::Signed), ("Float", Kind::Float)]
            .into_iter()
            .find_map(|(begin, kind)| Some((kind, name.strip_prefix(begin)?)))
            .unwrap_or((Kind::Float, ""));
        let size = match (bits, kind) {
            ("8", Kind::Signed | Kind::Unsigned) => 1,
            ("16", Kind::Signed | Kind::Unsigned) => 2,
            ("32", _) => 4,
            ("64", _) => 8,
            _ => {
                let expected = "a type of numbers, such as Float64, Int64 or UInt8";
                return Err(MeshProblem::NotA { text: quoted(name), expected });
            }
        };
        Ok(Self { size, kind })
    }

    /// Whether the numbers are integers.
    pub(super) fn is_integer(self) -> bool {
        self.kind != Kind::Float
    }

    /// Numbers of a text, exactly so many.
    pub(super) fn parsed(self, text: &str, count: usize) -> Result<Numbers, MeshProblem> {
        let words = text.split_ascii_whitespace();
        let found = if self.is_integer() {
            let not = |word: &str| MeshProblem::NotA { text: quoted(word), expected: "an integer" };
            let number = |word: &str| word.parse().map_err(|_| not(word));
            let numbers: Result<_, _> = words.take(count.saturating_add(1)).map(number).collect();
            Numbers::Integers(numbers?)
        } else {
            let number = |word| real(word, "a number");
            let numbers: Result<_, _> = words.take(count.saturating_add(1)).map(number).collect();
            Numbers::Reals(numbers?)
        };
        let length = match &found {
            Numbers::Integers(numbers) => numbers.len(),
            Numbers::Reals(numbers) => numbers.len(),
        };
        if length == count {
            return Ok(found);
        }
        let than = if length < count { format!("and not {length}") } else { "and no more".to_owned() };
        Err(MeshProblem::Expected { expected: format!("{count} numbers, {than}") })
    }

    /// Numbers of bytes.
    pub(super) fn decoded(self, bytes: &[u8]) -> Numbers {
        let raw = bytes.chunks_exact(self.size).map(little);
        let unused = 64 - 8 * self.size as u32;
        match self.kind {
            Kind::Float if self.size == 4 => {
                Numbers::Reals(raw.map(|bits| f64::from(f32::from_bits(bits as u32))).collect())
            }
            Kind::Float => Numbers::Reals(raw.map(f64::from_bits).collect()),
            Kind::Unsigned => Numbers::Integers(raw.map(|n| i64::try_from(n).unwrap_or(i64::MAX)).collect()),
            // The sign is that of the type's own highest bit.
            Kind::Signed => Numbers::Integers(raw.map(|n| ((n << unused) as i64) >> unused).collect()),
        }
    }
}

impl Numbers {
    /// Integers, which an array must have.
    pub(super) fn integers(self) -> Result<Vec<i64>, MeshProblem> {
        match self {
            Self::Integers(numbers) => Ok(numbers),
            Self::Reals(_) => Err(MeshProblem::Expected { expected: "integers".to_owned() }),
        }
    }

    /// Finite real numbers, which an array must have.
    pub(super) fn reals(self) -> Result<Vec<f64>, MeshProblem> {
        match self {
            Self::Reals(numbers) if numbers.iter().all(|number| number.is_finite()) => Ok(numbers),
            Self::Reals(_) => Err(MeshProblem::Expected { expected: "finite numbers".to_owned() }),
            Self::Integers(_) => Err(MeshProblem::Expected { expected: "Float32 or Float64".to_owned() }),
        }
    }
}

/// Number whose low byte comes first.
pub(super) fn little(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
}
