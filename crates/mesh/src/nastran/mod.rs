//! Bulk data of Nastran, alone or behind executive and case control.
//!
//! ```text
//! bytes, INCLUDE ─ lines ─┬─ control (SET, SPC) ── BEGIN BULK
//!                         └─ cards (short, long, free field) ── deck ──▶ MeshFile
//! ```
//!
//! Elements of one property are an element set by the number of the property. Loads and parameters are skipped; what changes the model and
//! cannot be carried over, such as rigid elements and springs, is refused.

mod card;
mod cards;
mod components;
mod control;
mod deck;
mod frames;
mod grids;
mod lines;
mod materials;
mod others;
mod place;
mod sets;
mod solids;
mod supports;
mod systems;
#[cfg(test)]
mod tests;

use crate::error::{MeshFileError, MeshProblem};
use crate::include::Include;
use crate::mesh_file::MeshFile;

use cards::Cards;
use control::Control;
use deck::Deck;
use lines::Lines;

/// Reads a mesh; `include` gives the files that it includes.
///
/// # Errors
/// Place and reason if the file is damaged or has what a model cannot carry over.
pub(crate) fn read(bytes: &[u8], include: &Include<'_>) -> Result<MeshFile, MeshFileError> {
    let mut lines = Lines::new(bytes, include);
    let control = if control::is_there(bytes) { Some(Control::read(&mut lines)?) } else { None };
    let complete = control.is_some();
    let mut cards = Cards::new(lines);
    let mut deck = Deck::new(control);
    while let Some(card) = cards.next()? {
        deck.add(&card)?;
    }
    // Bulk data alone, as meshers write them for INCLUDE, often go without.
    if complete && !cards.has_ended() {
        return Err(cards.error(MeshProblem::CutShort { expected: "ENDDATA".to_owned() }));
    }
    deck.into_mesh()
}
