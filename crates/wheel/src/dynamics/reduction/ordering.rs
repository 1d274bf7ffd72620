//! Order in which the interior of a sector is eliminated.

use crate::dynamics::sector::{CyclicMatrix, SectorModel};
use rubmap_numerics::nested_dissection::dissection;

/// Own DOF inside the sector in nested-dissection order.
pub(super) fn interior_order(
    sector: &SectorModel,
    matrices: &[&CyclicMatrix],
    inside: &[bool],
) -> Vec<usize> {
    let node = &sector.node_of_dof;
    let nodes = node.iter().max().map_or(0, |last| last + 1);
    let mut members = vec![Vec::new(); nodes];
    (0..inside.len()).filter(|&dof| inside[dof]).for_each(|dof| members[node[dof]].push(dof));
    let mut number = vec![usize::MAX; nodes];
    let kept: Vec<usize> = (0..nodes).filter(|&n| !members[n].is_empty()).collect();
    kept.iter().enumerate().for_each(|(index, &n)| number[n] = index);
    let edges = matrices.iter().flat_map(|matrix| matrix.own.triplet_iter()).filter_map(|entry| {
        let between = inside[entry.row] && inside[entry.col];
        between.then(|| (number[node[entry.row]], number[node[entry.col]]))
    });
    dissection(kept.len(), edges)
        .into_iter()
        .flat_map(|index| std::mem::take(&mut members[kept[index]]))
        .collect()
}
