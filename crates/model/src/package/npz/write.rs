//! Writer of matrices as scipy writes them.

use std::io::{self, Seek, Write};

use zip::CompressionMethod;

use super::writer::NpzWriter;
use crate::package::raw::RawMatrix;
use crate::package::symmetric::Entry;

/// Writes the lower triangle in compressed columns, as scipy would: `scipy.sparse.load_npz` reads it.
///
/// Indices are deflated, which makes them several times smaller; values are stored, as deflating would hardly shrink them.
pub(crate) fn write(matrix: &RawMatrix, out: impl Write + Seek) -> io::Result<()> {
    let mut sorted: Vec<&Entry> = matrix.entries.iter().collect();
    sorted.sort_by_key(|entry| (entry.1, entry.0));
    let mut starts = vec![0_i64; matrix.size + 1];
    for entry in &sorted {
        starts[entry.1 as usize + 1] += 1;
    }
    for k in 0..matrix.size {
        starts[k + 1] += starts[k];
    }
    let mut npz = NpzWriter::new(out);
    let (entries, pointers) = ([sorted.len()], [matrix.size + 1]);
    let deflated = CompressionMethod::Deflated;
    npz.elements("indices", deflated, "<i4", &entries, sorted.iter().map(|e| (e.0 as i32).to_le_bytes()))?;
    if i32::try_from(sorted.len()).is_ok() {
        let starts = starts.iter().map(|s| (*s as i32).to_le_bytes());
        npz.elements("indptr", deflated, "<i4", &pointers, starts)?;
    } else {
        npz.integers("indptr", &pointers, starts)?;
    }
    npz.elements("format", CompressionMethod::Stored, "|S3", &[], [*b"csc"])?;
    let size = (matrix.size as i64).to_le_bytes();
    npz.elements("shape", CompressionMethod::Stored, "<i8", &[2], [size, size])?;
    npz.reals("data", &entries, sorted.iter().map(|e| e.2))?;
    npz.finish()
}
