//! Directions by name.

use crate::request::Component;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::sector::ContactNode;

/// The direction of a component at a contact node.
pub(super) fn direction(contact_nodes: &[ContactNode], node: u32, component: Component) -> Direction {
    let node = node as usize;
    let components = match component {
        Component::Radial => [1.0, 0.0, 0.0],
        Component::Tangential => [0.0, 1.0, 0.0],
        Component::Axial => [0.0, 0.0, 1.0],
        Component::Normal => contact_nodes[node].normal,
    };
    Direction { node, components }
}
