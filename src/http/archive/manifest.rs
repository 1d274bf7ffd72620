//! Manifest of an archive: its entries, its job, and the version that computed it.

use serde::{Deserialize, Serialize};

use crate::kinds::JobKind;

/// Version of the form of archives.
pub const FORMAT: u32 = 1;

/// Name of the manifest, which is the last entry: it has the digests of all others.
pub const MANIFEST: &str = "manifest.json";
/// Name of the request; posted again, it starts the same computation.
pub const REQUEST: &str = "request.json";
/// Name of the settings: the request with everything added since, as results repeat it.
pub const SETTINGS: &str = "settings.json";
/// Name of the settings that were chosen, and why; absent where all were given.
pub const CHOICE: &str = "choice.json";
/// Name of the model's package, byte by byte as it was uploaded.
pub const PACKAGE: &str = "package.zip";
/// Name of the package of the model that is compared with the first.
pub const COMPARED_PACKAGE: &str = "compared-package.zip";
/// Prefix of the names of results.
pub const RESULTS: &str = "results/";

/// The manifest of an archive.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the form of the archive: [`FORMAT`].
    pub format: u32,
    /// Archived job.
    pub job: ArchivedJob,
    /// Revision, vectors and program that the numbers depend on beside the request.
    pub computed: Computed,
    /// Entries of the archive without the manifest, in their order.
    pub entries: Vec<Entry>,
}

/// The job of an archive.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArchivedJob {
    /// Id of the job.
    pub id: String,
    /// Kind of the job.
    pub kind: JobKind,
    /// Path to which its request was posted; archives of earlier versions do not have it.
    #[serde(default)]
    pub posted_to: String,
    /// Id of the job's model; of a generation, of the model that it made.
    pub model: String,
    /// Time at which the job was accepted (RFC 3339).
    pub created_at: String,
    /// Time at which the job ended (RFC 3339).
    pub finished_at: Option<String>,
}

/// Revision, vectors and program that the numbers of a job depend on beside the request.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Computed {
    /// Revision of the numerics.
    pub revision: u32,
    /// Kind of vectors of the processor; unknown for jobs of earlier versions.
    pub vectors: Option<String>,
    /// Version of the program that made the archive.
    pub version: String,
    /// Commit of the program's sources.
    pub commit: String,
    /// Target triple of the program's build.
    pub target: String,
}

/// An entry of an archive.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Name of the entry.
    pub name: String,
    /// Length of the entry once it is inflated, bytes.
    pub bytes: u64,
    /// SHA-256 of the entry's content, in hexadecimal.
    pub sha256: String,
}
