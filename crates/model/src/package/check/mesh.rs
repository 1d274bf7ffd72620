//! Checks of the whole mesh: elements at everything that moves, one connected body without overlap, cyclic faces meshed alike.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::{Element, SectorMesh};
use rubmap_solid::place::tolerance;
use rubmap_solid::skin::{Cut, skin};

use super::elements;
use super::layout::NONE;
use super::overlap;
use super::tables::NodeIndex;
use crate::package::by_place::NodeGrid;
use crate::package::content::SourceLines;
use crate::package::error::{ArchiveProblem, ManifestProblem, PackageError, TableProblem};
use crate::package::raw::{Manifest, ManifestMesh, RawElement, RawNode, RawPackage};

/// Nodes without an element that are always accepted.
const MOST_SPARE: usize = 1000;

/// Partners of nodes on the cyclic faces, or [`NONE`].
pub(crate) struct Faces<'a> {
    pub(crate) high_of: &'a [u32],
    pub(crate) low_of: &'a [u32],
}

/// Checks and makes the mesh of a package that has one.
pub(crate) fn check(
    package: &RawPackage,
    lines: &SourceLines,
    frame: &AxisFrame,
    index: &NodeIndex,
    rows_of_node: &[[u32; 3]],
    faces: &Faces,
) -> Result<Option<SectorMesh>, PackageError> {
    let manifest = &package.manifest;
    let (stated, elements) = match (&manifest.mesh, &package.elements) {
        (Some(stated), Some(elements)) => (stated, elements),
        (Some(stated), None) => {
            let problem = ManifestProblem::FileMissing { file: stated.elements.clone(), found_in: None };
            return Err(PackageError::manifest("/mesh/elements", problem));
        }
        (None, Some(_)) => {
            return Err(PackageError::archive("the element table".to_owned(), ArchiveProblem::Surplus));
        }
        (None, None) => return Ok(None),
    };
    let mesh = made(manifest, stated, elements, &package.nodes, lines, frame, index, rows_of_node, faces)?;
    has_all_that_moves(package, stated, &mesh, lines, index)?;
    check_spare_nodes(&mesh)?;
    hangs_together(stated, &mesh, lines)?;
    overlap::check(&stated.elements, &mesh, lines)?;
    repeats(stated, &mesh, lines)?;
    Ok(Some(mesh))
}

/// Mesh with the pairs of clamped nodes, which a package need not name.
#[expect(clippy::too_many_arguments, reason = "what the tables and the checks before have found")]
pub(crate) fn made(
    manifest: &Manifest,
    stated: &ManifestMesh,
    elements: &[RawElement],
    nodes: &[RawNode],
    lines: &SourceLines,
    frame: &AxisFrame,
    index: &NodeIndex,
    rows_of_node: &[[u32; 3]],
    faces: &Faces,
) -> Result<SectorMesh, PackageError> {
    let (elements, sets) = elements::check(stated, elements, nodes, lines, index)?;
    let mut cyclic: Vec<(u32, u32)> =
        (0..).zip(faces.high_of).filter(|(_, high)| **high != NONE).map(|(low, &high)| (low, high)).collect();
    if manifest.sectors > 1 && !cyclic.is_empty() {
        let of_elements: HashSet<u32> = elements.iter().flat_map(|element| &element.nodes).copied().collect();
        let clamped: Vec<u32> = (0..nodes.len() as u32)
            .filter(|&node| {
                let at = node as usize;
                rows_of_node[at] == [NONE; 3] && faces.high_of[at] == NONE && faces.low_of[at] == NONE
            })
            .filter(|node| of_elements.contains(node))
            .collect();
        let position = |node: u32| nodes[node as usize].position;
        let places = clamped.iter().map(|&node| (u64::from(node), position(node))).collect();
        let places = NodeGrid::new(places, tolerance(nodes.iter().map(|node| node.position)));
        let alpha = TAU / manifest.sectors as f64;
        let is_low = low_of_two(manifest.sectors, &elements, &cyclic);
        for &low in clamped.iter().filter(|low| is_low(**low)) {
            let high = places.near(frame.turn_point(position(low), alpha));
            cyclic.extend(high.map(|high| high as u32).filter(|&high| high != low).map(|high| (low, high)));
        }
    }
    Ok(SectorMesh {
        sectors: manifest.sectors,
        node_ids: nodes.iter().map(|node| node.id).collect(),
        nodes: nodes.iter().map(|node| node.position).collect(),
        axis: (manifest.axis.origin, frame.direction().into()),
        cyclic,
        elements,
        sets,
    })
}

/// Test whether a node may be on the low face. Of two sectors each face is a half turn from the other, so that elements decide: those around
/// the node have more free nodes of the low face than of the high one.
fn low_of_two(sectors: usize, elements: &[Element], pairs: &[(u32, u32)]) -> impl Fn(u32) -> bool + use<> {
    let mut balance: HashMap<u32, i64> = HashMap::new();
    if sectors == 2 {
        let side: HashMap<u32, i64> = pairs.iter().flat_map(|&(low, high)| [(low, 1), (high, -1)]).collect();
        for element in elements {
            let sum: i64 = element.nodes.iter().filter_map(|node| side.get(node)).sum();
            element.nodes.iter().for_each(|&node| *balance.entry(node).or_default() += sum);
        }
    }
    move |node| sectors != 2 || balance.get(&node).is_some_and(|&sum| sum > 0)
}

