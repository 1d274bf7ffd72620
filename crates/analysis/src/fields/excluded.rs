//! Where no stress is claimed: about contact nodes, where forces act on points and stress grows with the mesh.

use rubmap_solid::frame::distance;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// The nodes of a sector that are too near to a contact node.
#[derive(Debug)]
pub struct Excluded {
    radius: f64,
    /// Per node.
    near: Vec<bool>,
}

impl Excluded {
    /// Within `radius` of a contact node, of the blades beside its own, `angle` apart, too; without one within the mean distance of contact
    /// nodes.
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

    /// The radius, in the model's unit of length.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether no stress is claimed at a node.
    pub fn contains(&self, place: u32) -> bool {
        self.near[place as usize]
    }
}
