//! Directions of components by name, and unit vectors.

use crate::request::Component;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::sector::ContactNode;

/// The direction of a component at a node; only contact nodes have a normal.
pub(super) fn direction(contact_nodes: &[ContactNode], node: usize, component: Component) -> Direction {
    let components = match component {
        Component::Radial => [1.0, 0.0, 0.0],
        Component::Tangential => [0.0, 1.0, 0.0],
        Component::Axial => [0.0, 0.0, 1.0],
        Component::Normal => contact_nodes[node].normal,
    };
    Direction { node, components }
}

/// The unit vector along `direction`, which is not 0.
pub(super) fn along(direction: [f64; 3]) -> [f64; 3] {
    // Scaled first, so that no direction over- or underflows.
    let largest = direction.iter().fold(0.0f64, |most, d| most.max(d.abs()));
    let scaled = direction.map(|d| d / largest);
    let length = scaled[0].hypot(scaled[1]).hypot(scaled[2]);
    scaled.map(|d| d / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_of_any_length_is_the_same() {
        for scale in [1e-310, 1.0, 1e300] {
            let unit = along([3.0, 0.0, -4.0].map(|d| d * scale));
            assert!(
                (unit[0] - 0.6).abs() < 1e-14 && unit[1] == 0.0 && (unit[2] + 0.8).abs() < 1e-14,
                "{unit:?}"
            );
        }
    }
}
