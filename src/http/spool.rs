//! Files in which answers wait for slow clients.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Files in which answers wait for slow clients. They have no names, so that the rest of them goes with the process.
#[derive(Debug)]
pub(super) struct Spool {
    folder: PathBuf,
    bytes: AtomicU64,
    /// Largest number of bytes of all answers together.
    most: u64,
}

/// Part of an answer that waits for its client.
pub(super) struct Later {
    pub(super) file: File,
    pub(super) held: Held,
}

/// Bytes of the spool that an answer holds; dropping gives them back.
pub(super) struct Held {
    spool: Arc<Spool>,
    bytes: u64,
}

impl Spool {
    /// Spool in `folder`, of at most so many bytes.
    pub(super) fn new(folder: &Path, most: u64) -> Self {
        Self { folder: folder.to_owned(), bytes: AtomicU64::new(0), most }
    }

    /// Bytes of all answers that wait.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// Makes the file of an answer.
    pub(super) fn begin(self: &Arc<Self>) -> io::Result<Later> {
        let file = tempfile::tempfile_in(&self.folder)?;
        Ok(Later { file, held: Held { spool: Arc::clone(self), bytes: 0 } })
    }
}

impl Later {
    /// Writes a piece behind the others; returns false, with the file as it was, where there is no room for it.
    pub(super) fn add(&mut self, piece: &[u8]) -> io::Result<bool> {
        let (end, length) = (self.held.bytes, piece.len() as u64);
        if !self.held.reserve(length) {
            return Ok(false);
        }
        let Err(error) = self.file.write_all(piece) else { return Ok(true) };
        self.held.give_back(length);
        self.file.set_len(end)?;
        self.file.seek(SeekFrom::Start(end))?;
        if error.kind() == io::ErrorKind::StorageFull { Ok(false) } else { Err(error) }
    }

    pub(super) fn rewound(mut self) -> io::Result<Self> {
        self.file.rewind()?;
        Ok(self)
    }
}

impl Held {
    /// Takes room for more bytes, if all answers together leave so much.
    fn reserve(&mut self, more: u64) -> bool {
        let fits = |held: u64| Some(held + more).filter(|held| *held <= self.spool.most);
        let taken = self.spool.bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, fits).is_ok();
        self.bytes += if taken { more } else { 0 };
        taken
    }

    fn give_back(&mut self, bytes: u64) {
        self.bytes -= bytes;
        self.spool.bytes.fetch_sub(bytes, Ordering::Relaxed);
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        self.give_back(self.bytes);
    }
}
