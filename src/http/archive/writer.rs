//! Writer of zip files that lists the digests of their entries.

use std::io::{self, Write};

use sha2::{Digest, Sha256};
use zip::write::{SimpleFileOptions, StreamWriter};
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::manifest::Entry;

/// Length in bytes above which an entry is written as a large one: its true length may not fit into four bytes.
const LARGE: u64 = u32::MAX as u64 / 2;

/// Zip file that is written from beginning to end, and the digests of its entries. The same entries give the same bytes.
pub(super) struct Writer<W: Write> {
    zip: ZipWriter<StreamWriter<W>>,
    entries: Vec<Entry>,
}

impl<W: Write> Writer<W> {
    pub(super) fn new(out: W) -> Self {
        Self { zip: ZipWriter::new_stream(out), entries: Vec::new() }
    }

    /// Adds an entry of about `bytes` bytes; an entry that is a zip file itself is not deflated again.
    pub(super) fn add(
        &mut self,
        name: &str,
        bytes: u64,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let is_zip = name.ends_with(".zip");
        let method = if is_zip { CompressionMethod::Stored } else { CompressionMethod::Deflated };
        let options = SimpleFileOptions::default()
            .compression_method(method)
            .last_modified_time(DateTime::default())
            .large_file(bytes > LARGE);
        self.zip.start_file(name, options)?;
        let mut entry = Hashing { out: &mut self.zip, sha256: Sha256::new(), bytes: 0 };
        write(&mut entry)?;
        let (bytes, sha256) = (entry.bytes, format!("{:x}", entry.sha256.finalize()));
        self.entries.push(Entry { name: name.to_owned(), bytes, sha256 });
        Ok(())
    }

    /// Adds an entry in JSON.
    pub(super) fn json(&mut self, name: &str, bytes: u64, value: &impl serde::Serialize) -> io::Result<()> {
        self.add(name, bytes, |out| Ok(serde_json::to_writer(out, value)?))
    }

    /// Entries added so far.
    pub(super) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.zip.finish()?.flush()
    }
}

/// Output that hashes and counts the bytes written to it.
struct Hashing<'a, W> {
    out: &'a mut W,
    sha256: Sha256,
    bytes: u64,
}

impl<W: Write> Write for Hashing<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.sha256.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
