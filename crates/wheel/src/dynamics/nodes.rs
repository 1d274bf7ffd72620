//! Nodes of a sector: where they are, and which DOF their displacement is made of.

/// A node of the sector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectorNode {
    /// Its id in the user's model.
    pub id: u64,
    /// Position in the user's Cartesian coordinates.
    pub position: [f64; 3],
    /// The same about the axis of rotation: r, θ, z.
    pub coordinates: [f64; 3],
    /// What it can do; none of a component that is clamped.
    pub dofs: [Option<NodeDof>; 3],
    /// Whether it lies on the high face: its displacement in sector s is that of a low node, whose DOF these are, in sector
    /// s + 1, in the same (r, θ, z) components.
    pub on_high_face: bool,
    /// Its place among the contact nodes, if it is one.
    pub contact: Option<u32>,
}

/// A DOF of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeDof {
    /// Row among the own DOF.
    pub dof: usize,
    /// What moves when it is 1: (r, θ, z) components at the node.
    pub components: [f64; 3],
}

impl SectorNode {
    /// Whether it can move at all.
    pub fn is_free(&self) -> bool {
        self.dofs.iter().any(Option::is_some)
    }

    /// Whether it can move along `direction`, given in (r, θ, z) components.
    pub fn moves_along(&self, direction: [f64; 3]) -> bool {
        let along =
            |dof: &NodeDof| dof.components.iter().zip(direction).map(|(c, d)| c * d).sum::<f64>() != 0.0;
        self.dofs.iter().flatten().any(along)
    }

    /// Distance from a point.
    pub fn distance(&self, point: [f64; 3]) -> f64 {
        let [x, y, z] = self.position;
        (x - point[0]).hypot(y - point[1]).hypot(z - point[2])
    }
}
