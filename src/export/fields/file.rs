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
