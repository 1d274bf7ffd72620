//! M and `K(Ω) = K_e + K_σ(Ω) − Ω² M_spin` of a sector, on the undeformed geometry.

use super::assembly::{SectorDofs, assemble};
use super::element;
use super::error::ImpellerError;
use super::material::Material;
use super::mesh::SectorMesh;
use super::prestress::{self, PreStress};
use crate::package::raw::RawMatrix;

/// The matrices a package is made of, before a speed is chosen.
#[derive(Debug, Clone)]
pub struct SectorMatrices {
    /// Numbering of the rows.
    pub dofs: SectorDofs,
    /// Consistent mass M.
    pub mass: RawMatrix,
    /// Elastic stiffness `K_e`, the stiffness at rest.
    pub elastic: RawMatrix,
    /// `K_σ(1) − M_spin`: geometric stiffness and spin softening per unit Ω², in the pattern of `elastic`.
    pub spin: RawMatrix,
    /// Stresses and displacements the geometric stiffness comes from.
    pub prestress: PreStress,
}

impl SectorMatrices {
    /// Assembles the matrices and solves for the pre-stress.
    ///
    /// Spin softening is M without its axial rows and columns: the centrifugal load's change with displacement
    /// acts in the plane of rotation only, and that plane is the same in every node's cylindrical frame.
    ///
    /// # Errors
    /// [`ImpellerError`] for a bad element, an unclamped sector or impossible material constants.
    pub fn assemble(sector: &SectorMesh, material: &Material) -> Result<Self, ImpellerError> {
        material.validate()?;
        sector.mesh.check_jacobians()?;
        let dofs = SectorDofs::new(sector);
        let nodal_mass = |e| element::mass(&sector.mesh.corners(e), material.density);
        let mass = assemble(sector, &dofs, |e| element::expand_nodal(&nodal_mass(e), [1.0; 3]));
        let elastic = assemble(sector, &dofs, |e| element::stiffness(&sector.mesh.corners(e), material));
        let prestress = prestress::solve(sector, &dofs, material, &elastic)?;
        let spin = assemble(sector, &dofs, |e| {
            let stresses = &prestress.stresses[e];
            let geometric = element::geometric_stiffness(&sector.mesh.corners(e), stresses);
            element::expand_nodal(&geometric, [1.0; 3])
                - element::expand_nodal(&nodal_mass(e), [1.0, 1.0, 0.0])
        });
        Ok(Self { dofs, mass, elastic, spin, prestress })
    }

    /// K(Ω); linear in Ω².
    pub fn stiffness(&self, speed_rad_s: f64) -> RawMatrix {
        let square = speed_rad_s * speed_rad_s;
        let pairs = self.elastic.entries.iter().zip(&self.spin.entries);
        let entries = pairs.map(|(&(row, column, e), &(_, _, s))| (row, column, e + square * s)).collect();
        RawMatrix { size: self.elastic.size, entries }
    }
}
