//! Field of the wheel to be written to a file.

use crate::analysis::fields::{Field, FieldSector, Part};

/// Field to be written.
#[derive(Debug)]
pub struct FieldFile {
    /// Sector on which the field is: nodes, elements and places.
    pub sector: FieldSector,
    /// Values of the field.
    pub field: Field,
    /// Part of the wheel that is written.
    pub part: Part,
}

impl FieldFile {
    /// Adds a note on where stress is claimed, in this unit of length.
    #[must_use]
    pub fn claiming(mut self, length: &str) -> Self {
        if let Some(excluded) = self.sector.excluded() {
            let radius = format!("{:.3}", excluded.radius());
            self.field
                .subtitles
                .push(format!("no stress is claimed within {radius} {length} of a contact node"));
        }
        self
    }
}
