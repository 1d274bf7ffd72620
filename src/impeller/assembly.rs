//! Element matrices into sector matrices, in the cylindrical components of each node.
//!
//! Rows: the own DOF node by node (low face and contact nodes among them), then the DOF of the high face in the
//! order of the cyclic pairs. The high face keeps its own diagonal block (an unassembled sector). Clamped DOF are
//! absent.

use nalgebra::Matrix3;

use super::element::{Matrix24, Vector24};
use super::mesh::SectorMesh;
use crate::package::raw::RawMatrix;

/// The numbering of a sector's free displacements.
#[derive(Debug, Clone)]
pub struct SectorDofs {
    /// Per node, the row of its r, θ and z displacement; none where clamped.
    pub rows: Vec<[Option<usize>; 3]>,
    /// Per row, node index and component 0, 1, 2.
    pub list: Vec<(usize, usize)>,
    /// Number of own DOF: the rows before the high face.
    pub own: usize,
    /// Per row, the row after tying the high face to the low one (nodal diameter 0).
    pub folded: Vec<usize>,
}

impl SectorDofs {
    /// Numbers the free DOF of a sector.
    pub fn new(sector: &SectorMesh) -> Self {
        let nodes = sector.mesh.nodes.len();
        let mut low_of = vec![None; nodes];
        for &(low, high) in &sector.cyclic {
            low_of[high] = Some(low);
        }
        let own_nodes = (0..nodes).filter(|&node| low_of[node].is_none());
        let high_nodes = sector.cyclic.iter().map(|&(_, high)| high);
        let mut dofs = Self { rows: vec![[None; 3]; nodes], list: Vec::new(), own: 0, folded: Vec::new() };
        for node in own_nodes.chain(high_nodes) {
            for component in 0..3 {
                if sector.clamped[node][component] {
                    continue;
                }
                let row = dofs.list.len();
                dofs.rows[node][component] = Some(row);
                dofs.list.push((node, component));
                match low_of[node] {
                    None => {
                        dofs.own += 1;
                        dofs.folded.push(row);
                    }
                    // Both faces are clamped alike, so the low row exists.
                    Some(low) => dofs.folded.push(dofs.rows[low][component].unwrap_or(row)),
                }
            }
        }
        dofs
    }
}

/// Rows of T with u_(r,θ,z) = T u_(x,y,z) at angle θ.
pub fn cylindrical_frame(theta: f64) -> Matrix3<f64> {
    let (s, c) = theta.sin_cos();
    Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
}

/// Block-diagonal turn of an element's displacements into the cylindrical components of its nodes.
pub(super) fn element_frame(sector: &SectorMesh, element: usize) -> Matrix24 {
    let mut frame = Matrix24::zeros();
    for (a, &node) in sector.mesh.elements.nodes_of(element).iter().enumerate() {
        frame.fixed_view_mut::<3, 3>(3 * a, 3 * a).copy_from(&cylindrical_frame(sector.mesh.angle(node)));
    }
    frame
}

/// Rows of an element's 24 displacements.
pub(super) fn element_rows(sector: &SectorMesh, dofs: &SectorDofs, element: usize) -> [Option<usize>; 24] {
    let nodes = sector.mesh.elements.nodes_of(element);
    std::array::from_fn(|d| dofs.rows[nodes[d / 3]][d % 3])
}

/// Assembles `element_matrix(e)`, symmetric and in Cartesian components, over the sector.
///
/// The pattern holds every pair of DOF that share an element, zeros included, so two matrices of one sector can
/// be combined entry by entry. Elements are summed in their order: the result is the same bits every time.
pub fn assemble(
    sector: &SectorMesh,
    dofs: &SectorDofs,
    element_matrix: impl Fn(usize) -> Matrix24,
) -> RawMatrix {
    let mut entries = Vec::with_capacity(sector.mesh.elements.len() * 300);
    for element in 0..sector.mesh.elements.len() {
        let frame = element_frame(sector, element);
        let k = frame * element_matrix(element) * frame.transpose();
        let rows = element_rows(sector, dofs, element);
        for (a, row) in rows.iter().enumerate() {
            let Some(row) = row else { continue };
            for (b, column) in rows.iter().enumerate().take(a + 1) {
                let Some(column) = column else { continue };
                entries.push((*row.max(column) as u32, *row.min(column) as u32, k[(a, b)]));
            }
        }
    }
    RawMatrix { size: dofs.list.len(), entries: merged(entries) }
}

/// Sorts by column, then row, and adds up what falls on one position, in the order given.
pub(super) fn merged(mut entries: Vec<(u32, u32, f64)>) -> Vec<(u32, u32, f64)> {
    entries.sort_by_key(|&(row, column, _)| (column, row));
    entries.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        if same {
            kept.2 += next.2;
        }
        same
    });
    entries
}

/// Cartesian displacements of an element's nodes from nodal cylindrical ones.
pub(super) fn element_displacements(
    sector: &SectorMesh,
    element: usize,
    displacements: &[[f64; 3]],
) -> Vector24 {
    let nodes = sector.mesh.elements.nodes_of(element);
    let u = Vector24::from_fn(|d, _| displacements[nodes[d / 3]][d % 3]);
    element_frame(sector, element).transpose() * u
}
