//! Archive of a job as it is read: nothing in it is believed before it was checked against its manifest.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};
use zip::ZipArchive;

use crate::http::archive::manifest::{Entry, FORMAT, MANIFEST, Manifest};

/// Bytes that even a small archive may expand to.
const ALWAYS_EXPANDED: u64 = 1 << 30;

/// Further bytes, beyond [`ALWAYS_EXPANDED`], to which an archive may expand for each of its own; zeros deflate to a thousandth, spectra to a third.
const EXPANSION: u64 = 200;

/// Longest entry that is read as a whole.
const LONGEST_JSON: u64 = 256 << 20;

/// Archive of a job with its manifest.
pub(super) struct Archive {
    path: PathBuf,
    pub(super) manifest: Manifest,
}

impl Archive {
    /// Opens an archive and reads its manifest.
    ///
    /// # Errors
    /// A file that is no archive of a job, or has a format that this program does not know.
    pub(super) fn open(path: &Path) -> anyhow::Result<Self> {
        let here = path.display();
        let mut zip = directory(path)?;
        if zip.has_duplicate_names() {
            bail!("{here} has two entries of one name: it is no archive of a job");
        }
        let Ok(entry) = zip.by_name(MANIFEST) else {
            // An archive that is cut off may end with the package, which is a zip itself.
            bail!("{here} is no archive of a job, or is not whole: there is no {MANIFEST} in it");
        };
        let mut text = Vec::new();
        entry.take(LONGEST_JSON).read_to_end(&mut text).with_context(|| format!("{MANIFEST} of {here}"))?;
        // Another format may have other fields.
        #[derive(serde::Deserialize)]
        struct Form {
            format: u32,
        }
        let bad = || format!("{here} is no archive of a job, or is damaged: {MANIFEST}");
        let Form { format } = serde_json::from_slice(&text).with_context(bad)?;
        if format != FORMAT {
            bail!("{here} is an archive of form {format}; this program knows form {FORMAT}");
        }
        let manifest: Manifest = serde_json::from_slice(&text).with_context(bad)?;
        let expanded = manifest.entries.iter().fold(0u64, |sum, entry| sum.saturating_add(entry.bytes));
        let limit = ALWAYS_EXPANDED.saturating_add(EXPANSION.saturating_mul(path.metadata()?.len()));
        if expanded > limit {
            bail!(
                "{here} would expand to {expanded} bytes, more than the {limit} that an archive of its size may have"
            );
        }
        Ok(Self { path: path.to_owned(), manifest })
    }

    /// Entries that are not as the manifest says, in words; empty if all is well.
    pub(super) fn wrong(&self) -> anyhow::Result<Vec<String>> {
        let mut zip = directory(&self.path)?;
        let mut wrong = Vec::new();
        let known: BTreeSet<&str> = self.manifest.entries.iter().map(|entry| entry.name.as_str()).collect();
        for name in zip.file_names() {
            match name {
                Ok(name) if name == MANIFEST || known.contains(name.as_ref()) => {}
                Ok(name) => wrong.push(format!("{name:?} is not in {MANIFEST}")),
                Err(error) => wrong.push(format!("an entry has a name that cannot be read: {error}")),
            }
        }
        for entry in &self.manifest.entries {
            if let Err(error) = copy(&mut zip, entry, &mut io::sink()) {
                wrong.push(format!("{:?} {error:#}", entry.name));
            }
        }
        Ok(wrong)
    }

    /// Entry of this name, if there is one.
    pub(super) fn entry(&self, name: &str) -> Option<&Entry> {
        self.manifest.entries.iter().find(|entry| entry.name == name)
    }

    /// Copies an entry.
    pub(super) fn extract(&self, name: &str, to: &mut impl Write) -> anyhow::Result<()> {
        let Some(entry) = self.entry(name) else {
            bail!("{} has no {name}: it is no archive of a job", self.path.display());
        };
        let copied = copy(&mut directory(&self.path)?, entry, to);
        copied.with_context(|| format!("{name} of {}", self.path.display()))
    }

    /// Reads a JSON entry.
    pub(super) fn json<T: DeserializeOwned>(&self, name: &str) -> anyhow::Result<T> {
        if self.entry(name).is_some_and(|entry| entry.bytes > LONGEST_JSON) {
            bail!("{name} is too long to be read");
        }
        let mut text = Vec::new();
        self.extract(name, &mut text)?;
        serde_json::from_slice(&text).with_context(|| format!("{name} of {}", self.path.display()))
    }
}

fn directory(path: &Path) -> anyhow::Result<ZipArchive<BufReader<File>>> {
    let file = File::open(path).with_context(|| format!("cannot read {}", path.display()))?;
    ZipArchive::new(BufReader::new(file))
        .with_context(|| format!("{} is no zip archive, or not whole", path.display()))
}

/// Copies an entry up to the size that the manifest states.
fn copy(zip: &mut ZipArchive<BufReader<File>>, entry: &Entry, to: &mut impl Write) -> anyhow::Result<()> {
    let source = zip.by_name(&entry.name).context("cannot be read")?;
    let mut source = Hashing { source: source.take(entry.bytes.saturating_add(1)), sha256: Sha256::new() };
    let bytes = io::copy(&mut source, to).context("cannot be read")?;
    if bytes > entry.bytes {
        bail!("is longer than the {} bytes of {MANIFEST}", entry.bytes);
    }
    if bytes < entry.bytes || format!("{:x}", source.sha256.finalize()) != entry.sha256 {
        bail!("is not what {MANIFEST} says: its SHA-256 is another");
    }
    Ok(())
}

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
