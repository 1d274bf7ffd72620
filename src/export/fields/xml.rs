//! VTK's XML: data arrays in Base64.

use std::io::{self, BufWriter, Write};

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;

/// Writes the beginning of a file of this type, with a comment about the field.
pub(super) fn begin(out: &mut dyn Write, kind: &str, notes: &[&str]) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    for note in notes {
        // Two hyphens would end the comment.
        writeln!(out, "<!-- {} -->", note.replace("--", "- -"))?;
    }
    writeln!(
        out,
        "<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
    )
}

/// Number type of a data array.
pub(super) trait Number: Copy {
    /// VTK's name of the type.
    const NAME: &'static str;
    /// Writes the bytes of the number, the low one first.
    fn put(self, out: &mut dyn Write) -> io::Result<()>;
}

macro_rules! numbers {
    ($($number:ty = $name:literal),*) => {
        $(impl Number for $number {
            const NAME: &'static str = $name;
            fn put(self, out: &mut dyn Write) -> io::Result<()> {
                out.write_all(&self.to_le_bytes())
            }
        })*
    };
}

numbers!(f64 = "Float64", u64 = "UInt64", i64 = "Int64", i32 = "Int32", u8 = "UInt8");

/// Writes an array of so many numbers, `components` to a tuple, which `give` passes in pieces.
pub(super) fn array<T: Number>(
    out: &mut dyn Write,
    name: &str,
    (tuples, components): (usize, usize),
    give: impl FnOnce(&mut dyn FnMut(&[T]) -> io::Result<()>) -> io::Result<()>,
) -> io::Result<()> {
    write!(out, "<DataArray type=\"{}\" Name=\"{name}\"", T::NAME)?;
    if components > 1 {
        write!(out, " NumberOfComponents=\"{components}\"")?;
    }
    writeln!(out, " format=\"binary\">")?;
    // The encoder takes a short write for the end of the file; a buffer takes all.
    let mut buffer = BufWriter::new(&mut *out);
    let mut encoder = EncoderWriter::new(&mut buffer, &STANDARD);
    encoder.write_all(&((tuples * components * size_of::<T>()) as u64).to_le_bytes())?;
    give(&mut |numbers| numbers.iter().try_for_each(|number| number.put(&mut encoder)))?;
    encoder.finish()?;
    drop(encoder);
    buffer.flush()?;
    drop(buffer);
    writeln!(out, "\n</DataArray>")
}
