//! The model package of PACKAGE.md: read, check, rotate to cylindrical components; and write.

pub mod raw;

/// Stand-in until the branch `package` is merged.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Largest size of the expanded files.
    pub expanded_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { expanded_bytes: 8 << 30 }
    }
}

/// Stand-in until the branch `package` is merged.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// Everything.
    #[error("not a zip file")]
    NotZip,
}

impl PackageError {
    /// File.
    pub fn file(&self) -> Option<&str> {
        None
    }
    /// Line.
    pub fn line(&self) -> Option<u64> {
        None
    }
    /// Field.
    pub fn field(&self) -> Option<&str> {
        None
    }
}

/// Stand-in until the branch `package` is merged.
#[derive(Debug)]
pub struct Imported {
    /// The sector.
    pub sector: crate::dynamics::sector::SectorModel,
    /// Digest.
    pub digest: String,
}

/// Stand-in until the branch `package` is merged.
pub fn read(_path: &std::path::Path, _limits: &Limits) -> Result<Imported, PackageError> {
    Err(PackageError::NotZip)
}
