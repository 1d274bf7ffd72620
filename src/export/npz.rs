//! Arrays as numpy's `.npz`.

use std::io::{self, Seek, Write};

use super::array::{Array, Values};
use crate::package::NpzWriter;

/// Writes arrays into a new file. Whole numbers some of which are absent become real ones, with NaN.
///
/// # Errors
/// Errors of writing.
pub fn write(arrays: &[Array], out: &mut dyn Write) -> io::Result<()> {
    let mut npz = NpzWriter::stream(out);
    add(arrays, &mut npz)?;
    npz.finish()
}

/// Adds arrays to a file.
pub(super) fn add<W: Write + Seek>(arrays: &[Array], npz: &mut NpzWriter<W>) -> io::Result<()> {
    for Array { name, shape, values, .. } in arrays {
        match values {
            Values::Real(values) => npz.reals(name, shape, values.iter().copied())?,
            Values::Whole(values) => match values.iter().copied().collect::<Option<Vec<u32>>>() {
                Some(values) => npz.integers(name, shape, values.into_iter().map(i64::from))?,
                None => {
                    npz.reals(name, shape, values.iter().map(|value| value.map_or(f64::NAN, f64::from)))?
                }
            },
            Values::Flag(values) => npz.flags(name, shape, values.iter().copied())?,
            Values::Text(values) => npz.texts(name, shape, values)?,
        }
    }
    Ok(())
}
