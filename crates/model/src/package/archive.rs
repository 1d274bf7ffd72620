//! Zip archive as an untrusted container: its content is counted while it inflates, never believed.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use flate2::read::MultiGzDecoder;
use sha2::{Digest, Sha256};
use zip::ZipArchive;
use zip::result::ZipError;

use super::error::{ArchiveProblem, PackageError};
use super::limits::Limits;
use super::quote::quoted;
use super::raw::LONGEST_NAME;

/// Bytes to which even a small archive may expand.
const ALWAYS_EXPANDED: u64 = 64 << 20;

/// Zip archive whose directory has been checked: no two files of one name, none outside the package.
#[derive(Debug)]
pub(super) struct Archive {
    path: PathBuf,
    /// Entry index of each file, by its name without `./`.
    files: BTreeMap<String, usize>,
    /// Limit of the bytes that may leave decompressors.
    limit_bytes: u64,
    /// Bytes that have left a decompressor so far, over all files and threads.
    expanded: AtomicU64,
}

/// Content read from a file, and the SHA-256 of its decompressed bytes.
pub(super) struct Hashed<T> {
    pub(super) value: T,
    pub(super) sha256: [u8; 32],
}

impl Archive {
    pub(super) fn open(path: &Path, limits: &Limits) -> Result<Self, PackageError> {
        let zip = directory(path)?;
        if zip.len() > limits.entries {
            let problem = ArchiveProblem::TooManyFiles { entries: zip.len(), limit: limits.entries };
            return Err(PackageError::archive(None, problem));
        }
        if zip.has_duplicate_names() {
            return Err(PackageError::archive(
                repeated_name(path, zip.central_directory_start()).map(|name| quoted(&name)),
                ArchiveProblem::Repeated,
            ));
        }
        let mut files = BTreeMap::new();
        for (index, name) in zip.file_names().enumerate() {
            let name = name.map_err(|error| not_a_zip(&error))?;
            let Some(inside) = inside(&name) else {
                return Err(PackageError::archive(quoted(&name), ArchiveProblem::UnsafePath));
            };
            if inside.chars().nth(LONGEST_NAME).is_some() {
                let problem = ArchiveProblem::NameTooLong { limit: LONGEST_NAME };
                return Err(PackageError::archive(quoted(&inside), problem));
            }
            let is_folder = name.ends_with('/');
            if !is_folder && files.insert(inside.clone(), index).is_some() {
                return Err(PackageError::archive(inside, ArchiveProblem::Repeated));
            }
        }
        let size = std::fs::metadata(path)?.len();
        let in_proportion = ALWAYS_EXPANDED.saturating_add(limits.expansion.saturating_mul(size));
        let limit_bytes = limits.expanded_bytes.min(in_proportion);
        Ok(Self { path: path.to_owned(), files, limit_bytes, expanded: AtomicU64::new(0) })
    }

    /// Names of all files, sorted.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// Name under which `name` is stored: itself, or itself with `.gz`.
    pub(super) fn stored_name(&self, name: &str) -> Option<&str> {
        let stored = |name: &str| self.files.get_key_value(name).map(|(key, _)| key.as_str());
        stored(name).or_else(|| stored(&format!("{name}.gz")))
    }

    /// Reads one stored file, gunzipped if its name ends in `.gz`, and hashes it to its end.
    pub(super) fn read<T>(
        &self,
        name: &str,
        read: impl FnOnce(&mut dyn Read) -> Result<T, PackageError>,
    ) -> Result<Hashed<T>, PackageError> {
        self.inflate(name, |source| self.hash(name, source, read))
    }

    /// Copies one stored file, gunzipped if its name ends in `.gz`, to a temporary file: a zip inside the zip, whose
    /// entries are read in any order.
    pub(super) fn spool(&self, name: &str) -> Result<File, PackageError> {
        self.inflate(name, |source| {
            let mut file = tempfile::tempfile()?;
            io::copy(source, &mut file).map_err(|error| self.fault(name, error))?;
            Ok(file)
        })
    }

    /// Reads one stored file, gunzipped if its name ends in `.gz`, as far as `read` goes.
    ///
    /// Every call opens the archive anew, so that threads can read different files at the same time.
    pub(super) fn inflate<T>(
        &self,
        name: &str,
        read: impl FnOnce(&mut dyn Read) -> Result<T, PackageError>,
    ) -> Result<T, PackageError> {
        let mut zip = directory(&self.path)?;
        let Some(&index) = self.files.get(name) else {
            return Err(PackageError::archive(name.to_owned(), ArchiveProblem::Gone));
        };
        if zip.by_index_raw(index).map_err(|error| storage(name, error))?.encrypted() {
            return Err(PackageError::archive(name.to_owned(), ArchiveProblem::Encrypted));
        }
        let entry = zip.by_index(index).map_err(|error| storage(name, error))?;
        let inflated = self.counted(entry);
        if name.ends_with(".gz") {
            read(&mut self.counted(MultiGzDecoder::new(BufReader::new(inflated))))
        } else {
            read(&mut { inflated })
        }
    }

