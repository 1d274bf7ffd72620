//! What an archive says of itself.

use serde::{Deserialize, Serialize};

use crate::store::jobs::JobKind;

/// Version of the form of archives.
pub const FORMAT: u32 = 1;

/// Name of the manifest, which is the last entry: it has the digests of all others.
pub const MANIFEST: &str = "manifest.json";
/// Name of the request: posted again, it asks for the same.
pub const REQUEST: &str = "request.json";
/// Name of the settings: the request with what was added since, as results repeat it.
pub const SETTINGS: &str = "settings.json";
/// Name of the settings that were chosen, and why; absent where all were given.
pub const CHOICE: &str = "choice.json";
/// Name of the model's package, byte by byte as it was uploaded.
pub const PACKAGE: &str = "package.zip";
/// What names of results begin with.
pub const RESULTS: &str = "results/";

/// The manifest of an archive.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`FORMAT`].
    pub format: u32,
    /// The job.
    pub job: ArchivedJob,
    /// What its numbers depend on beside the request.
    pub computed: Computed,
    /// All other entries, in their order.
    pub entries: Vec<Entry>,
}

/// The job of an archive.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArchivedJob {
    /// Its id.
    pub id: String,
    /// Its kind.
    pub kind: JobKind,
    /// Its model.
    pub model: String,
    /// When it was accepted (RFC 3339).
    pub created_at: String,
    /// When it ended.
    pub finished_at: Option<String>,
}

/// What numbers depend on beside the request.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Computed {
    /// Revision of the numerics.
    pub revision: u32,
    /// Kind of vectors of the processor; unknown of jobs of earlier versions.
    pub vectors: Option<String>,
    /// Version of the program that made the archive.
    pub version: String,
    /// Commit of its sources.
    pub commit: String,
    /// Target triple of its build.
    pub target: String,
}

/// An entry of an archive.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Its length once it is inflated.
    pub bytes: u64,
    /// SHA-256 of its content, in hexadecimal.
    pub sha256: String,
}
