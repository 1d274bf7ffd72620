//! What a copy of a data folder tells of itself.

/// How far a copy is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CopyProgress {
    /// Bytes of files, and how many there are.
    Files(u64, u64),
    /// Rows, and how many there are.
    Rows(u64, u64),
}

/// What a copy found and brought.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Copied {
    /// Models of the data folder.
    pub models: u64,
    /// Its jobs.
    pub jobs: u64,
    /// Its files.
    pub files: u64,
    /// Files that were not there before.
    pub new_files: u64,
    /// Rows of its tables.
    pub rows: u64,
    /// Rows that were not there before.
    pub new_rows: u64,
}
