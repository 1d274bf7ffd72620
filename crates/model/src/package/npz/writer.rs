//! Writer of `.npz` files as numpy writes them: a zip of arrays, one after the other.

use std::io::{self, BufWriter, Seek, Write};

use zip::result::ZipError;
use zip::write::{SimpleFileOptions, StreamWriter};
use zip::{CompressionMethod, ZipWriter};

use crate::package::npy;

/// Writer of an `.npz` file array by array, in constant memory; `numpy.load` reads the file.
///
/// ```
/// use rubmap_model::package::NpzWriter;
///
/// let mut file = Vec::new();
/// let mut npz = NpzWriter::stream(&mut file);
/// npz.reals("speeds_rad_s", &[3], [100.0, 200.0, f64::NAN])?;
/// npz.texts("version", &[], &["0.1.0"])?;
/// npz.finish()?;
/// assert!(file.starts_with(b"PK"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub struct NpzWriter<W: Write + Seek> {
    zip: ZipWriter<W>,
}

impl<W: Write> NpzWriter<StreamWriter<W>> {
    /// Writer into a stream, which can only be written from its beginning to its end.
    pub fn stream(out: W) -> Self {
        Self { zip: ZipWriter::new_stream(out) }
    }
}

impl<W: Write + Seek> NpzWriter<W> {
    /// Writer into a file.
    pub(super) fn new(out: W) -> Self {
        Self { zip: ZipWriter::new(out) }
    }

    /// Writes an array of float64.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn reals(
        &mut self,
        name: &str,
        shape: &[usize],
        values: impl IntoIterator<Item = f64>,
    ) -> io::Result<()> {
        self.reals_by(name, shape, |take| values.into_iter().try_for_each(take))
    }

    /// Writes an array of float64 whose elements `give` passes one by one, in the order of C.
    ///
    /// # Errors
    /// Errors of writing and of `give`.
    pub fn reals_by(
        &mut self,
        name: &str,
        shape: &[usize],
        give: impl FnOnce(&mut dyn FnMut(f64) -> io::Result<()>) -> io::Result<()>,
    ) -> io::Result<()> {
        // No deflating would shrink them by much.
        let mut file = self.begin(name, CompressionMethod::Stored, "<f8", shape)?;
        give(&mut |value| file.write_all(&value.to_le_bytes()))?;
        file.flush()
    }

    /// Writes an array of int64.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn integers(
        &mut self,
        name: &str,
        shape: &[usize],
        values: impl IntoIterator<Item = i64>,
    ) -> io::Result<()> {
        let values = values.into_iter().map(i64::to_le_bytes);
        self.elements(name, CompressionMethod::Deflated, "<i8", shape, values)
    }

    /// Writes an array of uint64: numbers that users gave, which may be larger than int64 holds.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn ids(&mut self, name: &str, shape: &[usize], ids: impl IntoIterator<Item = u64>) -> io::Result<()> {
        let ids = ids.into_iter().map(u64::to_le_bytes);
        self.elements(name, CompressionMethod::Deflated, "<u8", shape, ids)
    }

    /// Writes an array of truth values.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn flags(
        &mut self,
        name: &str,
        shape: &[usize],
        values: impl IntoIterator<Item = bool>,
    ) -> io::Result<()> {
        let values = values.into_iter().map(|value| [u8::from(value)]);
        self.elements(name, CompressionMethod::Deflated, "|b1", shape, values)
    }

    /// Writes an array of texts, each as wide as the longest.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn texts(&mut self, name: &str, shape: &[usize], values: &[impl AsRef<str>]) -> io::Result<()> {
        let characters = |text: &str| text.chars().count();
        let width = values.iter().map(|text| characters(text.as_ref())).max().unwrap_or(0).max(1);
        let padded = values.iter().flat_map(|text| {
            let text = text.as_ref();
            text.chars().chain(std::iter::repeat_n('\0', width - characters(text)))
        });
        let padded = padded.map(|character| u32::from(character).to_le_bytes());
        self.elements(name, CompressionMethod::Deflated, &format!("<U{width}"), shape, padded)
    }

    /// Writes an array of any type that numpy knows, from the bytes of its elements.
    pub(super) fn elements<const SIZE: usize>(
        &mut self,
        name: &str,
        method: CompressionMethod,
        descr: &str,
        shape: &[usize],
        elements: impl IntoIterator<Item = [u8; SIZE]>,
    ) -> io::Result<()> {
        let mut file = self.begin(name, method, descr, shape)?;
        elements.into_iter().try_for_each(|element| file.write_all(&element))?;
        file.flush()
    }

    /// Writes the end of the file, after the last array.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn finish(self) -> io::Result<()> {
        self.zip.finish().map_err(own)?;
        Ok(())
    }

    fn begin(
        &mut self,
        name: &str,
        method: CompressionMethod,
        descr: &str,
        shape: &[usize],
    ) -> io::Result<BufWriter<&mut ZipWriter<W>>> {
        let options = SimpleFileOptions::default().compression_method(method).large_file(true);
        self.zip.start_file(format!("{name}.npy"), options).map_err(own)?;
        let sizes: String = shape.iter().map(|size| format!("{size},")).collect();
        let mut file = BufWriter::new(&mut self.zip);
        // numpy writes (3, 4) and reads (3,4,) as well.
        file.write_all(&npy::header(descr, &format!("({sizes})")))?;
        Ok(file)
    }
}

/// I/O error inside a zip error: the system's own one, whose number tells whether it may pass.
fn own(error: ZipError) -> io::Error {
    match error {
        ZipError::Io(source) => source,
        error => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use zip::ZipArchive;

    use super::*;
    use crate::package::npy::Npy;

    #[test]
    fn what_is_streamed_is_read_back() {
        let mut file = Vec::new();
        let mut npz = NpzWriter::stream(&mut file);
        let values = [1.5, -0.0, 1e-300];
        npz.reals("reals", &[3], values).unwrap();
        npz.integers("integers", &[2], [-1, 1 << 40]).unwrap();
        npz.texts("text", &[], &["rad/s"]).unwrap();
        npz.finish().unwrap();
        let mut zip = ZipArchive::new(Cursor::new(file)).unwrap();
        let mut read = Vec::new();
        let mut entry = zip.by_name("reals.npy").unwrap();
        Npy::open("reals", &mut entry)
            .unwrap()
            .reals(|_, value| {
                read.push(value);
                Ok(())
            })
            .unwrap();
        drop(entry);
        assert_eq!(read.into_iter().map(f64::to_bits).collect::<Vec<_>>(), values.map(f64::to_bits));
        let mut read = Vec::new();
        let mut entry = zip.by_name("integers.npy").unwrap();
        Npy::open("integers", &mut entry)
            .unwrap()
            .integers(|_, value| {
                read.push(value);
                Ok(())
            })
            .unwrap();
        drop(entry);
        assert_eq!(read, [-1, 1 << 40]);
        let mut entry = zip.by_name("text.npy").unwrap();
        assert_eq!(Npy::open("text", &mut entry).unwrap().text().unwrap(), "rad/s");
    }
}