    /// Counts `source` against the expansion limit of the whole archive.
    pub(super) fn counted<R: Read>(&self, source: R) -> Counted<'_, R> {
        Counted { source, expanded: &self.expanded, limit_bytes: self.limit_bytes }
    }

    /// Applies `read` to `source`; returns its result with the SHA-256 of `source` to its end.
    pub(super) fn hash<T>(
        &self,
        name: &str,
        source: impl Read,
        read: impl FnOnce(&mut dyn Read) -> Result<T, PackageError>,
    ) -> Result<Hashed<T>, PackageError> {
        let mut source = Hashing { source, sha256: Sha256::new() };
        let value = read(&mut source)?;
        // The checksum of the archive is compared only at the very end of the file.
        io::copy(&mut source, &mut io::sink()).map_err(|error| self.fault(name, error))?;
        Ok(Hashed { value, sha256: source.sha256.finalize().into() })
    }

    /// Package error for an I/O error while reading `name`.
    pub(super) fn fault(&self, name: &str, error: io::Error) -> PackageError {
        if error.raw_os_error().is_some() {
            return error.into();
        }
        let problem = if error.get_ref().is_some_and(|inner| inner.is::<OverLimit>()) {
            ArchiveProblem::TooLarge { limit_bytes: self.limit_bytes }
        } else {
            ArchiveProblem::Damaged { reason: error.to_string() }
        };
        PackageError::archive(name.to_owned(), problem)
    }
}

fn directory(path: &Path) -> Result<ZipArchive<BufReader<File>>, PackageError> {
    ZipArchive::new(BufReader::new(File::open(path)?)).map_err(|error| match error {
        ZipError::Io(error) if error.raw_os_error().is_some() => error.into(),
        error => not_a_zip(&error),
    })
}

fn not_a_zip(error: &ZipError) -> PackageError {
    PackageError::archive(None, ArchiveProblem::NotAZip { reason: error.to_string() })
}

/// Package error for a problem with opening an entry.
pub(super) fn storage(name: &str, error: ZipError) -> PackageError {
    let problem = match error {
        ZipError::Io(error) if error.raw_os_error().is_some() => return error.into(),
        ZipError::CompressionMethodNotSupported(method) => {
            ArchiveProblem::UnsupportedCompression { method: format!("method {method}") }
        }
        ZipError::UnsupportedArchive(ZipError::PASSWORD_REQUIRED) => ArchiveProblem::Encrypted,
        ZipError::UnsupportedArchive(reason) => {
            ArchiveProblem::UnsupportedCompression { method: reason.into() }
        }
        error => ArchiveProblem::Damaged { reason: error.to_string() },
    };
    PackageError::archive(name.to_owned(), problem)
}

/// Path relative to the archive's root, without `.`; `None` if it leaves the archive on any system.
pub(super) fn inside(name: &str) -> Option<String> {
    let drive = name.as_bytes().get(1) == Some(&b':');
    if name.starts_with(['/', '\\'])
        || drive
        || name.contains('\0')
        || name.split(['/', '\\']).any(|part| part == "..")
    {
        return None;
    }
    Some(name.split('/').filter(|part| !part.is_empty() && *part != ".").collect::<Vec<_>>().join("/"))
}

/// First name that occurs twice in the central directory (the zip reader keeps only one of them).
fn repeated_name(path: &Path, central_directory_start: u64) -> Option<String> {
    use std::io::{Seek, SeekFrom};
    let mut file = BufReader::new(File::open(path).ok()?);
    file.seek(SeekFrom::Start(central_directory_start)).ok()?;
    let mut seen = std::collections::BTreeSet::new();
    loop {
        let mut header = [0_u8; 46];
        file.read_exact(&mut header).ok()?;
        if header[..4] != *b"PK\x01\x02" {
            return None;
        }
        let length = |at: usize| usize::from(u16::from_le_bytes([header[at], header[at + 1]]));
        let mut name = vec![0; length(28)];
        file.read_exact(&mut name).ok()?;
        file.seek_relative((length(30) + length(32)) as i64).ok()?;
        let name = String::from_utf8_lossy(&name).into_owned();
        if !seen.insert(name.clone()) {
            return Some(name);
        }
    }
}

/// Marker of the error of a reader that exceeded the expansion limit.
#[derive(Debug, thiserror::Error)]
#[error("the archive expands beyond the limit")]
struct OverLimit;

/// Reader that counts its bytes against the limit of the whole archive.
pub(super) struct Counted<'a, R> {
    source: R,
    expanded: &'a AtomicU64,
    limit_bytes: u64,
}

impl<R: Read> Read for Counted<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        let before = self.expanded.fetch_add(count as u64, Ordering::Relaxed);
        if before.saturating_add(count as u64) > self.limit_bytes {
            return Err(io::Error::other(OverLimit));
        }
        Ok(count)
    }
}

/// Reader that hashes its bytes.
struct Hashing<R> {
    source: R,
    sha256: Sha256,
}

impl<R: Read> Read for Hashing<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        self.sha256.update(&buffer[..count]);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::inside;

    #[test]
    fn paths_that_leave_the_archive_are_refused_on_every_system() {
        for name in [
            "/etc/passwd",
            "../m.mtx",
            "a/../../m.mtx",
            "..\\m.mtx",
            "C:\\m.mtx",
            "c:m.mtx",
            "\\\\host\\m",
            "a\0b",
        ] {
            assert_eq!(inside(name), None, "{name:?}");
        }
        assert_eq!(inside("./m.mtx").as_deref(), Some("m.mtx"));
        assert_eq!(inside("matrices//m..mtx").as_deref(), Some("matrices/m..mtx"));
    }
}
