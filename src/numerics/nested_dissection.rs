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
    let mut neighbours = vec![BTreeSet::new(); groups];
    for column in 0..pattern.ncols() {
        for row in pattern.row_idx_of_col(column) {
            if group[row] != group[column] {
                neighbours[group[column]].insert(group[row] as i32);
                neighbours[group[row]].insert(group[column] as i32);
            }
        }
    }
    let mut starts = Vec::with_capacity(groups + 1);
    starts.push(0i32);
    let mut rows = Vec::new();
    for set in &neighbours {
        rows.extend(set.iter().copied());
        starts.push(rows.len() as i32);
    }
    // A graph without an order of its own (one node, or the library refusing it) is factored as numbered.
    let order: Vec<usize> = CscPattern::new(groups, &starts, &rows)
        .and_then(|graph| scotch_order(&graph).ok())
        .map_or_else(|| (0..groups).collect(), |order| order.iter().map(|&g| g as usize).collect());
    let mut members = vec![Vec::new(); groups];
    for (row, &g) in group.iter().enumerate() {
        members[g].push(row);
    }
    order.into_iter().flat_map(|g| std::mem::take(&mut members[g])).collect()
}
