//! Decks of CalculiX and Abaqus (`.inp`).
//!
//! Cards and names are read as both programs do: capitals and blanks do not matter, a card that ends in a comma goes on on the next line,
//! `*INCLUDE` may be nested. Parts and instances are put together, with the instances' displacement and turn.

mod assembly;
pub mod card;
mod instance;
mod kinds;
mod node_set;
mod reader;
mod request;
mod scope;
mod skipped;
mod support;
#[cfg(test)]
mod tests;
mod work;

use crate::error::MeshFileError;
use crate::include::Include;
use crate::mesh_file::MeshFile;

/// Reads a deck and the files it includes.
pub(crate) fn read(bytes: &[u8], include: &Include<'_>) -> Result<MeshFile, MeshFileError> {
    let mut reader = reader::Reader::new(include);
    reader.file(bytes, 0)?;
    reader.finish()
}
