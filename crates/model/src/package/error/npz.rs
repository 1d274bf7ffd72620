//! Problems of matrices stored by `scipy.sparse.save_npz`. Positions in arrays count from 0, as in numpy.

use crate::package::quote::quoted;

/// Problem of the arrays of a matrix.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NpzProblem {
    /// File without a readable zip directory.
    #[error("the file is not a zip of arrays as scipy.sparse.save_npz writes it ({reason})")]
    NotAZip {
        /// Message of the zip reader.
        reason: String,
    },
    /// Two arrays of the same name.
    #[error("the file holds two arrays of the same name; save it again with scipy.sparse.save_npz")]
    Repeated,
    /// Array of `save_npz` that is missing.
    #[error("the array {array} is missing; save the matrix with scipy.sparse.save_npz")]
    Missing {
        /// Name of the array.
        array: &'static str,
    },
    /// Array that `save_npz` does not write.
    #[error("{array} is no array of a {format} matrix; save the matrix alone, with scipy.sparse.save_npz")]
    Surplus {
        /// Name of the zip entry.
        array: String,
        /// Storage scheme that the file states.
        format: String,
    },
    /// Storage scheme other than csr, csc, coo.
    #[error(
        "the storage format \"{format}\" is not supported; convert the matrix with .tocsr() and save it again"
    )]
    Format {
        /// Storage scheme that the file states.
        format: String,
    },
    /// Array that is not in numpy's format.
    #[error("the array {array} is not in numpy's npy format ({reason})")]
    NotNpy {
        /// Name of the array.
        array: &'static str,
        /// Problem of the header.
        reason: &'static str,
    },
    /// Element type that is not accepted.
    #[error("the array {array} has the type \"{found}\"; it must be {expected}")]
    Type {
        /// Name of the array.
        array: &'static str,
        /// Name of the type in numpy.
        found: String,
        /// Types that are accepted.
        expected: &'static str,
    },
    /// Array with the wrong number of dimensions or elements.
    #[error("the array {array} has the shape {}; expected is {expected}", shape(.found))]
    Shape {
        /// Name of the array.
        array: &'static str,
        /// Number of elements in each dimension.
        found: Vec<u64>,
        /// Expected shape.
        expected: ExpectedShape,
    },
    /// Array with fewer or more bytes than its header announces.
    #[error("the array {array} does not hold the {announced} elements its header announces")]
    Length {
        /// Name of the array.
        array: &'static str,
        /// Number of elements announced.
        announced: u64,
    },
    /// Index that is not a row or column.
    #[error("{array}[{position}] is {value}, outside the {size} × {size} matrix (numpy counts from 0)")]
    IndexOutOfRange {
        /// Name of the array: `indices`, `row` or `col`.
        array: &'static str,
        /// Position in the array.
        position: u64,
        /// Value at that position.
        value: i64,
        /// Number of rows of the matrix.
        size: usize,
    },
    /// Pointers that do not ascend from 0 to the number of entries.
    #[error(
        "indptr[{position}] is {value}; the pointers must ascend from 0 to at most the {entries} entries stored"
    )]
    Pointer {
        /// Position in the array.
        position: u64,
        /// Value at that position.
        value: i64,
        /// Number of elements of `indices`.
        entries: u64,
    },
}

/// Expected shape of an array, in numpy's spelling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ExpectedShape {
    /// One-dimensional array of any length.
    #[error("one-dimensional")]
    OneDimensional,
    /// Single element without dimensions.
    #[error("a single text")]
    SingleText,
    /// Pair of the numbers of rows and columns.
    #[error("(2,)")]
    Pair,
    /// Array with as many elements as another one.
    #[error("({length},), as of {array}")]
    AsOf {
        /// Number of elements of the other array.
        length: usize,
        /// Name of the other array.
        array: &'static str,
    },
    /// Pointers to the starts of the rows, and to the end.
    #[error("({length},), one more than the rows")]
    OneMoreThanRows {
        /// Number of elements.
        length: usize,
    },
}

/// Spelling of a shape, such as `(3, 4)`.
fn shape(sizes: &[u64]) -> String {
    let sizes: Vec<String> = sizes.iter().map(u64::to_string).collect();
    quoted(&format!("({})", sizes.join(", ")))
}
