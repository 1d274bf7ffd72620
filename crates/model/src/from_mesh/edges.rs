//! Sharp edges of the skin, as a graph of nodes.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use rubmap_solid::frame::distance;
use rubmap_solid::mesh::SectorMesh;

use super::error::FromMeshError;
use super::midline::Line;
use super::surface::{Face, SMOOTH, sides};

/// Shortest way along sharp edges of the skin from one node to another, with the nodes in the middle of edges.
pub(super) fn between(mesh: &SectorMesh, surface: &[Face], ends: [u64; 2]) -> Result<Line, FromMeshError> {
    let graph = sharp(surface);
    let place = |id: u64| {
        let node = mesh.node_ids.binary_search(&id).ok().map(|node| node as u32);
        node.filter(|node| graph.contains_key(node)).ok_or(FromMeshError::NotOnEdge { node: id })
    };
    let [from, to] = [place(ends[0])?, place(ends[1])?];
    let length = |a: u32, b: u32| distance(mesh.nodes[a as usize], mesh.nodes[b as usize]);
    // Bits of lengths that are not negative are in their order.
    let mut open = BinaryHeap::from([Reverse((0_u64, from))]);
    let mut reached: BTreeMap<u32, (f64, u32)> = BTreeMap::from([(from, (0.0, from))]);
    while let Some(Reverse((bits, node))) = open.pop() {
        let so_far = f64::from_bits(bits);
        if node == to {
            break;
        }
        if reached.get(&node).is_some_and(|&(best, _)| best < so_far) {
            continue;
        }
        for &next in graph.get(&node).into_iter().flatten() {
            let way = so_far + length(node, next);
            if reached.get(&next).is_none_or(|&(best, _)| way < best) {
                reached.insert(next, (way, node));
                open.push(Reverse((way.to_bits(), next)));
            }
        }
    }
    let mut line = Vec::new();
    let mut at = to;
    while let Some(&(_, before)) = reached.get(&at) {
        line.push((mesh.node_ids[at as usize], mesh.nodes[at as usize]));
        if at == from {
            line.reverse();
            return Ok(line);
        }
        at = before;
    }
    Err(FromMeshError::NoWay { ends })
}

/// Neighbours of every node on a sharp edge, those in the middle of edges included.
fn sharp(surface: &[Face]) -> BTreeMap<u32, Vec<u32>> {
    let mut graph: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for ([a, b], faces) in sides(surface, 0..surface.len()) {
        let [one, other] = faces[..] else { continue };
        if surface[one].normal.dot(&surface[other].normal) > SMOOTH {
            continue;
        }
        // The middle of an edge stands behind its first corner.
        let face = &surface[one];
        let corner = face.edges().position(|edge| edge == [a, b] || edge == [b, a]);
        let middle = corner.and_then(|k| face.skin.nodes.get(face.skin.corners + k)).copied();
        let steps = match middle {
            Some(middle) => vec![[a, middle], [middle, b]],
            None => vec![[a, b]],
        };
        for [from, to] in steps {
            graph.entry(from).or_default().push(to);
            graph.entry(to).or_default().push(from);
        }
    }
    graph.values_mut().for_each(|next| next.sort_unstable());
    graph
}
