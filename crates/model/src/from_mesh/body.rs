//! Elements of a mesh file as a body: nodes in order of their numbers, checked elements, one connected piece.

use std::collections::HashMap;

use rubmap_mesh::MeshFile;
use rubmap_solid::defect::{Defect, Likely, defect};
use rubmap_solid::frame::distance;
use rubmap_solid::mesh::{Element, ElementSet, SectorMesh};
use rubmap_solid::place::tolerance;

use super::error::{FromMeshError, Twin};
use crate::package::by_place::NodeGrid;

/// Distance within which two nodes are one, in parts of the distance within which a turned node meets its partner.
const SAME: f64 = 1e-2;

/// Makes the mesh of all elements, without axis, pairs and sectors; nodes without an element are left out.
pub(super) fn body(file: &MeshFile, sets: Vec<ElementSet>, set_of: &HashMap<u64, u32>) -> SectorMesh {
    let mut used: Vec<u64> = file.elements.values().flat_map(|element| &element.nodes).copied().collect();
    used.sort_unstable();
    used.dedup();
    let index: HashMap<u64, u32> = used.iter().copied().zip(0..).collect();
    let nodes: Vec<[f64; 3]> = used.iter().filter_map(|id| file.nodes.get(id).copied()).collect();
    let elements = file.elements.iter().map(|(&id, element)| Element {
        id,
        kind: element.kind,
        set: set_of.get(&id).copied().unwrap_or(0),
        nodes: element.nodes.iter().filter_map(|node| index.get(node).copied()).collect(),
    });
    SectorMesh {
        sectors: 1,
        node_ids: used,
        nodes,
        axis: ([0.0; 3], [0.0, 0.0, 1.0]),
        cyclic: Vec::new(),
        elements: elements.collect(),
        sets,
    }
}

/// Refuses elements that are not whole or repeated, two nodes at one place, and several bodies.
pub(super) fn check(file: &MeshFile, mesh: &SectorMesh) -> Result<(), FromMeshError> {
    check_elements(file, mesh)?;
    check_repeated(file, mesh)?;
    check_twins(mesh)?;
    check_connected(mesh)
}

fn check_elements(file: &MeshFile, mesh: &SectorMesh) -> Result<(), FromMeshError> {
    for element in &mesh.elements {
        let Some(found) = defect(element.kind, &mesh.positions(element)) else { continue };
        let line = file.elements.get(&element.id).map_or(0, |element| element.line);
        let id = |local: usize| mesh.node_ids[element.nodes[local] as usize];
        let problem = match found {
            Defect::Middle { node, edge: [a, b] } => {
                format!(
                    "its node {} is not in the middle of the edge from {} to {}; are its nodes in another order?",
                    id(node),
                    id(a),
                    id(b)
                )
            }
            Defect::Jacobian { likely: Likely::Mirrored, .. } => {
                "it is turned inside out: its nodes run the wrong way round".to_owned()
            }
            Defect::Jacobian { likely: Likely::MiddleNodes, .. } => {
                "its nodes on the edges turn it inside out; with straight edges it would be whole".to_owned()
            }
            Defect::Jacobian { determinant, .. } => {
                format!("it is collapsed or turned inside out (Jacobian determinant {determinant:.3e})")
            }
        };
        return Err(FromMeshError::Element { element: element.id, kind: element.kind.name(), line, problem });
    }
    Ok(())
}

/// Refuses two elements of the same nodes, which would count twice.
fn check_repeated(file: &MeshFile, mesh: &SectorMesh) -> Result<(), FromMeshError> {
    let mut known: HashMap<Vec<u32>, u64> = HashMap::with_capacity(mesh.elements.len());
    for element in &mesh.elements {
        let mut nodes = element.nodes.clone();
        nodes.sort_unstable();
        if let Some(other) = known.insert(nodes, element.id) {
            let line = file.elements.get(&element.id).map_or(0, |element| element.line);
            let problem = format!("it has the nodes of element {other}; leave one of them out");
            let kind = element.kind.name();
            return Err(FromMeshError::Element { element: element.id, kind, line, problem });
        }
    }
    Ok(())
}

