//! Checks of the element table: every element once, of known nodes and a material, and with positive Jacobian.

use std::collections::HashMap;

use rubmap_solid::defect::{Defect, defect};
use rubmap_solid::mesh::{Element, ElementSet};

use super::materials::pointer;
use super::tables::NodeIndex;
use crate::package::content::SourceLines;
use crate::package::error::{ManifestProblem, PackageError, TableProblem};
use crate::package::raw::{ManifestMesh, RawElement, RawNode};

/// Checks the element table; returns the elements, with nodes as positions in the node table, and their sets in the order of their names.
pub(crate) fn check(
    mesh: &ManifestMesh,
    elements: &[RawElement],
    nodes: &[RawNode],
    lines: &SourceLines,
    index: &NodeIndex,
) -> Result<(Vec<Element>, Vec<ElementSet>), PackageError> {
    let wrong = |row, problem| {
        Err(PackageError::Table { file: mesh.elements.clone(), line: lines.of_element(row), problem })
    };
    let places: HashMap<&str, u32> = mesh.sets.keys().map(String::as_str).zip(0..).collect();
    let mut used = vec![false; places.len()];
    let mut row_of = HashMap::with_capacity(elements.len());
    let mut checked = Vec::with_capacity(elements.len());
    if elements.is_empty() {
        return wrong(0, TableProblem::Empty);
    }
    for (row, raw) in elements.iter().enumerate() {
        let &RawElement { id: element, kind, .. } = raw;
        if let Some(first) = row_of.insert(element, row) {
            return wrong(
                row,
                TableProblem::ElementRepeated { element, first_line: lines.of_element(first) },
            );
        }
        let Some(&set) = places.get(&*raw.set) else {
            return wrong(row, TableProblem::ElementWithoutMaterial { element, set: raw.set.to_string() });
        };
        used[set as usize] = true;
        if raw.nodes.len() != kind.nodes() {
            let (found, expected) = (raw.nodes.len(), kind.nodes());
            let problem = TableProblem::ElementNodeCount { element, kind: kind.name(), found, expected };
            return wrong(row, problem);
        }
        let mut places = Vec::with_capacity(raw.nodes.len());
        for (k, &node) in raw.nodes.iter().enumerate() {
            let Some(&place) = index.get(&node) else {
                return wrong(row, TableProblem::ElementNodeUnknown { element, node });
            };
            if raw.nodes[..k].contains(&node) {
                return wrong(row, TableProblem::ElementNodeRepeated { element, node });
            }
            places.push(place);
        }
        let positions: Vec<[f64; 3]> = places.iter().map(|&place| nodes[place as usize].position).collect();
        if let Some(defect) = defect(kind, &positions) {
            let (kind, node) = (kind.name(), |local: usize| raw.nodes[local]);
            let problem = match defect {
                Defect::Middle { node: middle, edge } => {
                    let [from, to] = edge.map(node);
                    TableProblem::ElementMiddleNode { element, kind, node: node(middle), from, to }
                }
                Defect::Jacobian { corner, determinant, likely } => {
                    let corner = corner.map(node);
                    TableProblem::ElementFlipped { element, kind, corner, determinant, likely }
                }
            };
            return wrong(row, problem);
        }
        checked.push(Element { id: element, kind, set, nodes: places });
    }
    if let Some((name, _)) = mesh.sets.keys().zip(&used).find(|(_, used)| !**used) {
        let problem = ManifestProblem::SetUnused { elements: mesh.elements.clone() };
        return Err(PackageError::manifest(pointer(name), problem));
    }
    let set =
        |(name, material): (&String, &_)| ElementSet { name: name.clone(), material: Clone::clone(material) };
    Ok((checked, mesh.sets.iter().map(set).collect()))
}
