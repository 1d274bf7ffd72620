//! Progress and outcome of a copy of a data folder.

/// Progress of a copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CopyProgress {
    /// Bytes of files copied, and of all files.
    Files(u64, u64),
    /// Number of rows copied, and of all rows.
    Rows(u64, u64),
}

/// Numbers of models, jobs, files and rows that a copy found and added.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Copied {
    /// Number of models of the data folder.
    pub models: u64,
    /// Number of jobs of the data folder.
    pub jobs: u64,
    /// Number of files of the data folder.
    pub files: u64,
    /// Number of files that were new to the object store.
    pub new_files: u64,
    /// Number of rows of the data folder.
    pub rows: u64,
    /// Number of rows that were new to the database.
    pub new_rows: u64,
}
