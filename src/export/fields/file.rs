//! What is written.

use crate::analysis::fields::{Field, FieldSector, Part};

/// A field that is written.
#[derive(Debug)]
pub struct FieldFile {
    /// Where.
    pub sector: FieldSector,
    /// What.
    pub field: Field,
    /// How much of it.
    pub part: Part,
}

impl FieldFile {
    /// With words on where stress is claimed, in this unit of length.
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
