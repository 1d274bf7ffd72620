//! Problems of the zip archive.

/// What is wrong with the archive or with one file's storage in it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ArchiveProblem {
    /// No readable zip directory.
    #[error(
        "the upload is not a zip file, or it is cut off ({reason}); zip sector.json with its tables and matrices"
    )]
    NotAZip {
        /// The zip reader's words.
        reason: String,
    },
    /// Absolute path, `..`, drive letter.
    #[error(
        "the archive holds a file with an absolute or parent path; paths inside a package must stay inside it"
    )]
    UnsafePath,
    /// A name longer than any.
    #[error("the name of this file has more than {limit} characters")]
    NameTooLong {
        /// Characters allowed.
        limit: usize,
    },
    /// Two entries of the same name.
    #[error("the archive holds this file more than once, so it is unclear which one counts; keep one")]
    Repeated,
    /// Too many entries.
    #[error("the archive holds {entries} files, more than the {limit} this server accepts")]
    TooManyFiles {
        /// Entries found.
        entries: usize,
        /// Configured limit.
        limit: usize,
    },
    /// Inflating went past the limit.
    #[error(
        "the archive expands beyond the limit of {limit_bytes} bytes for an archive of its size while this file is read"
    )]
    TooLarge {
        /// What is allowed, by configuration and by the archive's size.
        limit_bytes: u64,
    },
    /// Password protection.
    #[error("this file is encrypted; packages must be readable without a password")]
    Encrypted,
    /// A compression method other than stored or deflated.
    #[error("this file uses a compression method that is not supported ({method}); store or deflate it")]
    UnsupportedCompression {
        /// Its name.
        method: String,
    },
    /// Checksum, truncated data, broken gzip.
    #[error("this file is damaged ({reason}); make the archive again")]
    Damaged {
        /// The decompressor's words.
        reason: String,
    },
    /// A file that was in the archive when it was opened.
    #[error("this file is damaged (it is gone); make the archive again")]
    Gone,
    /// A file that a zip archive cannot hold.
    #[error("this file is damaged (it cannot be written: {reason}); make the archive again")]
    Unwritable {
        /// The zip writer's words.
        reason: String,
    },
    /// A file nobody names.
    #[error("sector.json does not name this file; remove it from the archive or name it")]
    Surplus,
}
