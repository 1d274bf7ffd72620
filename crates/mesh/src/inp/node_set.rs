//! Node set on its way into a mesh.

use std::collections::HashSet;

/// Nodes, each once, in the order of the file.
#[derive(Debug, Clone, Default)]
pub(super) struct NodeSet {
    list: Vec<u64>,
    known: HashSet<u64>,
}

impl NodeSet {
    /// Adds a node, unless it is there.
    pub(super) fn insert(&mut self, node: u64) {
        if self.known.insert(node) {
            self.list.push(node);
        }
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// Nodes in the order of the file.
    pub(super) fn nodes(&self) -> &[u64] {
        &self.list
    }

    /// List of the nodes.
    pub(super) fn into_list(self) -> Vec<u64> {
        self.list
    }
}

impl Extend<u64> for NodeSet {
    fn extend<I: IntoIterator<Item = u64>>(&mut self, nodes: I) {
        nodes.into_iter().for_each(|node| self.insert(node));
    }
}
