//! Checks of the tables: every node once, every DOF once, every DOF of a known node.

use std::collections::HashMap;

use super::layout::NONE;
use crate::package::content::SourceLines;
use crate::package::error::{PackageError, TableProblem};
use crate::package::raw::{RawDof, RawNode};

/// Position of each node id in the node table.
pub(crate) type NodeIndex = HashMap<u64, u32>;

/// Indexes the rows of the node table in `file`.
pub(crate) fn node_index(
    file: &str,
    nodes: &[RawNode],
    lines: &SourceLines,
) -> Result<NodeIndex, PackageError> {
    let wrong =
        |row, problem| Err(PackageError::Table { file: file.to_owned(), line: lines.of_node(row), problem });
    if nodes.is_empty() {
        return wrong(0, TableProblem::Empty);
    }
    let mut index = NodeIndex::with_capacity(nodes.len());
    for (row, node) in nodes.iter().enumerate() {
        for (column, value) in ["x", "y", "z"].into_iter().zip(node.position) {
            if !value.is_finite() {
                return wrong(row, TableProblem::BadNumber { column, text: value.to_string() });
            }
        }
        if let Some(first) = index.insert(node.id, row as u32) {
            let first_line = lines.of_node(first as usize);
            return wrong(row, TableProblem::NodeRepeated { node: node.id, first_line });
        }
    }
    Ok(index)
}

/// Node of each row of the DOF table in `file`, and the rows of each node's components.
pub(crate) fn rows(
    file: &str,
    dofs: &[RawDof],
    lines: &SourceLines,
    index: &NodeIndex,
) -> Result<(Vec<u32>, Vec<[u32; 3]>), PackageError> {
    let wrong =
        |row, problem| Err(PackageError::Table { file: file.to_owned(), line: lines.of_dof(row), problem });
    if dofs.is_empty() {
        return wrong(0, TableProblem::Empty);
    }
    let mut node_of_row = Vec::with_capacity(dofs.len());
    let mut rows_of_node = vec![[NONE; 3]; index.len()];
    for (row, dof) in dofs.iter().enumerate() {
        let Some(&node) = index.get(&dof.node) else {
            return wrong(row, TableProblem::UnknownNode { node: dof.node });
        };
        if !(1..=3).contains(&dof.component) {
            return wrong(row, TableProblem::BadComponent { text: dof.component.to_string() });
        }
        let slot = &mut rows_of_node[node as usize][usize::from(dof.component) - 1];
        if *slot != NONE {
            let (first_row, first_line) = (*slot as usize + 1, lines.of_dof(*slot as usize));
            let problem =
                TableProblem::DofRepeated { node: dof.node, component: dof.component, first_row, first_line };
            return wrong(row, problem);
        }
        *slot = row as u32;
        node_of_row.push(node);
    }
    Ok((node_of_row, rows_of_node))
}
