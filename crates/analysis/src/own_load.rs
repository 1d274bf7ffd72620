//! Loads of meshes on the own DOF of a sector.

use rubmap_wheel::dynamics::nodes::SectorNode;

/// Load of `forces`, (r, θ, z) at every one of `nodes`, on the `own_dofs` own DOF. Forces on nodes of the high face count at their low
/// nodes already.
pub(crate) fn own_load(nodes: &[SectorNode], forces: &[[f64; 3]], own_dofs: usize) -> Vec<f64> {
    let mut load = vec![0.0; own_dofs];
    for (node, force) in nodes.iter().zip(forces).filter(|(node, _)| !node.on_high_face) {
        for dof in node.dofs.iter().flatten() {
            load[dof.dof] += dof.components.iter().zip(force).map(|(c, f)| c * f).sum::<f64>();
        }
    }
    load
}
