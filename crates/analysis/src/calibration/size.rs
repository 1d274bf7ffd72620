//! What the price of a step depends on.

/// What the cost of a step depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StepSize {
    pub(crate) sectors: usize,
    /// Contact nodes of a sector; 0 where nothing can touch.
    pub(crate) nodes: usize,
    /// Real unknowns that are integrated.
    pub(crate) unknowns: usize,
}

impl StepSize {
    /// Reading an unknown's own recursion takes about as long as its mode shape at two nodes.
    pub(crate) fn products(self) -> f64 {
        (self.unknowns * (self.nodes + 2)) as f64
    }

    /// Normal displacements of all sectors from their Fourier coordinates.
    pub(crate) fn transforms(self) -> f64 {
        (self.sectors * self.sectors * self.nodes.next_multiple_of(8)) as f64
    }
}
