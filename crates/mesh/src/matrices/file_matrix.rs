//! Matrix of a file, in the same terms for all formats.

/// Matrix of a finite-element program: rows by node and component.
#[derive(Debug, Clone, PartialEq)]
pub struct FileMatrix {
    /// Name of the format, such as `Nastran DMIG`.
    pub format: &'static str,
    /// Rows, sorted by node and then component.
    pub rows: Vec<MatrixRow>,
    /// Row, column (both from 0, into [`rows`](Self::rows)) and value: the lower triangle, each position once, sorted by column then row,
    /// without zeros.
    pub entries: Vec<(u32, u32, f64)>,
    /// Rows that the file marks as clamped and that were left out. A mass matrix from Abaqus still has these rows: only the stiffness
    /// matrix marks them.
    pub clamped: Vec<MatrixRow>,
    /// Omissions that the user should know of, each a sentence.
    pub notes: Vec<String>,
}

/// Row of a matrix: displacement of a node in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MatrixRow {
    /// Number of the node.
    pub node: u64,
    /// Direction, 1 to 3 for x, y and z of the node's own coordinate system.
    pub component: u8,
}
