//! Writing matrices as scipy does.

use std::io::{self, BufWriter, Seek, Write};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::package::npy;
use crate::package::raw::RawMatrix;
use crate::package::symmetric::Entry;

/// Writes the lower triangle in compressed columns, as scipy would: `scipy.sparse.load_npz` reads it.
///
/// Indices are deflated, which makes them several times smaller; values are stored, which no deflating would shrink
/// by much.
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
    let mut zip = ZipWriter::new(out);
    let entries = format!("({},)", sorted.len());
    let deflated = CompressionMethod::Deflated;
    array(&mut zip, "indices", deflated, "<i4", &entries, sorted.iter().map(|e| (e.0 as i32).to_le_bytes()))?;
    let pointers = format!("({},)", matrix.size + 1);
    if i32::try_from(sorted.len()).is_ok() {
        array(
            &mut zip,
            "indptr",
            deflated,
            "<i4",
            &pointers,
            starts.iter().map(|s| (*s as i32).to_le_bytes()),
        )?;
    } else {
        array(&mut zip, "indptr", deflated, "<i8", &pointers, starts.iter().map(|s| s.to_le_bytes()))?;
    }
    array(&mut zip, "format", CompressionMethod::Stored, "|S3", "()", [*b"csc"])?;
    let size = (matrix.size as i64).to_le_bytes();
    array(&mut zip, "shape", CompressionMethod::Stored, "<i8", "(2,)", [size, size])?;
    array(
        &mut zip,
        "data",
        CompressionMethod::Stored,
        "<f8",
        &entries,
        sorted.iter().map(|e| e.2.to_le_bytes()),
    )?;
    zip.finish().map_err(own)?;
    Ok(())
}

/// The system's own error, by whose number it is known what may pass.
fn own(error: ZipError) -> io::Error {
    match error {
        ZipError::Io(source) => source,
        error => error.into(),
    }
}

fn array<const SIZE: usize>(
    zip: &mut ZipWriter<impl Write + Seek>,
    name: &str,
    method: CompressionMethod,
    descr: &str,
    shape: &str,
    elements: impl IntoIterator<Item = [u8; SIZE]>,
) -> io::Result<()> {
    zip.start_file(
        format!("{name}.npy"),
        SimpleFileOptions::default().compression_method(method).large_file(true),
    )
    .map_err(own)?;
    let mut file = BufWriter::new(zip);
    file.write_all(&npy::header(descr, shape))?;
    elements.into_iter().try_for_each(|element| file.write_all(&element))?;
    file.flush()
}
