//! Problems of matrices stored by `scipy.sparse.save_npz`. Positions in arrays count from 0, as in numpy.

use crate::package::quote::quoted;

/// What is wrong with the arrays of a matrix.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NpzProblem {
    /// No readable zip directory.
    #[error("the file is not a zip of arrays as scipy.sparse.save_npz writes it ({reason})")]
    NotAZip {
        /// The zip reader's words.
        reason: String,
    },
    /// Two arrays of the same name.
    #[error("the file holds two arrays of the same name; save it again with scipy.sparse.save_npz")]
    Repeated,
    /// An array save_npz would have written is not there.
    #[error("the array {array} is missing; save the matrix with scipy.sparse.save_npz")]
    Missing {
        /// Its name.
        array: &'static str,
    },
    /// An array save_npz does not write.
    #[error("{array} is no array of a {format} matrix; save the matrix alone, with scipy.sparse.save_npz")]
    Surplus {
        /// Name of the zip entry.
        array: String,
        /// Storage scheme the file states.
        format: String,
    },
    /// A storage scheme other than csr, csc, coo.
    #[error(
        "the storage format \"{format}\" is not supported; convert the matrix with .tocsr() and save it again"
    )]
    Format {
        /// What the file states.
        format: String,
    },
    /// Not an array of numpy's format.
    #[error("the array {array} is not in numpy's npy format ({reason})")]
    NotNpy {
        /// Its name.
        array: &'static str,
        /// What is wrong with its header.
        reason: &'static str,
    },
    /// An element type that cannot be taken.
    #[error("the array {array} has the type \"{found}\"; it must be {expected}")]
    Type {
        /// Its name.
        array: &'static str,
        /// numpy's name of the type.
        found: String,
        /// Types accepted.
        expected: &'static str,
    },
    /// Wrong number of dimensions or elements.
    #[error("the array {array} has the shape {}; expected is {expected}", shape(.found))]
    Shape {
        /// Its name.
        array: &'static str,
        /// Elements in each dimension.
        found: Vec<u64>,
        /// What its place asks for.
        expected: ExpectedShape,
    },
    /// Fewer or more bytes than the header announces.
    #[error("the array {array} does not hold the {announced} elements its header announces")]
    Length {
        /// Its name.
        array: &'static str,
        /// Elements announced.
        announced: u64,
    },
    /// An index that is not a row or column.
    #[error("{array}[{position}] is {value}, outside the {size} × {size} matrix (numpy counts from 0)")]
    IndexOutOfRange {
        /// `indices`, `row` or `col`.
        array: &'static str,
        /// Position in the array.
        position: u64,
        /// Value there.
        value: i64,
        /// Rows of the matrix.
        size: usize,
    },
    /// Pointers that do not ascend from 0 to the number of entries.
    #[error(
        "indptr[{position}] is {value}; the pointers must ascend from 0 to at most the {entries} entries stored"
    )]
    Pointer {
        /// Position in the array.
        position: u64,
        /// Value there.
        value: i64,
        /// Elements of `indices`.
        entries: u64,
    },
}

/// The shape that an array's place asks for, in numpy's spelling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ExpectedShape {
    /// Of any length.
    #[error("one-dimensional")]
    OneDimensional,
    /// One element without dimensions.
    #[error("a single text")]
    SingleText,
    /// Rows and columns.
    #[error("(2,)")]
    Pair,
    /// As many elements as another array.
    #[error("({length},), as of {array}")]
    AsOf {
        /// Elements of the other.
        length: usize,
        /// Its name.
        array: &'static str,
    },
    /// Pointers to the starts of the rows, and to the end.
    #[error("({length},), one more than the rows")]
    OneMoreThanRows {
        /// Elements.
        length: usize,
    },
}

/// Such as `(3, 4)`.
fn shape(sizes: &[u64]) -> String {
    let sizes: Vec<String> = sizes.iter().map(u64::to_string).collect();
    quoted(&format!("({})", sizes.join(", ")))
}
