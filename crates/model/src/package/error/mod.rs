//! Errors of packages, each with the place where the user finds the problem.

mod archive;
mod manifest;
mod matrix;
mod npz;
mod reading;
mod table;

pub use archive::ArchiveProblem;
pub use manifest::{Components, ManifestProblem, TurnFit};
pub use matrix::MatrixProblem;
pub use npz::{ExpectedShape, NpzProblem};
pub use reading::{FaceReading, RowReading};
pub use table::TableProblem;

/// Name of the file that every package holds.
pub const MANIFEST_FILE: &str = "sector.json";

/// Error of a package that cannot become a sector model: where, and what is wrong there.
///
/// The text is a complete sentence that starts with the place; [`Self::file`], [`Self::line`] and
/// [`Self::field`] give the place alone.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// Error of the operating system, which could not read or write the file; nothing is known about its content.
    #[error("the package file cannot be accessed: {source}")]
    Io {
        /// Error reported by the system.
        #[from]
        source: std::io::Error,
    },
    /// Problem of the archive as a whole, or of one file's storage in it.
    #[error("{}{problem}", prefix(.file.as_deref(), None))]
    Archive {
        /// Name of the file inside the archive, if one is at fault.
        file: Option<String>,
        /// Problem of the archive.
        problem: ArchiveProblem,
    },
    /// Problem of `sector.json`, or of a statement in it that the rest of the package contradicts.
    #[error("sector.json{}{}: {problem}", if .field.is_empty() { "" } else { ", " }, .field)]
    Manifest {
        /// JSON pointer to the field (RFC 6901); empty for the document as a whole.
        field: String,
        /// Problem of the field.
        problem: ManifestProblem,
    },
    /// Problem of a line of `nodes.csv` or `dofs.csv` (under the names the manifest gives them).
    #[error("{}{problem}", prefix(Some(.file), Some(*.line)))]
    Table {
        /// Name of the table's file.
        file: String,
        /// Number of the line, from 1.
        line: u64,
        /// Problem of the line.
        problem: TableProblem,
    },
    /// Problem of a mesh file, or of the model that it should become.
    #[error("{}{message}", prefix(.file.as_deref(), None))]
    Mesh {
        /// Name of the mesh file inside the package; none for a bare mesh.
        file: Option<String>,
        /// Number of the line, from 1, where one line is at fault.
        line: Option<u64>,
        /// Message, with the place inside the file.
        message: String,
    },
    /// Problem of a matrix file.
    #[error("{}{problem}", prefix(Some(.file), *.line))]
    Matrix {
        /// Name of the matrix file.
        file: String,
        /// Number of the line, from 1, where one line is at fault.
        line: Option<u64>,
        /// Problem of the matrix.
        problem: MatrixProblem,
    },
}

impl PackageError {
    /// Name of the file inside the package that is wrong or missing, if one is at fault.
    pub fn file(&self) -> Option<&str> {
        match self {
            Self::Io { .. } => None,
            Self::Archive { file, .. } | Self::Mesh { file, .. } => file.as_deref(),
            Self::Manifest { problem: ManifestProblem::FileMissing { file, .. }, .. } => Some(file),
            Self::Manifest { .. } => Some(MANIFEST_FILE),
            Self::Table { file, .. } | Self::Matrix { file, .. } => Some(file),
        }
    }

    /// Number of the line of [`Self::file`], from 1.
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Table { line, .. } => Some(*line),
            Self::Matrix { line, .. } | Self::Mesh { line, .. } => *line,
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

/// Beginning of a message, such as `k0.mtx, line 7: `.
fn prefix(file: Option<&str>, line: Option<u64>) -> String {
    match (file, line) {
        (Some(file), Some(line)) => format!("{file}, line {line}: "),
        (Some(file), None) => format!("{file}: "),
        (None, _) => String::new(),
    }
}
