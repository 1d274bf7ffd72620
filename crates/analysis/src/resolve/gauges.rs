//! Strain gauges between nodes of the model: choice of the nodes, and distance from the position asked for.

use crate::component::along;
use crate::request::Gauge;
use crate::resolve::findings::Findings;
use crate::result::{GaugeEnd, PlacedSensor};
use rubmap_wheel::dynamics::nodes::SectorNode;

/// Largest angle from the direction asked for. A fibre at this angle to a uniaxial strain shows cos² − ν sin² of it, 85 %; at 45° a third.
const LARGEST_ANGLE_DEG: f64 = 20.0;
/// Largest relative difference of the length. A gauge averages over its length; stress at a fillet halves over some lengths of a gauge.
const LENGTH_OFF: f64 = 0.25;
/// Largest distance of the middle from the position asked for, in lengths asked for: the gauge still covers it.
const MIDDLE_OFF: f64 = 0.5;

/// Gauge at a position, as it was asked for.
#[derive(Clone, Copy)]
struct Asked {
    at: [f64; 3],
    /// Unit vector along the gauge.
    along: [f64; 3],
    length: f64,
}

/// Gives a gauge its nodes, if it names a position. Gauges with too few or too many fields are refused elsewhere.
pub(super) fn place_gauge(
    found: &mut Findings,
    index: usize,
    gauge: &mut Gauge,
    nodes: &[SectorNode],
) -> Option<PlacedSensor> {
    let pointer = |field: &str| format!("/sensors/{index}/gauge/{field}");
    let (ends, asked) = match *gauge {
        Gauge { nodes: Some(ids), at: None, direction: None, length: None } => {
            let find = |found: &mut Findings, place: usize| {
                let node = nodes.iter().find(|node| node.id == ids[place]);
                found.require(
                    node.is_some(),
                    &pointer(&format!("nodes/{place}")),
                    "the model has no such node",
                );
                node
            };
            let (a, b) = (find(found, 0), find(found, 1));
            ([a?, b?], None)
        }
        Gauge { nodes: None, at: Some(at), direction: Some(direction), length: Some(length) } => {
            let sound = length.is_finite() && length > 0.0;
            found.require(sound, &pointer("length"), "a gauge has a finite length above 0");
            let points = direction != [0.0; 3];
            found.require(
                points,
                &pointer("direction"),
                "this points nowhere: give a direction other than 0, 0, 0",
            );
            if !(sound && points) {
                return None;
            }
            let asked = Asked { at, along: along(direction), length };
            ([nearest(nodes, asked.end(-1.0))?, nearest(nodes, asked.end(1.0))?], Some(asked))
        }
        Gauge { nodes: None, at, direction, .. } => {
            let field = if at.is_none() {
                "at"
            } else if direction.is_none() {
                "direction"
            } else {
                "length"
            };
            found.require(
                false,
                &pointer(field),
                "a gauge has either `nodes`, or `at`, `direction` and `length`: this one is lacking",
            );
            return None;
        }
        _ => return None,
    };
    let [a, b] = ends;
    if let Some((field, message)) = asked.and_then(|asked| asked.missed(ends)) {
        found.require(false, &pointer(field), message);
        return None;
    }
    let length = a.distance(b.position);
    let moves = a.is_free() || b.is_free();
    found.require(moves, &pointer("nodes"), "both nodes are clamped and never move: name others");
    found.require(length > 0.0, &pointer("nodes"), one_node(a));
    *gauge = Gauge { nodes: Some([a.id, b.id]), ..Gauge::default() };
    Some(PlacedSensor {
        sensor: index as u32,
        node: a.id,
        position: a.position,
        contact_node: a.contact,
        distance: asked.map(|asked| a.distance(asked.end(-1.0)).max(b.distance(asked.end(1.0)))),
        end: Some(GaugeEnd { node: b.id, position: b.position, length }),
        angle_deg: asked.map(|asked| asked.angle_deg(ends)),
        asked_length: asked.map(|asked| asked.length),
    })
}

fn nearest(nodes: &[SectorNode], point: [f64; 3]) -> Option<&SectorNode> {
    nodes.iter().min_by(|a, b| a.distance(point).total_cmp(&b.distance(point)))
}

fn one_node(node: &SectorNode) -> String {
    format!("both ends are at node {}: a gauge lies between two nodes in different places", node.id)
}

impl Asked {
    /// End of the gauge on the side of `sign`.
    fn end(&self, sign: f64) -> [f64; 3] {
        std::array::from_fn(|d| self.at[d] + sign * 0.5 * self.length * self.along[d])
    }

    fn angle_deg(&self, [a, b]: [&SectorNode; 2]) -> f64 {
        let apart: [f64; 3] = std::array::from_fn(|d| b.position[d] - a.position[d]);
        let forward: f64 = (0..3).map(|d| apart[d] * self.along[d]).sum();
        let aside: [f64; 3] = std::array::from_fn(|d| apart[d] - forward * self.along[d]);
        aside[0].hypot(aside[1]).hypot(aside[2]).atan2(forward).to_degrees()
    }

