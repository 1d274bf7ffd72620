//! Nodes of a sector: their positions, and the DOF that make up their displacement.

/// Node of the sector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectorNode {
    /// Id of the node in the user's model.
    pub id: u64,
    /// Position in the user's Cartesian coordinates.
    pub position: [f64; 3],
    /// Position about the axis of rotation: r, θ, z.
    pub coordinates: [f64; 3],
    /// Degrees of freedom of the node; none for a component that is clamped.
    pub dofs: [Option<NodeDof>; 3],
    /// Whether the node lies on the high face: its displacement in sector s is that of a low node, whose DOF these are, in sector s + 1, in
    /// the same (r, θ, z) components.
    pub on_high_face: bool,
    /// Index of the node among the contact nodes, if it is one.
    pub contact: Option<u32>,
}

/// Degree of freedom of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeDof {
    /// Row of the DOF among the own DOF.
    pub dof: usize,
    /// Displacement of the node when the DOF is 1: (r, θ, z) components at the node.
    pub components: [f64; 3],
}

impl SectorNode {
    /// Whether the node can move at all.
    pub fn is_free(&self) -> bool {
        self.dofs.iter().any(Option::is_some)
    }

    /// Whether the node can move along `direction`, given in (r, θ, z) components.
    pub fn moves_along(&self, direction: [f64; 3]) -> bool {
        let along =
            |dof: &NodeDof| dof.components.iter().zip(direction).map(|(c, d)| c * d).sum::<f64>() != 0.0;
        self.dofs.iter().flatten().any(along)
    }

    /// Distance of the node from a point.
    pub fn distance(&self, point: [f64; 3]) -> f64 {
        let [x, y, z] = self.position;
        (x - point[0]).hypot(y - point[1]).hypot(z - point[2])
    }
}