/// Refuses more nodes without element than any export leaves: every mesh that is requested would carry them.
fn check_spare_nodes(mesh: &SectorMesh) -> Result<(), PackageError> {
    let used: HashSet<u32> = mesh.elements.iter().flat_map(|element| &element.nodes).copied().collect();
    let spare = mesh.nodes.len() - used.len();
    if spare <= MOST_SPARE.max(used.len()) {
        return Ok(());
    }
    let problem = ManifestProblem::SpareNodes { spare, used: used.len() };
    Err(PackageError::manifest("/nodes", problem))
}

/// Requires elements at nodes with degrees of freedom and at contact nodes.
fn has_all_that_moves(
    package: &RawPackage,
    stated: &ManifestMesh,
    mesh: &SectorMesh,
    lines: &SourceLines,
    index: &NodeIndex,
) -> Result<(), PackageError> {
    let mut has_element = vec![false; mesh.nodes.len()];
    mesh.elements
        .iter()
        .flat_map(|element| &element.nodes)
        .for_each(|&node| has_element[node as usize] = true);
    let elements = || stated.elements.clone();
    for (row, dof) in package.dofs.iter().enumerate() {
        if !has_element[index[&dof.node] as usize] {
            let problem = TableProblem::NoElement { node: dof.node, elements: elements() };
            let (file, line) = (package.manifest.dofs.clone(), lines.of_dof(row));
            return Err(PackageError::Table { file, line, problem });
        }
    }
    for (k, contact) in package.manifest.contact.iter().enumerate() {
        if !has_element[index[&contact.node] as usize] {
            let problem = ManifestProblem::ContactWithoutElement { node: contact.node, elements: elements() };
            return Err(PackageError::manifest(format!("/contact/{k}/node"), problem));
        }
    }
    Ok(())
}

/// Requires that all elements are one body, across the cyclic faces.
fn hangs_together(stated: &ManifestMesh, mesh: &SectorMesh, lines: &SourceLines) -> Result<(), PackageError> {
    let mut above: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    fn top(above: &mut [u32], mut node: u32) -> u32 {
        while above[node as usize] != node {
            above[node as usize] = above[above[node as usize] as usize];
            node = above[node as usize];
        }
        node
    }
    let mut join = |a: u32, b: u32| {
        let (a, b) = (top(&mut above, a), top(&mut above, b));
        above[a.max(b) as usize] = a.min(b);
    };
    mesh.cyclic.iter().for_each(|&(low, high)| join(low, high));
    for element in &mesh.elements {
        element.nodes.iter().for_each(|&node| join(element.nodes[0], node));
    }
    let body: Vec<u32> = mesh.elements.iter().map(|element| top(&mut above, element.nodes[0])).collect();
    let mut sizes: HashMap<u32, usize> = HashMap::new();
    body.iter().for_each(|&body| *sizes.entry(body).or_default() += 1);
    let largest = sizes.iter().max_by_key(|&(&body, &size)| (size, std::cmp::Reverse(body)));
    let Some((&largest, _)) = largest.filter(|_| sizes.len() > 1) else { return Ok(()) };
    let apart = body.iter().position(|&body| body != largest);
    apart.map_or(Ok(()), |row| {
        let problem =
            TableProblem::ElementsApart { element: mesh.elements[row].id, others: sizes[&body[row]] - 1 };
        Err(PackageError::Table { file: stated.elements.clone(), line: lines.of_element(row), problem })
    })
}

/// Requires that each element face on a cyclic face has a copy on the other.
fn repeats(stated: &ManifestMesh, mesh: &SectorMesh, lines: &SourceLines) -> Result<(), PackageError> {
    let low_of: HashMap<u32, u32> = mesh.cyclic.iter().map(|&(low, high)| (high, low)).collect();
    let faces = skin(mesh).faces;
    let key = |nodes: &[u32]| {
        let mut key: Vec<u32> = nodes.iter().map(|node| low_of.get(node).copied().unwrap_or(*node)).collect();
        key.sort_unstable();
        key
    };
    let of = |side| faces.iter().filter(move |face| face.cut == Some(side));
    for (side, other, name) in [(Cut::Low, Cut::High, "low"), (Cut::High, Cut::Low, "high")] {
        let copies: HashSet<Vec<u32>> = of(other).map(|face| key(&face.nodes)).collect();
        if let Some(face) = of(side).find(|face| !copies.contains(&key(&face.nodes))) {
            let row = face.element as usize;
            let problem = TableProblem::FaceNotRepeated { element: mesh.elements[row].id, side: name };
            let (file, line) = (stated.elements.clone(), lines.of_element(row));
            return Err(PackageError::Table { file, line, problem });
        }
    }
    Ok(())
}
