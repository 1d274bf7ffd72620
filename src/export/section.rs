//! Section of a sector: positions of its nodes and heights of the casing.

use super::Export;
use super::array::Array;
use crate::analysis::result::{ContactPlace, SectorGeometry, SectorNode};

impl Export for SectorGeometry {
    /// A line per node.
    fn table(&self) -> Vec<Array> {
        let length = &self.units.length;
        let along = |name: String, of: fn(&SectorNode) -> f64| Array::reals(name, self.nodes.iter().map(of));
        vec![
            Array::texts("id", self.nodes.iter().map(|node| node.id.to_string())),
            Array::words("kind", self.nodes.iter().map(|node| node.kind)),
            along(format!("r_{length}"), |node| node.position[0]),
            along("theta_rad".to_owned(), |node| node.position[1]),
            along(format!("z_{length}"), |node| node.position[2]),
        ]
    }

    /// Arrays: positions are `[node][r, θ, z]`, heights of the casing `[contact node][angle]`.
    fn arrays(&self) -> Vec<Array> {
        let contact = &self.contact;
        let clearances = contact.iter().map(|ContactPlace { clearance, .. }| *clearance);
        vec![
            Array::texts("ids", self.nodes.iter().map(|node| node.id.to_string())),
            Array::words("kinds", self.nodes.iter().map(|node| node.kind)),
            Array::rows("positions", self.nodes.iter().map(|node| &node.position[..])),
            Array::rows("contact_positions", contact.iter().map(|place| &place.position[..])),
            Array::rows("contact_normals", contact.iter().map(|place| &place.normal[..])),
            Array::some_reals("contact_clearances", clearances),
            Array::rows("contact_heights", contact.iter().map(|place| &place.heights[..])),
            Array::text("name", &self.name),
            Array::json("units", &self.units),
        ]
    }
}