    /// Field and message, if a gauge between the nodes nearest to the ends is not the one that was asked for.
    fn missed(&self, ends: [&SectorNode; 2]) -> Option<(&'static str, String)> {
        let [a, b] = ends;
        let (found, asked) = (a.distance(b.position), self.length);
        let middle: [f64; 3] = std::array::from_fn(|d| 0.5 * (a.position[d] + b.position[d]));
        let off = (0..3).map(|d| middle[d] - self.at[d]).fold(0.0, f64::hypot);
        let nearest = format!("the nodes nearest to its ends are {} and {}", a.id, b.id);
        let far = a.distance(self.at).min(b.distance(self.at));
        // Farther than a gauge could reach: its ends find the same side of the wheel, and say nothing of length and direction.
        if far > asked.max(found) {
            return Some((
                "at",
                format!("too far from the wheel: {nearest}, and the nearer is {far:.4} away"),
            ));
        }
        if found == 0.0 {
            return Some(("length", one_node(a)));
        }
        let advice = "ask for what the mesh has, or give `nodes`";
        let angle = self.angle_deg(ends);
        if angle > LARGEST_ANGLE_DEG {
            let words = format!("{angle:.1}° off this direction (at most {LARGEST_ANGLE_DEG}°)");
            return Some((
                "direction",
                format!("{nearest}, and the fibre between them is {words}: {advice}"),
            ));
        }
        if (found / asked - 1.0).abs() > LENGTH_OFF {
            let words = format!("{found:.4} apart, more than a quarter from this length");
            return Some(("length", format!("{nearest}, which are {words}: {advice}")));
        }
        if off > MIDDLE_OFF * asked {
            let words = format!("{off:.4} from this place, more than half the length");
            return Some(("at", format!("{nearest}, and the middle between them is {words}: {advice}")));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes 10 to 12 along x at 0, 2, 4; node 13 at the height 2 over the first.
    fn nodes() -> Vec<SectorNode> {
        use rubmap_wheel::dynamics::nodes::NodeDof;
        let dofs = std::array::from_fn(|dof| {
            let mut components = [0.0; 3];
            components[dof] = 1.0;
            Some(NodeDof { dof, components })
        });
        let places = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let node = |(id, position)| SectorNode {
            id,
            position,
            coordinates: position,
            dofs,
            on_high_face: false,
            contact: None,
        };
        (10..).zip(places).map(node).collect()
    }

    fn place(at: [f64; 3], direction: [f64; 3], length: f64) -> Result<PlacedSensor, Vec<String>> {
        let mut found = Findings::default();
        let mut gauge = Gauge { at: Some(at), direction: Some(direction), length: Some(length), nodes: None };
        let placed = place_gauge(&mut found, 0, &mut gauge, &nodes());
        let found = found.finish(placed).map_err(|found| {
            found.into_iter().map(|found| format!("{}: {}", found.pointer, found.message)).collect::<Vec<_>>()
        })?;
        Ok(found.unwrap())
    }

    #[test]
    fn a_gauge_says_how_far_it_is_from_what_was_asked() {
        // 19° aside, and nearly a quarter longer.
        let (sin, cos) = 19f64.to_radians().sin_cos();
        let placed = place([1.0, 0.0, 0.0], [3.0 * cos, 3.0 * sin, 0.0], 1.61).unwrap();
        assert_eq!((placed.node, placed.end.unwrap().node, placed.end.unwrap().length), (10, 11, 2.0));
        assert!((placed.angle_deg.unwrap() - 19.0).abs() < 1e-9, "{placed:?}");
        assert_eq!(placed.asked_length, Some(1.61));
        let ideal = place([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 2.0).unwrap();
        assert_eq!((ideal.node, ideal.angle_deg, ideal.distance), (11, Some(0.0), Some(0.0)));
    }

    #[test]
    fn another_gauge_is_refused() {
        let (sin, cos) = 21f64.to_radians().sin_cos();
        for (at, direction, length, words) in [
            (
                [1.0, 0.0, 0.0],
                [cos, sin, 0.0],
                2.0,
                "direction: the nodes nearest to its ends are 10 and 11, and the fibre between them is 21.0° off this direction (at most 20°): ask for what the mesh has, or give `nodes`",
            ),
            (
                [1.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                1.55,
                "length: the nodes nearest to its ends are 10 and 11, which are 2.0000 apart, more than a quarter from this length: ask for what the mesh has, or give `nodes`",
            ),
            (
                [1.0, 0.0, 1.2],
                [1.0, 0.0, 0.0],
                2.0,
                "at: the nodes nearest to its ends are 10 and 11, and the middle between them is 1.2000 from this place, more than half the length: ask for what the mesh has, or give `nodes`",
            ),
            (
                [1.0, 0.0, 500.0],
                [1.0, 0.0, 0.0],
                2.0,
                "at: too far from the wheel: the nodes nearest to its ends are 10 and 11, and the nearer is 500.0010 away",
            ),
            (
                [0.0, 0.1, 0.0],
                [1.0, 0.0, 0.0],
                0.2,
                "length: both ends are at node 10: a gauge lies between two nodes in different places",
            ),
        ] {
            assert_eq!(place(at, direction, length).unwrap_err(), [format!("/sensors/0/gauge/{words}")]);
        }
    }
}
