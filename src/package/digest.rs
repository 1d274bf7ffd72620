//! The content address of a package.
//!
//! What counts: the *values* `sector.json` states, and the decompressed bytes of every other file under its name.
//! What does not: how the archive is made (order, compression, times, folders' entries), whether a file is stored as
//! `m.mtx` or `m.mtx.gz` (`.gz` is dropped from names, inside `sector.json` too), and the layout of `sector.json`
//! (white space, order of fields). Of a `.npz` matrix its arrays count, not how they are zipped (numpy writes the time of
//! day there, and compresses or not). Two texts of the same numbers (`1.0` and `1e0` in a matrix) are two contents.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use super::raw::Manifest;

/// Changes whenever the rules above change, so that no old address can name a new content.
const RULES: &str = "rubmap package 1";

/// Lowercase hexadecimal SHA-256 of a package, from the manifest and the `(name, sha256)` of the other files.
pub(super) fn digest<'a>(manifest: &Manifest, files: impl Iterator<Item = (&'a str, [u8; 32])>) -> String {
    let mut total = Sha256::new();
    let mut part = |bytes: &[u8]| {
        // Lengths first: no two lists of parts can run together into the same bytes.
        total.update((bytes.len() as u64).to_le_bytes());
        total.update(bytes);
    };
    part(RULES.as_bytes());
    let mut manifest = manifest.clone();
    for name in [&mut manifest.mass, &mut manifest.nodes, &mut manifest.dofs]
        .into_iter()
        .chain(&mut manifest.stiffness)
    {
        *name = plain(name).to_owned();
    }
    // `Debug` prints every field by name and every number shortest-round-trip, and cannot fail.
    part(format!("{manifest:?}").as_bytes());
    let mut files: Vec<_> = files.map(|(name, hash)| (plain(name), hash)).collect();
    files.sort_unstable();
    files.dedup();
    for (name, hash) in files {
        part(name.as_bytes());
        part(&hash);
    }
    total.finalize().iter().fold(String::with_capacity(64), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    })
}

/// The name of a file without `.gz`.
fn plain(name: &str) -> &str {
    name.strip_suffix(".gz").unwrap_or(name)
}
