//! Search for the node at a position.

use std::collections::HashMap;

use rubmap_solid::frame::distance;

/// Largest number of nodes within the tolerance of a position that are compared.
const MOST_NEAR: usize = 100;

/// Width of a cell over the tolerance: so wide that most positions have all nodes near them in one cell.
const CELL: f64 = 8.0;

/// Nodes by the cell of a grid that they lie in.
pub(crate) struct NodeGrid {
    cells: HashMap<[i64; 3], Vec<usize>>,
    nodes: Vec<(u64, [f64; 3])>,
    pub(crate) tolerance: f64,
}

/// Nearest node to a position where there is no node.
pub(crate) struct Nearest {
    pub(crate) node: u64,
    pub(crate) distance: f64,
}

impl NodeGrid {
    pub(crate) fn new(nodes: Vec<(u64, [f64; 3])>, tolerance: f64) -> Self {
        let mut cells: HashMap<_, Vec<usize>> = HashMap::new();
        for (k, (_, position)) in nodes.iter().enumerate() {
            cells.entry(cell(*position, CELL * tolerance)).or_default().push(k);
        }
        Self { cells, nodes, tolerance }
    }

    /// Node nearest to `position` within the tolerance.
    pub(crate) fn near(&self, position: [f64; 3]) -> Option<u64> {
        let corner = |sign: f64| cell(position.map(|x| x + sign * self.tolerance), CELL * self.tolerance);
        let (from, to) = (corner(-1.0), corner(1.0));
        // In a mesh that is finer than the tolerance only a few nodes are compared.
        let around = (from[0]..=to[0])
            .flat_map(|i| (from[1]..=to[1]).flat_map(move |j| (from[2]..=to[2]).map(move |k| [i, j, k])));
        let close = around.filter_map(|cell| self.cells.get(&cell)).flatten().copied().take(MOST_NEAR);
        let found = self.nearest(close, position).filter(|near| near.distance <= self.tolerance)?;
        Some(found.node)
    }

    /// Node as by [`Self::near`], or the nearest one as an error if it is farther off.
    pub(crate) fn at(&self, position: [f64; 3]) -> Result<u64, Nearest> {
        if let Some(node) = self.near(position) {
            return Ok(node);
        }
        Err(self.nearest_of_all(position))
    }

    /// Node nearest to `position`, in time that grows with the number of nodes.
    pub(crate) fn nearest_of_all(&self, position: [f64; 3]) -> Nearest {
        self.nearest(0..self.nodes.len(), position).unwrap_or(Nearest { node: 0, distance: f64::INFINITY })
    }

    fn nearest(&self, among: impl Iterator<Item = usize>, position: [f64; 3]) -> Option<Nearest> {
        among
            .map(|k| Nearest { node: self.nodes[k].0, distance: distance(self.nodes[k].1, position) })
            .min_by(|a, b| a.distance.total_cmp(&b.distance).then(a.node.cmp(&b.node)))
    }
}

fn cell(position: [f64; 3], width: f64) -> [i64; 3] {
    position.map(|x| (x / width).floor() as i64)
}
