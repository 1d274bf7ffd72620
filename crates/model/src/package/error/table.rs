//! Problems of the node and DOF tables.

/// What is wrong with a line of a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableProblem {
    /// Number of fields.
    #[error("{found} comma-separated values where {expected} are expected ({columns})")]
    FieldCount {
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
        /// Their names.
        columns: &'static str,
    },
    /// A header whose columns are in another order.
    #[error("the header names its columns in another order than {columns}; reorder them")]
    HeaderOrder {
        /// Expected columns.
        columns: &'static str,
    },
    /// Text that is not a node id.
    #[error("\"{text}\" is not a node id (an integer from 0)")]
    BadId {
        /// The text.
        text: String,
    },
    /// Text that is not a coordinate.
    #[error("{column} is \"{text}\", not a finite number")]
    BadNumber {
        /// Column name.
        column: &'static str,
        /// The text.
        text: String,
    },
    /// Component out of range.
    #[error("component \"{text}\" is not 1, 2 or 3")]
    BadComponent {
        /// The text.
        text: String,
    },
    /// Node id used before.
    #[error("node {node} is already defined on line {first_line}")]
    NodeRepeated {
        /// Its id.
        node: u64,
        /// Line of the first definition.
        first_line: u64,
    },
    /// A DOF of a node that does not exist.
    #[error("node {node} is not in the node table")]
    UnknownNode {
        /// Its id.
        node: u64,
    },
    /// The same DOF on two lines.
    #[error("component {component} of node {node} is already row {first_row} (line {first_line})")]
    DofRepeated {
        /// Node id.
        node: u64,
        /// Component.
        component: u8,
        /// Row of the first mention, from 1.
        first_row: usize,
        /// Its line.
        first_line: u64,
    },
    /// Nothing in the table.
    #[error("the table has no rows")]
    Empty,
    /// More rows than the limit.
    #[error("the table has more than the {limit} rows this server accepts")]
    TooManyRows {
        /// Configured limit.
        limit: usize,
    },
    /// No newline for very long.
    #[error("the line is longer than {limit} bytes; is this a text file?")]
    LineTooLong {
        /// The longest line accepted.
        limit: usize,
    },
}
