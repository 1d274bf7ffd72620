//! Numbering of a sector's free displacements.

use super::sector::MeshedSector;

/// Rows of a sector's matrices: the own DOF node by node (low face and contact nodes among them), then the DOF of the high face in the
/// order of the cyclic pairs. Clamped DOF are absent.
#[derive(Debug, Clone)]
pub struct SectorDofs {
    /// Rows of the r, θ and z displacements of each node; none where clamped.
    pub rows: Vec<[Option<usize>; 3]>,
    /// Node index and component 0, 1, 2 of each row.
    pub list: Vec<(usize, usize)>,
    /// Number of own DOF: the rows before the high face.
    pub own: usize,
}

impl SectorDofs {
    /// Numbers the free DOF of a sector.
    pub fn new(sector: &MeshedSector) -> Self {
        let nodes = sector.mesh.nodes.len();
        let mut is_high = vec![false; nodes];
        for &(_, high) in &sector.mesh.cyclic {
            is_high[high as usize] = true;
        }
        let own_nodes = (0..nodes).filter(|&node| !is_high[node]);
        let high_nodes = sector.mesh.cyclic.iter().map(|&(_, high)| high as usize);
        let mut dofs = Self { rows: vec![[None; 3]; nodes], list: Vec::new(), own: 0 };
        for node in own_nodes.chain(high_nodes) {
            for component in (0..3).filter(|&component| !sector.clamped[node][component]) {
                dofs.rows[node][component] = Some(dofs.list.len());
                dofs.list.push((node, component));
                dofs.own += usize::from(!is_high[node]);
            }
        }
        dofs
    }

    /// Rows of each node's components for nodal diameter 0, and the node of each row: the high face moves as the low one, and nodes on the axis
    /// along it only.
    pub(super) fn tied_rows(&self, sector: &MeshedSector) -> (Vec<[Option<usize>; 3]>, Vec<usize>) {
        let mesh = &sector.mesh;
        let on_axis = mesh.on_axis();
        let mut rows = vec![[None; 3]; mesh.nodes.len()];
        let mut node_of_row = Vec::with_capacity(self.own);
        for &(node, component) in &self.list[..self.own] {
            if component == 2 || !on_axis[node] {
                rows[node][component] = Some(node_of_row.len());
                node_of_row.push(node);
            }
        }
        for &(low, high) in &mesh.cyclic {
            rows[high as usize] = rows[low as usize];
        }
        (rows, node_of_row)
    }
}
