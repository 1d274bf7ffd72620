//! Parts of a file: its XML, and the data appended behind, which need not be XML.

use crate::error::{MeshFileError, MeshProblem};

/// Beginning of the element that holds appended data.
const APPENDED: &[u8] = b"<AppendedData";
/// Longest tag; VTK writes none longer than a few hundred characters. The parser compares the attributes of a tag with each other.
const LONGEST_TAG: usize = 4096;
/// Most elements and texts of the XML; VTK writes some three for each array.
const MOST_NODES: u32 = 100_000;

/// Data behind the XML.
#[derive(Clone, Copy)]
pub(super) struct Appended<'a> {
    /// Bytes behind the underscore with which they begin.
    pub(super) data: &'a [u8],
    /// Whether they are base64 text.
    pub(super) base64: bool,
}

/// Cuts a file into its XML, closed where data are appended, and those data.
pub(super) fn cut(bytes: &[u8]) -> Result<(String, Option<Appended<'_>>), MeshFileError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let place = bytes.windows(APPENDED.len()).position(|window| window == APPENDED);
    let (head, tail) = bytes.split_at(place.unwrap_or(bytes.len()));
    let head = str::from_utf8(head).map_err(|_| {
        MeshProblem::Expected { expected: "XML in UTF-8 before any appended data".to_owned() }.at(0, "")
    })?;
    for piece in head.split('<').filter(|piece| !piece.starts_with('!')) {
        if piece.rfind('>').unwrap_or(piece.len()) > LONGEST_TAG {
            let expected = format!("tags of at most {LONGEST_TAG} characters");
            return Err(MeshProblem::Expected { expected }.at(0, ""));
        }
    }
    if place.is_none() {
        return Ok((head.to_owned(), None));
    }
    Ok((format!("{head}</VTKFile>"), Some(appended(tail)?)))
}

/// Data of the element that begins here.
fn appended(tail: &[u8]) -> Result<Appended<'_>, MeshFileError> {
    let after = |mark: u8, bytes: &[u8]| bytes.iter().position(|&b| b == mark).map(|place| place + 1);
    let cut = || MeshProblem::CutShort { expected: "the appended data".to_owned() }.at(0, "AppendedData");
    let end = after(b'>', tail).ok_or_else(cut)?;
    let (tag, rest) = tail.split_at(end);
    let tag = String::from_utf8_lossy(tag).replace('\'', "\"");
    let base64 = tag.contains("encoding=\"base64\"");
    if !base64 && !tag.contains("encoding=\"raw\"") {
        let expected = "encoding=\"raw\" or encoding=\"base64\"".to_owned();
        return Err(MeshProblem::Expected { expected }.at(0, "AppendedData"));
    }
    let begin = after(b'_', rest).ok_or_else(cut)?;
    Ok(Appended { data: rest.get(begin..).unwrap_or_default(), base64 })
}

/// Parses XML.
pub(super) fn parsed(text: &str) -> Result<roxmltree::Document<'_>, MeshFileError> {
    let options = roxmltree::ParsingOptions { nodes_limit: MOST_NODES, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options).map_err(|error| {
        if text.contains("</VTKFile") {
            MeshProblem::Expected { expected: format!("well-formed XML: {error}") }.at(0, "")
        } else {
            MeshProblem::CutShort { expected: "</VTKFile>".to_owned() }.at(0, "")
        }
    })
}
