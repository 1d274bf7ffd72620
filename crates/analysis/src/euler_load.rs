//! The Euler force on a wheel at rest in its frame, in the coordinates of its reduction (docs/method.md, Run-up and run-down).

use crate::own_load::own_load;
use rubmap_solid::load::euler;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// −∫ρ Υᵀ(ẑ × r) dV of a sector at nodal diameter 0: the load per unit Ω̇ on every unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct EulerLoad(Vec<f64>);

impl EulerLoad {
    /// Of a mesh and its nodes in the same order; `row` tells real and imaginary part of every unknown at an own DOF, of which there are so
    /// many.
    ///
    /// # Errors
    /// Those of `row`.
    pub fn of<E>(
        mesh: &SectorMesh,
        nodes: &[SectorNode],
        own_dofs: usize,
        mut row: impl FnMut(usize) -> Result<Vec<f64>, E>,
    ) -> Result<Self, E> {
        let mut load = Vec::new();
        for (dof, force) in own_load(nodes, &euler(mesh), own_dofs).into_iter().enumerate() {
            let row = row(dof)?;
            load.resize(row.len() / 2, 0.0);
            // Nodal diameter 0 is real.
            for (load, of_unknown) in load.iter_mut().zip(row.chunks_exact(2)) {
                *load += of_unknown[0] * force;
            }
        }
        Ok(Self(load))
    }

    /// None.
    pub(crate) fn none() -> Self {
        Self(Vec::new())
    }

    /// Of every unknown, in their order.
    pub fn unknowns(&self) -> &[f64] {
        &self.0
    }
}
