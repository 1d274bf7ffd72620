//! The Euler force on a wheel at rest in its frame, in the coordinates of its reduction (docs/method.md, Run-up and run-down).

use faer::c64;

use crate::own_load::own_load;
use rubmap_solid::load::euler;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// −∫ρ Υᵀ(ẑ × r) dV of a sector at nodal diameter 0: the load per unit Ω̇ on every unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct EulerLoad(Vec<f64>);

impl EulerLoad {
    /// Euler load of a mesh and its nodes in the same order, with this number of own DOF; `project` takes a load on these to the unknowns
    /// by the basis of nodal diameter 0.
    ///
    /// # Errors
    /// Errors of `project`.
    pub fn of<E>(
        mesh: &SectorMesh,
        nodes: &[SectorNode],
        own_dofs: usize,
        project: impl FnOnce(&[f64]) -> Result<Vec<c64>, E>,
    ) -> Result<Self, E> {
        let load = project(&own_load(nodes, &euler(mesh), own_dofs))?;
        // Nodal diameter 0 is real.
        Ok(Self(load.iter().map(|load| load.re).collect()))
    }

    /// Zero load.
    pub(crate) fn none() -> Self {
        Self(Vec::new())
    }

    /// Load on every unknown, in the order of the unknowns.
    pub fn of_unknowns(&self) -> &[f64] {
        &self.0
    }
}
