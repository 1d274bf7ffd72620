//! Direction of displacement at a contact node.

use faer::{MatRef, c64};

/// Number of components of a node: r, θ, z.
pub const COMPONENTS: usize = 3;

/// Displacement direction at a contact node in (r, θ, z) components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Contact node, from the leading edge.
    pub node: usize,
    /// Components of the direction.
    pub components: [f64; 3],
}

impl Direction {
    /// Component dᵀφ of mode `mode` along the direction, φ given at the contact DOF (`n_b × modes`).
    pub fn of(&self, contact: MatRef<'_, c64>, mode: usize) -> c64 {
        (0..3).map(|c| contact[(3 * self.node + c, mode)] * self.components[c]).sum()
    }
}
