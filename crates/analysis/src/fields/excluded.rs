//! Nodes without valid stress: about contact nodes, where forces act on points and stress grows with refinement of the mesh.

use rubmap_solid::frame::distance;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// Nodes of a sector that are too near to a contact node for valid stress.
#[derive(Debug)]
pub struct Excluded {
    radius: f64,
    /// Whether each node is too near.
    near: Vec<bool>,
}

impl Excluded {
    /// Nodes within `radius` of a contact node, including those of the two neighbouring blades, `angle` apart; by default the radius is the
    /// mean distance of contact nodes.
    pub(super) fn new(nodes: &[SectorNode], angle: f64, radius: Option<f64>) -> Self {
        let place = |[r, theta, z]: [f64; 3], turn: f64| {
            let (sin, cos) = (theta + turn).sin_cos();
            [r * cos, r * sin, z]
        };
        let mut line: Vec<_> =
            nodes.iter().filter_map(|node| Some((node.contact?, node.coordinates))).collect();
        line.sort_unstable_by_key(|&(place, _)| place);
        let radius = radius.unwrap_or_else(|| {
            let spacings = line.windows(2).map(|pair| distance(place(pair[0].1, 0.0), place(pair[1].1, 0.0)));
            spacings.sum::<f64>() / line.len().saturating_sub(1).max(1) as f64
        });
        let turns = [0.0, angle, -angle];
        let contact: Vec<[f64; 3]> =
            line.iter().flat_map(|&(_, at)| turns.map(|turn| place(at, turn))).collect();
        let near = |node: &SectorNode| {
            let at = place(node.coordinates, 0.0);
            contact.iter().any(|&contact| distance(at, contact) <= radius)
        };
        Self { radius, near: nodes.iter().map(near).collect() }
    }

    /// Radius about contact nodes, in the model's unit of length.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether the stress at a node is not valid.
    pub fn contains(&self, place: u32) -> bool {
        self.near[place as usize]
    }
}
