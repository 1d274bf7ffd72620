//! Elements that version 2.2 lists once for each of their physical groups.

use crate::mesh_file::MeshFile;

use super::groups::Groups;

/// Unites elements of the same nodes in different groups, which are one element: version 2.2 has one group for an element, so that Gmsh lists
/// an element once per group, with a new number each time. The first number stays.
pub(super) fn unite(groups: &mut Groups, mesh: &mut MeshFile) {
    if groups.of_solids() < 2 {
        return;
    }
    let mut by_nodes: Vec<(&[u64], u64)> =
        mesh.elements.iter().map(|(&id, element)| (element.nodes.as_slice(), id)).collect();
    by_nodes.sort_unstable();
    let mut repeated = Vec::new();
    for same in by_nodes.chunk_by(|(one, _), (other, _)| one == other) {
        if let Some((&(_, first), others)) = same.split_first() {
            repeated.extend(others.iter().map(|&(_, other)| (first, other)));
        }
    }
    let mut of = groups.by_solid();
    for (first, other) in repeated {
        let (Some(of_first), Some(of_other)) = (of.get(&first), of.get(&other)) else { continue };
        // Two of one group are left for the check of the geometry.
        if !of_first.is_disjoint(of_other) {
            continue;
        }
        mesh.elements.remove(&other);
        for group in of_other.clone() {
            groups.replace(group, other, first);
            of.entry(first).or_default().insert(group);
        }
    }
}
