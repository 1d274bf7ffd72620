//! Components of displacement that a support holds.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields::quoted;

use super::card::Card;

/// Mask of all three displacements.
pub(super) const ALL: u8 = 0b111;

/// Mask of the displacements in a field such as `123`. Rotations, 4 to 6, are none that solid elements have.
pub(super) fn mask(card: &Card, field: usize) -> Result<u8, MeshFileError> {
    let text = card.text(field);
    let mut mask = 0;
    for digit in text.chars() {
        match digit {
            '1' => mask |= 0b001,
            '2' => mask |= 0b010,
            '3' => mask |= 0b100,
            '0' | '4' | '5' | '6' => {}
            _ => {
                let expected = "components of displacement, such as 123";
                return Err(card.error(MeshProblem::NotA { text: quoted(text), expected }));
            }
        }
    }
    Ok(mask)
}
