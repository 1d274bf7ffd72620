//! Layout of a checked package: the role of each of its rows.

use crate::package::error::Components;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;

/// Marker of a row or node that does not exist.
pub(crate) const NONE: u32 = u32::MAX;

/// Layout of a checked package: the role of each row. Nodes are indices into the node table, rows into the DOF table.
#[derive(Debug)]
pub(crate) struct Layout {
    pub(crate) frame: AxisFrame,
    /// Node of each row.
    pub(crate) node_of_row: Vec<u32>,
    /// Rows of each node's three components, or [`NONE`].
    pub(crate) rows_of_node: Vec<[u32; 3]>,
    /// High node of each low node, or [`NONE`].
    pub(crate) high_of: Vec<u32>,
    /// Low node of each high node, or [`NONE`].
    pub(crate) low_of: Vec<u32>,
    /// Free nodes on the axis, which all sectors share.
    pub(crate) on_axis: Vec<u32>,
    /// Rows that stay, in package order: all but those of high nodes.
    pub(crate) own_rows: Vec<u32>,
    /// Position among the own DOF of each row; for a row of a high node, that of its low counterpart.
    pub(crate) own_of_row: Vec<u32>,
    /// Nodes of the contact list.
    pub(crate) contact: Vec<u32>,
    /// Contact normals, of length 1, in the package's frame.
    pub(crate) normals: Vec<[f64; 3]>,
    /// Elements, if the package has them.
    pub(crate) mesh: Option<SectorMesh>,
}

/// Components of a node that the DOF table has.
pub(super) fn components(rows: &[u32; 3]) -> Components {
    Components(rows.map(|row| row != NONE))
}

/// Rows that stay, in package order, and the position among them of every row: for a row of a high node, that of its low counterpart.
pub(crate) fn own_of_rows(
    node_of_row: &[u32],
    rows_of_node: &[[u32; 3]],
    low_of: &[u32],
) -> (Vec<u32>, Vec<u32>) {
    let mut own_rows = Vec::new();
    let mut own_of_row = vec![NONE; node_of_row.len()];
    for (row, &node) in node_of_row.iter().enumerate() {
        if low_of[node as usize] == NONE {
            own_of_row[row] = own_rows.len() as u32;
            own_rows.push(row as u32);
        }
    }
    for (high, &low) in low_of.iter().enumerate().filter(|(_, low)| **low != NONE) {
        for (&high_row, &low_row) in rows_of_node[high].iter().zip(&rows_of_node[low as usize]) {
            if high_row != NONE {
                own_of_row[high_row as usize] = own_of_row[low_row as usize];
            }
        }
    }
    (own_rows, own_of_row)
}
