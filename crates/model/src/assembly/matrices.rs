//! Matrices M and `K(Ω) = K_e + K_σ(Ω) − Ω² M_spin` of a sector, on the undeformed geometry.

use nalgebra::Matrix3;
use rubmap_solid::blocks::Blocks;
use rubmap_solid::integrals;

use super::dofs::SectorDofs;
use super::pattern::Pattern;
use super::prestress::{self, CanMove, PreStress};
use super::sector::MeshedSector;
use super::sum::Assembly;
use crate::package::raw::RawMatrix;

/// Mass and stiffness of a sector at rest. The high face keeps its own diagonal block (an unassembled sector).
#[derive(Debug, Clone)]
pub struct RestMatrices {
    /// Numbering of the rows.
    pub dofs: SectorDofs,
    pattern: Pattern,
    mass: Vec<f64>,
    elastic: Vec<f64>,
}

/// Matrices of a package, before a speed is chosen.
#[derive(Debug, Clone)]
pub struct SectorMatrices {
    /// Matrices at rest, M and `K_e`.
    pub rest: RestMatrices,
    /// Stiffness `K_σ(1) − M_spin`: geometric stiffness and spin softening per unit Ω².
    spin: Vec<f64>,
    /// Pre-stress: stresses and displacements from which the geometric stiffness follows.
    pub prestress: PreStress,
}

impl RestMatrices {
    /// Assembles consistent mass M and elastic stiffness `K_e` of whole elements.
    pub fn assemble(sector: &MeshedSector) -> Self {
        let dofs = SectorDofs::new(sector);
        let pattern = Pattern::new(&sector.mesh.elements, &dofs.rows, dofs.list.len());
        let assembly = Assembly::new(sector, &dofs.rows);
        let mass = assembly.matrix(&pattern, |element, _| Blocks::scaled(&element.mass(), [1.0; 3]));
        let elastic = assembly.matrix(&pattern, |element, _| element.stiffness());
        Self { dofs, pattern, mass, elastic }
    }

    /// Mass matrix M.
    pub fn mass(&self) -> RawMatrix {
        self.pattern.raw_matrix(|position| self.mass[position])
    }

    /// Stiffness matrix at rest `K_e`, in the pattern of M.
    pub fn stiffness(&self) -> RawMatrix {
        self.pattern.raw_matrix(|position| self.elastic[position])
    }
}

impl SectorMatrices {
    /// Assembles the matrices of whole elements and solves for the pre-stress.
    ///
    /// Spin softening is M without its axial rows and columns: the centrifugal load's change with displacement
    /// acts in the plane of rotation only, and that plane is the same in every node's cylindrical frame.
    ///
    /// # Errors
    /// [`CanMove`] for a sector that nothing clamps.
    pub fn assemble(sector: &MeshedSector) -> Result<Self, CanMove> {
        let rest = RestMatrices::assemble(sector);
        let prestress = prestress::solve(sector, &rest.dofs)?;
        let axis = sector.axis().direction();
        let (along, across) = (axis * axis.transpose(), Matrix3::identity() - axis * axis.transpose());
        let assembly = Assembly::new(sector, &rest.dofs.rows);
        let spin = assembly.matrix(&rest.pattern, |element, e| {
            let stresses = &prestress.stresses[e];
            let geometric = integrals::geometric_stiffness(element.kind, &element.positions, stresses);
            let mass = element.mass();
            Blocks::from_fn(mass.nrows(), |a, b| {
                across * (geometric[(a, b)] - mass[(a, b)]) + along * geometric[(a, b)]
            })
        });
        Ok(Self { rest, spin, prestress })
    }

    /// Stiffness matrix K(Ω), linear in Ω².
    pub fn stiffness(&self, speed_rad_s: f64) -> RawMatrix {
        let square = speed_rad_s * speed_rad_s;
        self.rest.pattern.raw_matrix(|position| self.rest.elastic[position] + square * self.spin[position])
    }
}
