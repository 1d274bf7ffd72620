//! Data arrays in all encodings of VTK's XML.

use std::cell::Cell;
use std::io::Read;

use flate2::read::ZlibDecoder;
use roxmltree::Node;

use super::document::Appended;
use super::numbers::{Numbers, Type, little};
use super::source::Source;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, quoted};

/// Bytes of decoded numbers allowed for each byte of the file: grids of equal cubes take seven, and zlib could make a thousand of one.
const EXPANSION: usize = 50;
/// Bytes of decoded numbers allowed for any file.
const ANYWAY: usize = 1 << 20;

/// Encoding of a file's arrays.
pub(super) struct Arrays<'a> {
    appended: Option<Appended<'a>>,
    /// Bytes of a number in the headers of binary data.
    header: usize,
    compressed: bool,
    /// Bytes of numbers that may still be decoded.
    budget: Cell<usize>,
}

impl<'a> Arrays<'a> {
    /// Encoding that the root element of a file of so many bytes states.
    pub(super) fn of(root: Node, appended: Option<Appended<'a>>, length: usize) -> Result<Self, MeshProblem> {
        if root.attribute("byte_order") == Some("BigEndian") {
            let what = "data in big-endian byte order".to_owned();
            return Err(MeshProblem::NotCarried {
                what,
                advice: "write the file as LittleEndian or as text",
            });
        }
        let header = match root.attribute("header_type") {
            None | Some("UInt32") => 4,
            Some("UInt64") => 8,
            Some(other) => {
                let expected = "a header_type: UInt32 or UInt64";
                return Err(MeshProblem::NotA { text: quoted(other), expected });
            }
        };
        let compressor = root.attribute("compressor").unwrap_or_default();
        if !compressor.is_empty() && compressor != "vtkZLibDataCompressor" {
            let what = format!("data compressed by {}", quoted(compressor));
            return Err(MeshProblem::NotCarried {
                what,
                advice: "write the file with ZLib or without compression",
            });
        }
        let budget = Cell::new(length.saturating_mul(EXPANSION).saturating_add(ANYWAY));
        Ok(Self { appended, header, compressed: !compressor.is_empty(), budget })
    }

    /// Numbers of an array, exactly so many.
    pub(super) fn numbers(&self, array: Node, count: usize) -> Result<Numbers, MeshFileError> {
        let name = array.attribute("Name").unwrap_or("DataArray");
        self.read(array, count).map_err(|problem| problem.at(0, &quoted(name)))
    }

    /// Numbers of an array, of which the error does not name the place.
    fn read(&self, array: Node, count: usize) -> Result<Numbers, MeshProblem> {
        let of = Type::of(array)?;
        // Other elements may stand in front of the numbers.
        let mut texts = array.children().filter(Node::is_text).filter_map(|child| child.text());
        let text = texts.find(|text| !text.trim().is_empty()).unwrap_or_default();
        let source = match array.attribute("format").unwrap_or("ascii") {
            "ascii" => return of.parsed(text, count),
            "binary" => Source::base64(text.as_bytes()),
            "appended" => self.appended(array)?,
            other => {
                let expected = "a format: ascii, binary or appended";
                return Err(MeshProblem::NotA { text: quoted(other), expected });
            }
        };
        // Numbers take eight bytes here, whatever they take in the file.
        let left = count.checked_mul(size_of::<f64>()).and_then(|bytes| self.budget.get().checked_sub(bytes));
        self.budget.set(left.ok_or_else(|| {
            let what = format!("an array of {count} numbers in a file of this size");
            MeshProblem::NotCarried { what, advice: "write the file without compression" }
        })?);
        let size = count.saturating_mul(of.size);
        let bytes = if self.compressed { self.inflated(source, size)? } else { self.plain(source, size)? };
        Ok(of.decoded(&bytes))
    }

    /// Source of an array among the appended data.
    fn appended(&self, array: Node) -> Result<Source<'a>, MeshProblem> {
        let missing = || MeshProblem::Expected { expected: "appended data in the file".to_owned() };
        let Appended { data, base64 } = self.appended.ok_or_else(missing)?;
        let offset =
            integer(array.attribute("offset").unwrap_or_default(), "an offset in the appended data")?;
        let offset = usize::try_from(offset).unwrap_or(usize::MAX);
        let data = data.get(offset..).ok_or_else(cut)?;
        if !base64 {
            return Ok(Source::Raw(data));
        }
        let end = data.iter().position(|&b| b == b'<').unwrap_or(data.len());
        Ok(Source::base64(data.get(..end).unwrap_or_default()))
    }

    /// Bytes that are not compressed: their number, then themselves.
    fn plain(&self, mut source: Source, size: usize) -> Result<Vec<u8>, MeshProblem> {
        let stated = self.header(&mut source)?;
        if stated != size as u64 {
            return Err(wrong(size, &stated.to_string()));
        }
        source.take(size).ok_or_else(cut)
    }

    /// Bytes in compressed blocks: number of blocks, their size and that of the last, compressed size of each, then the blocks.
    fn inflated(&self, mut source: Source, size: usize) -> Result<Vec<u8>, MeshProblem> {
        let [blocks, _, _] =
            [self.header(&mut source)?, self.header(&mut source)?, self.header(&mut source)?];
        let table = usize::try_from(blocks).ok().and_then(|blocks| blocks.checked_mul(self.header));
        let table = source.take(table.ok_or_else(cut)?).ok_or_else(cut)?;
        let mut bytes = Vec::new();
        for stated in table.chunks_exact(self.header) {
            let stated = usize::try_from(little(stated)).unwrap_or(usize::MAX);
            let block = source.take(stated).ok_or_else(cut)?;
            // One byte more than fits shows a block that holds too much.
            let room = (size - bytes.len()) as u64 + 1;
            let inflated = ZlibDecoder::new(block.as_slice()).take(room).read_to_end(&mut bytes);
            inflated.map_err(|_| MeshProblem::Expected { expected: "data compressed by zlib".to_owned() })?;
            if bytes.len() > size {
                return Err(wrong(size, "more"));
            }
        }
        if bytes.len() == size { Ok(bytes) } else { Err(wrong(size, &bytes.len().to_string())) }
    }

    /// Next number of a header.
    fn header(&self, source: &mut Source) -> Result<u64, MeshProblem> {
        source.take(self.header).map(|bytes| little(&bytes)).ok_or_else(cut)
    }
}

/// Refusal of data that end too early.
fn cut() -> MeshProblem {
    MeshProblem::CutShort { expected: "the end of the array's data".to_owned() }
}

/// Refusal of data of another size than points and cells make them.
fn wrong(size: usize, found: &str) -> MeshProblem {
    MeshProblem::Expected {
        expected: format!("{size} bytes of data, as the file has points and cells, and not {found}"),
    }
}
