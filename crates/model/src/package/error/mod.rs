//! What can be wrong with a package, each problem with the place where the user finds it.

mod archive;
mod manifest;
mod matrix;
mod npz;
mod table;

pub use archive::ArchiveProblem;
pub use manifest::{Components, FaceReading, ManifestProblem, RowReading, TurnFit};
pub use matrix::MatrixProblem;
pub use npz::{ExpectedShape, NpzProblem};
pub use table::TableProblem;

/// Name of the file every package holds.
pub const MANIFEST_FILE: &str = "sector.json";

/// A package that cannot become a sector model: where, and what is wrong there.
///
/// The text is a complete sentence that starts with the place; [`Self::file`], [`Self::line`] and
/// [`Self::field`] give the place alone.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// The operating system could not read or write the file; nothing is known about its content.
    #[error("the package file cannot be accessed: {source}")]
    Io {
        /// The system's error.
        #[from]
        source: std::io::Error,
    },
    /// The archive as a whole, or one file's storage in it.
    #[error("{}{problem}", prefix(.file.as_deref(), None))]
    Archive {
        /// The file inside the archive, if one is to blame.
        file: Option<String>,
        /// What is wrong.
        problem: ArchiveProblem,
    },
    /// `sector.json`, or something it says that the rest of the package contradicts.
    #[error("sector.json{}{}: {problem}", if .field.is_empty() { "" } else { ", " }, .field)]
    Manifest {
        /// JSON pointer to the field (RFC 6901); empty for the document as a whole.
        field: String,
        /// What is wrong.
        problem: ManifestProblem,
    },
    /// A line of `nodes.csv` or `dofs.csv` (under the names the manifest gives them).
    #[error("{}{problem}", prefix(Some(.file), Some(*.line)))]
    Table {
        /// File name.
        file: String,
        /// Line, from 1.
        line: u64,
        /// What is wrong.
        problem: TableProblem,
    },
    /// A matrix file.
    #[error("{}{problem}", prefix(Some(.file), *.line))]
    Matrix {
        /// File name.
        file: String,
        /// Line, from 1, where one line is to blame.
        line: Option<u64>,
        /// What is wrong.
        problem: MatrixProblem,
    },
}

impl PackageError {
    /// The file inside the package that is wrong or missing, if one is to blame.
    pub fn file(&self) -> Option<&str> {
        match self {
            Self::Io { .. } => None,
            Self::Archive { file, .. } => file.as_deref(),
            Self::Manifest { problem: ManifestProblem::FileMissing { file, .. }, .. } => Some(file),
            Self::Manifest { .. } => Some(MANIFEST_FILE),
            Self::Table { file, .. } | Self::Matrix { file, .. } => Some(file),
        }
    }

    /// The line of [`Self::file`], from 1.
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Table { line, .. } => Some(*line),
            Self::Matrix { line, .. } => *line,
            Self::Manifest { problem: ManifestProblem::Syntax { line, .. }, .. } => Some(*line as u64),
            _ => None,
        }
    }

    /// JSON pointer to the field of `sector.json` to look at; the empty pointer is the whole document.
    pub fn field(&self) -> Option<&str> {
        match self {
            Self::Manifest { field, .. } => Some(field),
            _ => None,
        }
    }

    pub(super) fn archive(file: impl Into<Option<String>>, problem: ArchiveProblem) -> Self {
        Self::Archive { file: file.into(), problem }
    }

    pub(super) fn manifest(field: impl Into<String>, problem: ManifestProblem) -> Self {
        Self::Manifest { field: field.into(), problem }
    }

    pub(super) fn matrix(file: &str, problem: MatrixProblem) -> Self {
        Self::Matrix { file: file.to_owned(), line: None, problem }
    }
}

/// `k0.mtx, line 7: `.
fn prefix(file: Option<&str>, line: Option<u64>) -> String {
    match (file, line) {
        (Some(file), Some(line)) => format!("{file}, line {line}: "),
        (Some(file), None) => format!("{file}: "),
        (None, _) => String::new(),
    }
}
