//! Gyroscopic matrix from a mass matrix: what every consistent or lumped mass implies.

use std::collections::HashMap;

use nalgebra::Vector3;
use rubmap_solid::frame::AxisFrame;

use super::raw::{RawDof, RawMatrix};

/// Gyroscopic matrix G per unit speed in the rows of `mass`, which are Cartesian: every coupling `m_ab` of two nodes times 2[e×], with e the
/// direction of the axis.
///
/// The mass must be alike in all directions (`m_ab` times the unit matrix), as that of solid elements is; couplings between different
/// components are left out.
pub fn gyroscopic_of_mass(mass: &RawMatrix, dofs: &[RawDof], axis: &AxisFrame) -> RawMatrix {
    let mut rows: HashMap<u64, [Option<u32>; 3]> = HashMap::new();
    for (row, dof) in (0..).zip(dofs) {
        if let Some(place) =
            rows.entry(dof.node).or_default().get_mut(usize::from(dof.component).wrapping_sub(1))
        {
            *place = Some(row);
        }
    }
    let twice_cross = Vector3::cross_matrix(&axis.direction()) * 2.0;
    // Of each pair of nodes the coupling is read once, from the first direction that both have.
    let first = |a: u64, b: u64| (0..3).find(|&c| rows[&a][c].is_some() && rows[&b][c].is_some());
    let mut entries = Vec::new();
    for &(row, column, value) in &mass.entries {
        let (a, b) = (dofs[row as usize], dofs[column as usize]);
        let along = usize::from(a.component).wrapping_sub(1);
        if a.component != b.component || first(a.node, b.node) != Some(along) {
            continue;
        }
        for i in 0..3 {
            for j in 0..3 {
                let (Some(r), Some(c)) = (rows[&a.node][i], rows[&b.node][j]) else { continue };
                let g = twice_cross[(i, j)] * value;
                if g == 0.0 {
                    continue;
                }
                if r > c {
                    entries.push((r, c, g));
                } else if a.node != b.node {
                    entries.push((c, r, -g));
                }
            }
        }
    }
    entries.sort_unstable_by_key(|&(row, column, _)| (column, row));
    RawMatrix { size: mass.size, entries }
}
