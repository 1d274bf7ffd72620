//! Sharp edges of the skin, as a graph of nodes.

use std::collections::BTreeMap;

use rubmap_solid::frame::distance;
use rubmap_solid::mesh::SectorMesh;

use super::error::FromMeshError;
use super::surface::{Face, SMOOTH, sides};
use super::way::{Line, shortest};

/// Shortest way along sharp edges of the skin from one node to another, with the nodes in the middle of edges.
pub(super) fn between(mesh: &SectorMesh, surface: &[Face], ends: [u64; 2]) -> Result<Line, FromMeshError> {
    let graph = sharp(surface);
    let place = |id: u64| {
        let node = mesh.node_ids.binary_search(&id).ok().map(|node| node as u32);
        node.filter(|node| graph.contains_key(node)).ok_or(FromMeshError::NotOnEdge { node: id })
    };
    let [from, to] = [place(ends[0])?, place(ends[1])?];
    let length = |a: u32, b: u32| distance(mesh.nodes[a as usize], mesh.nodes[b as usize]);
    let way = shortest(&graph, from, to, length).ok_or(FromMeshError::NoWay { ends })?;
    Ok(way.into_iter().map(|node| (mesh.node_ids[node as usize], mesh.nodes[node as usize])).collect())
}

/// Neighbours of every node on a sharp edge, those in the middle of edges included.
pub(super) fn sharp(surface: &[Face]) -> BTreeMap<u32, Vec<u32>> {
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
