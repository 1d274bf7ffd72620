//! Problems of the zip archive.

/// Problem of the archive or of one file's storage in it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ArchiveProblem {
    /// Upload without a readable zip directory.
    #[error(
        "the upload is not a zip file, or it is cut off ({reason}); zip sector.json with its tables and matrices"
    )]
    NotAZip {
        /// Message of the zip reader.
        reason: String,
    },
    /// File with an absolute path, `..` or a drive letter.
    #[error(
        "the archive holds a file with an absolute or parent path; paths inside a package must stay inside it"
    )]
    UnsafePath,
    /// Name that is too long.
    #[error("the name of this file has more than {limit} characters")]
    NameTooLong {
        /// Largest number of characters.
        limit: usize,
    },
    /// Two entries of the same name.
    #[error("the archive holds this file more than once, so it is unclear which one counts; keep one")]
    Repeated,
    /// Archive with too many entries.
    #[error("the archive holds {entries} files, more than the {limit} this server accepts")]
    TooManyFiles {
        /// Number of entries found.
        entries: usize,
        /// Largest number of entries, as configured.
        limit: usize,
    },
    /// Archive that expands beyond the limit.
    #[error(
        "the archive expands beyond the limit of {limit_bytes} bytes for an archive of its size while this file is read"
    )]
    TooLarge {
        /// Largest number of bytes, by configuration and by the archive's size.
        limit_bytes: u64,
    },
    /// Entry protected by a password.
    #[error("this file is encrypted; packages must be readable without a password")]
    Encrypted,
    /// Compression method other than stored or deflated.
    #[error("this file uses a compression method that is not supported ({method}); store or deflate it")]
    UnsupportedCompression {
        /// Name of the method.
        method: String,
    },
    /// Damaged entry: checksum, truncated data, broken gzip.
    #[error("this file is damaged ({reason}); make the archive again")]
    Damaged {
        /// Message of the decompressor.
        reason: String,
    },
    /// File that was in the archive when it was opened and is missing now.
    #[error("this file is damaged (it is gone); make the archive again")]
    Gone,
    /// File that a zip archive cannot hold.
    #[error("this file is damaged (it cannot be written: {reason}); make the archive again")]
    Unwritable {
        /// Message of the zip writer.
        reason: String,
    },
    /// File that `sector.json` does not name.
    #[error("sector.json does not name this file; remove it from the archive or name it")]
    Surplus,
}
