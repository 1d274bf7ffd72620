//! Files as they are read: unpacked by gzip, and text of two bytes for each character as UTF-8.

use std::borrow::Cow;
use std::io::Read;

use flate2::read::MultiGzDecoder;

use crate::error::{MeshFileError, MeshProblem};

/// First bytes of gzip.
const GZIP: &[u8] = &[0x1f, 0x8b];

/// Number of bytes that a packed file of any size may have once it is unpacked.
const FREE: u64 = 64 << 20;

/// Largest number of bytes for each packed one beyond [`FREE`]; text of meshes packs to a fifth or a tenth.
const EXPANSION: u64 = 100;

/// Largest number of bytes of a file that was packed: meshes of millions of nodes stay below, and it fits into memory.
const MOST: u64 = 1 << 30;

/// Content of a file, unpacked and in UTF-8 where it was packed or in UTF-16.
///
/// # Errors
/// [`MeshProblem::Packed`] for a packed file that is damaged or too large.
pub(crate) fn plain(bytes: &[u8]) -> Result<Cow<'_, [u8]>, MeshFileError> {
    if !bytes.starts_with(GZIP) {
        return Ok(utf8(bytes));
    }
    let limit = (EXPANSION * bytes.len() as u64).saturating_add(FREE).min(MOST);
    let mut found = Vec::new();
    let packed = |problem: String| MeshProblem::Packed { problem }.at(0, "");
    let read = MultiGzDecoder::new(bytes).take(limit + 1).read_to_end(&mut found);
    read.map_err(|error| packed(format!("cannot be unpacked ({error}): is it cut short?")))?;
    if found.len() as u64 > limit {
        return Err(packed(format!("has more than {limit} bytes once it is unpacked; give it unpacked")));
    }
    Ok(Cow::Owned(utf8(&found).into_owned()))
}

/// Text in UTF-8 for text in UTF-16 that begins with a mark of the byte order; other bytes unchanged.
fn utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return Cow::Borrowed(bytes),
    };
    let units = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Cow::Owned(text.into_bytes())
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::plain;
    use crate::{MeshFormat, read};

    const DECK: &str =
        "** für Prüfung\n*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4,ELSET=E\n1,1,2,3,4\n";

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut file = GzEncoder::new(Vec::new(), Compression::default());
        file.write_all(bytes).unwrap();
        file.finish().unwrap()
    }

    fn utf16(text: &str, unit: fn(u16) -> [u8; 2]) -> Vec<u8> {
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(unit).collect()
    }

    #[test]
    fn packed_files_and_utf16_are_read_as_what_they_hold() {
        let none = |_: &str| Err(String::new());
        let expected = read(DECK.as_bytes(), &none).unwrap();
        let [little, big] = [u16::to_le_bytes, u16::to_be_bytes].map(|unit| utf16(DECK, unit));
        let halves = [packed(&DECK.as_bytes()[..30]), packed(&DECK.as_bytes()[30..])].concat();
        for file in [packed(DECK.as_bytes()), packed(&little), halves, little, big] {
            assert_eq!(read(&file, &none).unwrap(), expected);
        }
        // Included files are read alike.
        let file = |_: &str| Ok(packed(DECK.as_bytes()));
        assert_eq!(read(b"*INCLUDE, INPUT=MESH.INP.GZ\n", &file).unwrap().elements.len(), 1);
        let vtu = packed(b"<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\">");
        assert_eq!(crate::format::recognised(&plain(&vtu).unwrap()).unwrap(), MeshFormat::Vtu);
    }

    #[test]
    fn damaged_and_swollen_files_are_refused() {
        let none = |_: &str| Err(String::new());
        let refused = |file: &[u8]| read(file, &none).unwrap_err().to_string();
        let file = packed(DECK.as_bytes());
        for cut in [2, 12, file.len() - 9, file.len() - 1] {
            let message = refused(&file[..cut]);
            assert!(message.starts_with("the packed file cannot be unpacked"), "{message}");
        }
        let message = refused(&packed(&vec![b' '; 100 << 20]));
        assert!(message.contains("bytes once it is unpacked; give it unpacked"), "{message}");
    }
}
