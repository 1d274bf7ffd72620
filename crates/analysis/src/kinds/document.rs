//! Names of the documents that jobs store.

/// Name of a document that a job stores, and its part where there are several of that name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Document<'a> {
    /// Name of the document.
    pub name: &'a str,
    /// Part: the index of a sensor, a speed or a leg; 0 where there is one.
    pub part: u32,
}

impl<'a> Document<'a> {
    /// Document of which there is one.
    pub const fn only(name: &'a str) -> Self {
        Self { name, part: 0 }
    }

    /// Document of this `part`.
    pub const fn part(name: &'a str, part: u32) -> Self {
        Self { name, part }
    }
}
