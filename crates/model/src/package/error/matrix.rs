//! Problems of the matrices. Rows and columns in these messages count from 1, as in the files.

use super::npz::NpzProblem;

/// What is wrong with a matrix.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MatrixProblem {
    /// First line.
    #[error(
        "the file does not start with a Matrix Market header such as \
         \"%%MatrixMarket matrix coordinate real symmetric\""
    )]
    NoHeader,
    /// A header word that is not supported.
    #[error(
        "the {what} \"{word}\" is not supported; write \"matrix coordinate real {one_triangle}\" or \"general\""
    )]
    UnsupportedHeader {
        /// Object, format, field or symmetry.
        what: &'static str,
        /// The word found.
        word: String,
        /// The symmetry that a file of one triangle declares.
        one_triangle: &'static str,
    },
    /// The line of sizes.
    #[error("the line after the header must be \"rows columns entries\", three integers")]
    BadSizeLine,
    /// Rows ≠ columns.
    #[error("the matrix is {rows} × {columns}, not square")]
    NotSquare {
        /// Rows.
        rows: u64,
        /// Columns.
        columns: u64,
    },
    /// Rows ≠ lines of the DOF table.
    #[error("the matrix has {rows} rows, but the DOF table lists {dofs} DOF")]
    SizeDisagrees {
        /// Rows.
        rows: u64,
        /// Lines of the DOF table.
        dofs: usize,
    },
    /// More entries than the limit.
    #[error("the matrix announces {entries} entries, more than the {limit} this server accepts")]
    TooManyEntries {
        /// Announced.
        entries: u64,
        /// Configured limit.
        limit: usize,
    },
    /// A line that is not an entry.
    #[error("\"{text}\" is not an entry \"row column value\"")]
    BadEntry {
        /// The line, shortened.
        text: String,
    },
    /// Row or column out of range.
    #[error("entry ({row}, {column}) is outside the {size} × {size} matrix; rows and columns count from 1")]
    IndexOutOfRange {
        /// Row.
        row: u64,
        /// Column.
        column: u64,
        /// Rows of the matrix.
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
        /// Row.
        row: u64,
        /// Column.
        column: u64,
    },
    /// More lines than announced.
    #[error("this is one entry more than the {announced} announced at the top")]
    MoreEntries {
        /// Announced.
        announced: u64,
    },
    /// Fewer lines than announced.
    #[error("the file ends after {found} of the {announced} entries announced at the top")]
    FewerEntries {
        /// Found.
        found: u64,
        /// Announced.
        announced: u64,
    },
    /// A position given twice.
    #[error("entry ({row}, {column}) is given twice{}; {}", match .first_line {
        Some(line) => format!(" (first on line {line})"),
        None => String::new(),
    }, if *.mirrored {
        "a symmetric file holds one triangle only: write one of the two, or declare the matrix general"
    } else {
        "assemble the matrix so that every entry appears once"
    })]
    Repeated {
        /// Row.
        row: u64,
        /// Column.
        column: u64,
        /// Line of the first mention, if known.
        first_line: Option<u64>,
        /// Whether the two mentions are mirror images of each other.
        mirrored: bool,
    },
    /// A general matrix that is not (skew-)symmetric.
    #[error(
        "the matrix is not {}: entry ({row}, {column}) is {value:e}{}, entry ({column}, {row}) is \
         {mirrored:e}{} (the worst of {count})",
        if *.skew { "skew-symmetric" } else { "symmetric" }, at_line(*.line), at_line(*.mirrored_line)
    )]
    NotSymmetric {
        /// Whether the triangles must differ in sign.
        skew: bool,
        /// Row.
        row: u64,
        /// Column.
        column: u64,
        /// Its value.
        value: f64,
        /// Value of the mirrored entry; 0 if it is absent.
        mirrored: f64,
        /// Line of the entry.
        line: Option<u64>,
        /// Line of the mirrored entry.
        mirrored_line: Option<u64>,
        /// How many pairs differ by more than the tolerance.
        count: usize,
    },
    /// A skew-symmetric matrix with a diagonal.
    #[error(
        "entry ({row}, {row}) is {value:e}, but the diagonal of a skew-symmetric matrix is zero: is this the gyroscopic \
         matrix?"
    )]
    SkewDiagonal {
        /// Row and column.
        row: u64,
        /// Its value.
        value: f64,
    },
    /// A mass that cannot carry modes: diagonal.
    #[error(
        "the mass of the assembled wheel is {value:e} on the diagonal of node {node} (row {row}), not positive; give every \
         DOF mass or condense massless ones out"
    )]
    MassDiagonal {
        /// Node id.
        node: u64,
        /// Row of the DOF table.
        row: usize,
        /// Assembled diagonal value.
        value: f64,
    },
    /// A mass that is negative: 2 × 2 minor.
    #[error(
        "the mass of the assembled wheel is negative for some motion: the entry {value:e} between node {node} (row {row}) \
         and node {other_node} (row {other_row}) is larger than their diagonals allow"
    )]
    MassMinor {
        /// Node id.
        node: u64,
        /// Row of the DOF table.
        row: usize,
        /// The other node's id.
        other_node: u64,
        /// Its row.
        other_row: usize,
        /// Entry.
        value: f64,
    },
    /// A mass that is negative for some motion.
    #[error(
        "the mass of the assembled wheel is negative, by more than round-off, for a motion that node {node} (row {row}) \
         takes part in (nodal diameter {nodal_diameter}): is the density positive everywhere, is this the mass matrix, and \
         is it written with twelve digits or more?"
    )]
    MassNegative {
        /// Nodal diameter of the motion.
        nodal_diameter: usize,
        /// Id of the node at which elimination found it out.
        node: u64,
        /// Its row of the DOF table.
        row: usize,
    },
    /// Arrays of a `.npz` file.
    #[error(transparent)]
    Npz(#[from] NpzProblem),
    /// No newline for very long.
    #[error("the line is longer than {limit} bytes; is this a text file?")]
    LineTooLong {
        /// The longest line accepted.
        limit: usize,
    },
}

/// ` (line 7)`.
fn at_line(line: Option<u64>) -> String {
    line.map_or_else(String::new, |line| format!(" (line {line})"))
}
