//! Rows of the basis that are kept in memory during a reduction.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

use super::node_rows::NodeRows;
use super::nodes::SectorNode;
use super::reduction::{BasisRows, Checkpoints, ReducedWheel};

/// Checkpoints that also hold the rows of some nodes.
pub struct KeptRows<'a> {
    checkpoints: &'a dyn Checkpoints,
    nodes: &'a [SectorNode],
    /// Rows by nodal diameter and own DOF.
    rows: Mutex<BTreeMap<(usize, usize), Vec<f64>>>,
}

impl<'a> KeptRows<'a> {
    /// Holds the rows of `nodes` and leaves all else to `checkpoints`.
    pub fn new(checkpoints: &'a dyn Checkpoints, nodes: &'a [SectorNode]) -> Self {
        Self { checkpoints, nodes, rows: Mutex::default() }
    }

    /// Rows of the nodes, once `reduced` is there.
    ///
    /// # Panics
    /// If `reduced` is of another reduction.
    pub fn of(self, reduced: &ReducedWheel) -> NodeRows {
        let rows = self.rows.into_inner().unwrap_or_else(PoisonError::into_inner);
        let gathered = NodeRows::gather(self.nodes, reduced, |harmonic, dof| {
            Ok::<_, std::convert::Infallible>(rows[&(harmonic, dof)].clone())
        });
        gathered.unwrap_or_else(|never| match never {})
    }
}

impl Checkpoints for KeptRows<'_> {
    fn load(&self, part: &str) -> Option<Vec<u8>> {
        self.checkpoints.load(part)
    }

    fn save(&self, part: &str, bytes: Vec<u8>) {
        self.checkpoints.save(part, bytes);
    }

    fn keep_basis(&self, rows: &BasisRows<'_>) {
        let dofs: BTreeSet<usize> =
            self.nodes.iter().flat_map(|node| node.dofs.iter().flatten()).map(|dof| dof.dof).collect();
        let mut kept = self.rows.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(dofs.into_iter().map(|dof| ((rows.harmonic(), dof), rows.row(dof).collect())));
        drop(kept);
        self.checkpoints.keep_basis(rows);
    }
}

impl std::fmt::Debug for KeptRows<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("KeptRows").field("nodes", &self.nodes.len()).finish_non_exhaustive()
    }
}
