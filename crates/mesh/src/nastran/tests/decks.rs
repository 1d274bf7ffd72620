//! Small decks in each format of cards.

use super::super::read;
use crate::error::MeshFileError;
use crate::mesh_file::MeshFile;

/// Format of a card.
#[derive(Debug, Clone, Copy)]
pub(super) enum Format {
    Short,
    /// Short, with marks of continuation.
    Marked,
    Long,
    Free,
}

impl Format {
    pub(super) const ALL: [Self; 4] = [Self::Short, Self::Marked, Self::Long, Self::Free];

    /// Card with its continuations.
    pub(super) fn card(self, name: &str, fields: &[String]) -> String {
        let count = if let Self::Long = self { 4 } else { 8 };
        let mut text = String::new();
        for (k, line) in fields.chunks(count).enumerate() {
            let first = if k == 0 { name } else { "" };
            let last = k == fields.len().div_ceil(count) - 1;
            text += &match self {
                Self::Short => {
                    format!("{first:8}{}\n", line.iter().map(|f| format!("{f:>8}")).collect::<String>())
                }
                Self::Marked => {
                    let first = if k == 0 { name.to_owned() } else { format!("+M{k}") };
                    let mark = if last { String::new() } else { format!("+M{}", k + 1) };
                    let line: String = line.iter().map(|f| format!("{f:<8}")).collect();
                    format!("{first:8}{line:64}{mark}\n")
                }
                Self::Long => {
                    let first = format!("{first}*");
                    format!("{first:8}{}\n", line.iter().map(|f| format!("{f:>16}")).collect::<String>())
                }
                Self::Free => format!("{first},{}\n", line.join(",")),
            };
        }
        text
    }
}

/// Nodes 1 to 8 of a cube.
pub(super) const CUBE: &str = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n\
                               GRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\n";

/// Tetrahedron among the nodes of the cube.
pub(super) const TETRAHEDRON: &str = "CTETRA,1,1,1,2,4,5\n";

/// Reads a deck that includes nothing.
pub(super) fn deck(text: &str) -> Result<MeshFile, MeshFileError> {
    read(text.as_bytes(), &|name| Err(format!("there is no {name}")))
}

/// Reads the tetrahedron with more cards behind it, from line 10.
pub(super) fn with(cards: &str) -> Result<MeshFile, MeshFileError> {
    deck(&format!("{CUBE}{TETRAHEDRON}{cards}"))
}

/// Refusal of the tetrahedron with more cards behind it.
pub(super) fn refusal(cards: &str) -> String {
    with(cards).unwrap_err().to_string()
}
