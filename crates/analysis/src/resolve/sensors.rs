//! Sensors at nodes of the model: choice of the node, and whether it moves.

use crate::error::Violation;
use crate::request::{Component, Sensor};
use crate::resolve::findings::Findings;
use crate::resolve::gauges::place_gauge;
use crate::result::PlacedSensor;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// Whether any of `sensors` can only be resolved with the nodes of the model.
pub fn name_nodes(sensors: &[Sensor]) -> bool {
    sensors.iter().any(|sensor| sensor.node.is_some() || sensor.nearest.is_some() || sensor.gauge.is_some())
}

/// Gives each of `sensors` that names a point its node; returns the positions of those that name a node or a point.
///
/// # Errors
/// Nodes that do not exist or cannot move, each at its JSON pointer.
pub fn place_sensors(
    sensors: &mut [Sensor],
    nodes: &[SectorNode],
) -> Result<Vec<PlacedSensor>, Vec<Violation>> {
    let mut found = Findings::default();
    let mut placed = Vec::new();
    for (index, sensor) in sensors.iter_mut().enumerate() {
        if let Some(gauge) = &mut sensor.gauge {
            placed.extend(place_gauge(&mut found, index, gauge, nodes));
            continue;
        }
        let (node, field) = match *sensor {
            Sensor { node: Some(id), contact_node: None, nearest: None, .. } => {
                (nodes.iter().find(|node| node.id == id), "node")
            }
            Sensor { nearest: Some(point), contact_node: None, node: None, .. } => {
                let free = nodes.iter().filter(|node| node.is_free());
                // The first of equally near nodes.
                (free.min_by(|a, b| a.distance(point).total_cmp(&b.distance(point))), "nearest")
            }
            // Sensors at contact nodes, and sensors that are refused elsewhere.
            _ => continue,
        };
        let Some(node) = node else {
            found.require(false, &format!("/sensors/{index}/{field}"), "the model has no such node");
            continue;
        };
        check(&mut found, &format!("/sensors/{index}"), field, sensor, node);
        let distance = sensor.nearest.take().map(|point| node.distance(point));
        sensor.node = Some(node.id);
        placed.push(PlacedSensor {
            sensor: index as u32,
            node: node.id,
            position: node.position,
            contact_node: node.contact,
            distance,
            end: None,
            angle_deg: None,
            asked_length: None,
        });
    }
    found.finish(placed)
}

fn check(found: &mut Findings, pointer: &str, field: &str, sensor: &Sensor, node: &SectorNode) {
    let id = node.id;
    if !node.is_free() {
        let message = format!("node {id} is clamped and never moves: name another one");
        return found.require(false, &format!("{pointer}/{field}"), message);
    }
    let (direction, along) = match (sensor.component, sensor.direction) {
        (Some(Component::Normal), _) => {
            return found.require(
                node.contact.is_some(),
                &format!("{pointer}/component"),
                format!("only contact nodes have a normal, and node {id} is none: give a `direction`"),
            );
        }
        (Some(Component::Radial), _) => ([1.0, 0.0, 0.0], "component"),
        (Some(Component::Tangential), _) => ([0.0, 1.0, 0.0], "component"),
        (Some(Component::Axial), _) => ([0.0, 0.0, 1.0], "component"),
        (None, Some(direction)) => (direction, "direction"),
        (None, None) => return,
    };
    found.require(
        direction == [0.0; 3] || node.moves_along(direction),
        &format!("{pointer}/{along}"),
        format!("node {id} is clamped in part and never moves this way"),
    );
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use rubmap_wheel::dynamics::nodes::NodeDof;

    /// Nodes 10, 11 … at x = 0, 1 …: the first is clamped, the second moves axially only, the last is a contact node.
    fn nodes() -> Vec<SectorNode> {
        let dof = |component: usize| {
            let mut components = [0.0; 3];
            components[component] = 1.0;
            Some(NodeDof { dof: component, components })
        };
        let node = |place: u64, dofs| SectorNode {
            id: 10 + place,
            position: [place as f64, 0.0, 0.0],
            coordinates: [place as f64, 0.0, 0.0],
            dofs,
            on_high_face: false,
            contact: (place == 3).then_some(7),
        };
        let free = [dof(0), dof(1), dof(2)];
        vec![node(0, [None; 3]), node(1, [None, None, dof(2)]), node(2, free), node(3, free)]
    }

    fn place(sensors: Value) -> Result<(Vec<Sensor>, Vec<PlacedSensor>), Vec<String>> {
        let mut sensors: Vec<Sensor> = serde_json::from_value(sensors).unwrap();
        let placed = place_sensors(&mut sensors, &nodes());
        placed
            .map(|placed| (sensors, placed))
            .map_err(|found| found.into_iter().map(|violation| violation.pointer).collect())
    }

    #[test]
    fn a_point_becomes_the_nearest_node_that_moves() {
        let (sensors, placed) = place(json!([
            {"nearest": [0.25, 0, 0], "component": "axial"},
            {"nearest": [2.25, 0, 0], "sector": 1, "direction": [1, 2, 3]},
            {"contact_node": 99, "component": "radial"},
            {"node": 13, "component": "normal"},
        ]))
        .unwrap();
        assert_eq!(
            sensors.iter().map(|sensor| sensor.node).collect::<Vec<_>>(),
            [Some(11), Some(12), None, Some(13)]
        );
        assert!(sensors.iter().all(|sensor| sensor.nearest.is_none()));
        let distances: Vec<_> = placed.iter().map(|placed| (placed.sensor, placed.distance)).collect();
        assert_eq!(distances, [(0, Some(0.75)), (1, Some(0.25)), (3, None)]);
        assert_eq!(placed[2].contact_node, Some(7));
    }

    #[test]
    fn what_never_moves_is_refused() {
        let refused = place(json!([
            {"node": 9, "component": "radial"},
            {"node": 10, "component": "radial"},
            {"node": 11, "component": "radial"},
            {"node": 11, "direction": [1, 1, 0]},
            {"node": 11, "direction": [1, 1, 0.1]},
            {"node": 12, "component": "normal"},
        ]));
        let expected = ["/0/node", "/1/node", "/2/component", "/3/direction", "/5/component"];
        assert_eq!(refused.unwrap_err(), expected.map(|pointer| format!("/sensors{pointer}")));
    }
}
