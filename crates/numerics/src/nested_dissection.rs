//! Fill-reducing elimination orders.

use std::collections::BTreeSet;

use faer::sparse::SymbolicSparseColMatRef;
use feral_scotch::{CscPattern, scotch_order};

/// Nested-dissection order of the rows of `pattern` (square, symmetric in structure, both triangles):
/// `order[new] = old`.
///
/// `group[row]` names the node a row belongs to: rows of one node stay together, and the dissection works on the much
/// smaller graph of nodes.
pub fn nested_dissection(pattern: SymbolicSparseColMatRef<'_, usize>, group: &[usize]) -> Vec<usize> {
    let groups = group.iter().max().map_or(0, |last| last + 1);
    let edges = (0..pattern.ncols())
        .flat_map(|column| pattern.row_idx_of_col(column).map(move |row| (group[row], group[column])));
    let order = dissection(groups, edges);
    let mut members = vec![Vec::new(); groups];
    for (row, &g) in group.iter().enumerate() {
        members[g].push(row);
    }
    order.into_iter().flat_map(|g| std::mem::take(&mut members[g])).collect()
}

/// Nested-dissection order of a graph of `nodes` nodes, given by edges in any number and direction:
/// `order[new] = old`.
pub fn dissection(nodes: usize, edges: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    let mut neighbours = vec![BTreeSet::new(); nodes];
    for (a, b) in edges {
        if a != b && neighbours[a].insert(b as i32) {
            neighbours[b].insert(a as i32);
        }
    }
    let mut starts = Vec::with_capacity(nodes + 1);
    starts.push(0i32);
    let mut rows = Vec::new();
    for set in &neighbours {
        rows.extend(set.iter().copied());
        starts.push(rows.len() as i32);
    }
    // A graph without an order of its own (one node, or the library refusing it) is factored as numbered.
    CscPattern::new(nodes, &starts, &rows)
        .and_then(|graph| scotch_order(&graph).ok())
        .map_or_else(|| (0..nodes).collect(), |order| order.iter().map(|&node| node as usize).collect())
}