/// Refuses two nodes at one place: the mesh is slit there.
fn check_twins(mesh: &SectorMesh) -> Result<(), FromMeshError> {
    let within = SAME * tolerance(mesh.nodes.iter().copied());
    // A cell is so wide that most nodes have all that are near in one.
    let cell = |at: [f64; 3], off: f64| at.map(|x| ((x + off) / (16.0 * within)).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut twins = Vec::new();
    for (node, &at) in mesh.nodes.iter().enumerate() {
        let (from, to) = (cell(at, -within), cell(at, within));
        let around = (from[0]..=to[0])
            .flat_map(|i| (from[1]..=to[1]).flat_map(move |j| (from[2]..=to[2]).map(move |k| [i, j, k])));
        let near = |other: &usize| distance(mesh.nodes[*other], at) <= within;
        let other = around.filter_map(|cell| cells.get(&cell)).flatten().copied().find(near);
        match other {
            Some(other) => twins.push((other, node)),
            None => cells.entry(cell(at, 0.0)).or_default().push(node),
        }
    }
    match twins.first() {
        None => Ok(()),
        Some(&(a, b)) => Err(FromMeshError::Twins(Twin {
            nodes: [mesh.node_ids[a], mesh.node_ids[b]],
            at: mesh.nodes[a],
            count: twins.len(),
        })),
    }
}

/// Refuses elements that share no node with the rest.
fn check_connected(mesh: &SectorMesh) -> Result<(), FromMeshError> {
    let mut parent: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    for element in &mesh.elements {
        let first = root(&mut parent, element.nodes[0]);
        for &node in &element.nodes[1..] {
            let other = root(&mut parent, node);
            parent[other as usize] = first;
        }
    }
    let mut sizes: HashMap<u32, (usize, u64, u32)> = HashMap::new();
    for element in &mesh.elements {
        let root = root(&mut parent, element.nodes[0]);
        sizes.entry(root).or_insert((0, element.id, root)).0 += 1;
    }
    if sizes.len() < 2 {
        return Ok(());
    }
    let mut bodies: Vec<(usize, u64, u32)> = sizes.into_values().collect();
    bodies.sort_unstable_by(|a, b| b.cmp(a));
    let mut nodes = |of: u32| -> Vec<usize> {
        (0..mesh.nodes.len()).filter(|&node| root(&mut parent, node as u32) == of).collect()
    };
    let (nearest, distance) = nearest(mesh, &nodes(bodies[1].2), nodes(bodies[0].2));
    Err(FromMeshError::Bodies {
        bodies: bodies.len(),
        sizes: [bodies[0].0, bodies[1].0],
        element: bodies[1].1,
        nearest,
        distance,
    })
}

/// Nearest two nodes of two groups, and their distance.
fn nearest(mesh: &SectorMesh, some: &[usize], mut others: Vec<usize>) -> ([u64; 2], f64) {
    let extent = |k: &usize| {
        let along = mesh.nodes.iter().map(|at| at[*k]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let long = (0..3).max_by(|a, b| extent(a).total_cmp(&extent(b))).unwrap_or(0);
    let along = |node: usize| mesh.nodes[node][long];
    others.sort_by(|&a, &b| along(a).total_cmp(&along(b)));
    let mut best = ([0; 2], f64::INFINITY);
    for &node in some {
        let (before, after) = others.split_at(others.partition_point(|&other| along(other) < along(node)));
        let mut is_near = |other: usize| {
            let near = (along(other) - along(node)).abs() < best.1;
            let away = distance(mesh.nodes[node], mesh.nodes[other]);
            if away < best.1 {
                best = ([mesh.node_ids[node], mesh.node_ids[other]], away);
            }
            near
        };
        before.iter().rev().take_while(|&&other| is_near(other)).for_each(drop);
        after.iter().take_while(|&&other| is_near(other)).for_each(drop);
    }
    best
}

fn root(parent: &mut [u32], node: u32) -> u32 {
    let mut at = node;
    while parent[at as usize] != at {
        let above = parent[parent[at as usize] as usize];
        parent[at as usize] = above;
        at = above;
    }
    at
}

/// Search for the nodes of a mesh by their places.
pub(super) fn grid(mesh: &SectorMesh, nodes: impl Iterator<Item = u32>, tolerance: f64) -> NodeGrid {
    NodeGrid::new(nodes.map(|node| (u64::from(node), mesh.nodes[node as usize])).collect(), tolerance)
}
