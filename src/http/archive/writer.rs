//! Writing a zip that says what is in it.

use std::io::{self, Write};

use sha2::{Digest, Sha256};
use zip::write::{SimpleFileOptions, StreamWriter};
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::manifest::Entry;

/// Entries that are as long as this may not know their length in four bytes.
const LARGE: u64 = u32::MAX as u64 / 2;

/// A zip that is written from its beginning to its end, and the digests of its entries. The same entries give the same bytes.
pub(super) struct Writer<W: Write> {
    zip: ZipWriter<StreamWriter<W>>,
    entries: Vec<Entry>,
}

impl<W: Write> Writer<W> {
    pub(super) fn new(out: W) -> Self {
        Self { zip: ZipWriter::new_stream(out), entries: Vec::new() }
    }

    /// Adds an entry of about so many `bytes`; what is a zip itself is not deflated once more.
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

    /// What was added so far.
    pub(super) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.zip.finish()?.flush()
    }
}

/// Hashes what is written.
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
