//! Problems of the matrices. Rows and columns in these messages count from 1, as in the files.

use super::npz::NpzProblem;

/// Problem of a matrix.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MatrixProblem {
    /// File whose first line is not a Matrix Market header.
    #[error(
        "the file does not start with a Matrix Market header such as \
         \"%%MatrixMarket matrix coordinate real symmetric\""
    )]
    NoHeader,
    /// Word of the header that is not supported.
    #[error(
        "the {what} \"{word}\" is not supported; write \"matrix coordinate real {one_triangle}\" or \"general\""
    )]
    UnsupportedHeader {
        /// Part of the header: object, format, field or symmetry.
        what: &'static str,
        /// Word found.
        word: String,
        /// Symmetry that a file of one triangle declares.
        one_triangle: &'static str,
    },
    /// Line of sizes that cannot be read.
    #[error("the line after the header must be \"rows columns entries\", three integers")]
    BadSizeLine,
    /// Matrix with different numbers of rows and columns.
    #[error("the matrix is {rows} × {columns}, not square")]
    NotSquare {
        /// Number of rows.
        rows: u64,
        /// Number of columns.
        columns: u64,
    },
    /// Number of rows that differs from the DOF table.
    #[error("the matrix has {rows} rows, but the DOF table lists {dofs} DOF")]
    SizeDisagrees {
        /// Number of rows of the matrix.
        rows: u64,
        /// Number of lines of the DOF table.
        dofs: usize,
    },
    /// Matrix with more entries than the limit.
    #[error("the matrix announces {entries} entries, more than the {limit} this server accepts")]
    TooManyEntries {
        /// Number of entries announced.
        entries: u64,
        /// Largest number of entries, as configured.
        limit: usize,
    },
    /// Line that is not an entry.
    #[error("\"{text}\" is not an entry \"row column value\"")]
    BadEntry {
        /// Text of the line, shortened.
        text: String,
    },
    /// Entry with a row or column out of range.
    #[error("entry ({row}, {column}) is outside the {size} × {size} matrix; rows and columns count from 1")]
    IndexOutOfRange {
        /// Row of the entry.
        row: u64,
        /// Column of the entry.
        column: u64,
        /// Number of rows of the matrix.
        size: usize,
    },
    /// Nothing but zeros.
    #[error("all entries are zero")]
    AllZero,
    /// Numbers whose squares a computer cannot hold.
    #[error("the largest entry is {largest:e}; {least:e} to {most:e} are accepted: choose other units")]
    OutOfRange {
        /// Largest magnitude of an entry.
        largest: f64,
        /// Least that is accepted.
        least: f64,
        /// Most that is accepted.
        most: f64,
    },
    /// Diagonal entry of a matrix that cannot have such.
    #[error(
        "the diagonal entry ({row}, {row}) is {value:e}; no stiffness and no mass is negative there: check the sign of the matrix"
    )]
    NegativeDiagonal {
        /// Row.
        row: u64,
        /// Entry.
        value: f64,
    },
    /// NaN, infinity or overflow.
    #[error("entry ({row}, {column}) is not a finite number")]
    NotFinite {
        /// Row of the entry.
        row: u64,
        /// Column of the entry.
        column: u64,
    },
    /// File with more entries than announced.
    #[error("this is one entry more than the {announced} announced at the top")]
    MoreEntries {
        /// Number of entries announced.
        announced: u64,
    },
    /// File with fewer entries than announced.
    #[error("the file ends after {found} of the {announced} entries announced at the top")]
    FewerEntries {
        /// Number of entries found.
        found: u64,
        /// Number of entries announced.
        announced: u64,
    },
    /// Position that is given twice.
    #[error("entry ({row}, {column}) is given twice{}; {}", match .first_line {
        Some(line) => format!(" (first on line {line})"),
        None => String::new(),
    }, if *.mirrored {
        "a symmetric file holds one triangle only: write one of the two, or declare the matrix general"
    } else {
        "assemble the matrix so that every entry appears once"
    })]
    Repeated {
        /// Row of the position.
        row: u64,
        /// Column of the position.
        column: u64,
        /// Line of the first mention, if known.
        first_line: Option<u64>,
        /// Whether the two mentions are mirror images of each other.
        mirrored: bool,
    },
    /// General matrix that is not (skew-)symmetric.
    #[error(
        "the matrix is not {}: entry ({row}, {column}) is {value:e}{}, entry ({column}, {row}) is \
         {mirrored:e}{} (the worst of {count})",
        if *.skew { "skew-symmetric" } else { "symmetric" }, at_line(*.line), at_line(*.mirrored_line)
    )]
    NotSymmetric {
        /// Whether the triangles must differ in sign.
        skew: bool,
        /// Row of the entry.
        row: u64,
        /// Column of the entry.
        column: u64,
        /// Value of the entry.
        value: f64,
        /// Value of the mirrored entry; 0 if it is absent.
        mirrored: f64,
        /// Line of the entry.
        line: Option<u64>,
        /// Line of the mirrored entry.
        mirrored_line: Option<u64>,
        /// Number of pairs that differ by more than the tolerance.
        count: usize,
    },
    /// Skew-symmetric matrix with an entry on its diagonal.
    #[error(
        "entry ({row}, {row}) is {value:e}, but the diagonal of a skew-symmetric matrix is zero: is this the gyroscopic \
         matrix?"
    )]
    SkewDiagonal {
        /// Row and column of the entry.
        row: u64,
        /// Value of the entry.
        value: f64,
    },
    /// Mass that cannot carry modes, since a diagonal entry is not positive.
    #[error(
        "the mass of the assembled wheel is {value:e} on the diagonal of node {node} (row {row}), not positive; give every \
         DOF mass or condense massless ones out"
    )]
    MassDiagonal {
        /// Id of the node.
        node: u64,
        /// Row of the DOF table.
        row: usize,
        /// Assembled diagonal value.
        value: f64,
    },
    /// Mass that is negative for some motion of two DOF, by a 2 × 2 minor.
    #[error(
        "the mass of the assembled wheel is negative for some motion: the entry {value:e} between node {node} (row {row}) \
         and node {other_node} (row {other_row}) is larger than their diagonals allow"
    )]
    MassMinor {
        /// Id of the node.
        node: u64,
        /// Row of the DOF table.
        row: usize,
        /// Id of the other node.
        other_node: u64,
        /// Row of the other node in the DOF table.
        other_row: usize,
        /// Value of the entry.
        value: f64,
    },
    /// Mass that is negative for some motion, by elimination.
    #[error(
        "the mass of the assembled wheel is negative, by more than round-off, for a motion that node {node} (row {row}) \
         takes part in (nodal diameter {nodal_diameter}): is the density positive everywhere, is this the mass matrix, and \
         is it written with twelve digits or more?"
    )]
    MassNegative {
        /// Nodal diameter of the motion.
        nodal_diameter: usize,
        /// Id of the node at which elimination fails.
        node: u64,
        /// Row of the node in the DOF table.
        row: usize,
    },
    /// Problem of the arrays of a `.npz` file.
    #[error(transparent)]
    Npz(#[from] NpzProblem),
    /// Line that is too long.
    #[error("the line is longer than {limit} bytes; is this a text file?")]
    LineTooLong {
        /// Longest line accepted, in bytes.
        limit: usize,
    },
}

/// Note of a line, such as ` (line 7)`; empty without one.
fn at_line(line: Option<u64>) -> String {
    line.map_or_else(String::new, |line| format!(" (line {line})"))
}
