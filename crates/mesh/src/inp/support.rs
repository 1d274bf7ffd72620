//! Supports of a deck.

/// Support of a deck: a node or set, and the components that are held.
#[derive(Debug)]
pub(super) struct Support {
    pub(super) target: String,
    pub(super) components: [bool; 3],
    pub(super) line: u64,
}
