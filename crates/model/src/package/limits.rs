//! Limits on reading an untrusted file.

/// Limits of an upload, before anything is known about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Largest number of bytes that may leave decompressors, zip and gzip alike, over all files (default 16 GiB).
    pub expanded_bytes: u64,
    /// Largest number of bytes that may leave decompressors for each byte of the upload, beyond the first 64 MiB (default 100; matrices as
    /// text deflate to a third, tables to a tenth): the cost of an upload is in proportion to its size.
    pub expansion: u64,
    /// Largest number of entries of the archive, folders included (default 100; a package needs at most 9 files).
    pub entries: usize,
    /// Largest number of bytes of `sector.json`, which is held as text (default 64 MiB).
    pub manifest_bytes: u64,
    /// Largest number of lines of the node table, and of the DOF table (default 10 million).
    pub table_rows: usize,
    /// Largest number of entries of one matrix, at about 16 bytes of memory each while reading (default 200 million).
    pub matrix_entries: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            expanded_bytes: 16 << 30,
            expansion: 100,
            entries: 100,
            manifest_bytes: 64 << 20,
            table_rows: 10_000_000,
            matrix_entries: 200_000_000,
        }
    }
}
