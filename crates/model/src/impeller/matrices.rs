//! Matrices M and `K(Ω) = K_e + K_σ(Ω) − Ω² M_spin` of a sector, on the undeformed geometry.

use super::assembly::Assembly;
use super::dofs::SectorDofs;
use super::element::{Hex8, Hex20, Hexahedron, nodal_blocks};
use super::error::ImpellerError;
use super::material::Material;
use super::mesh::{Elements, SectorMesh};
use super::pattern::Pattern;
use super::prestress::{self, PreStress};
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
    /// Assembles consistent mass M and elastic stiffness `K_e`.
    ///
    /// # Errors
    /// [`ImpellerError`] for a bad element or impossible material constants.
    pub fn assemble(sector: &SectorMesh, material: &Material) -> Result<Self, ImpellerError> {
        material.validate()?;
        sector.mesh.check_jacobians()?;
        Ok(match &sector.mesh.elements {
            Elements::Linear(elements) => Self::of::<Hex8, 8>(sector, elements, material),
            Elements::Quadratic(elements) => Self::of::<Hex20, 20>(sector, elements, material),
        })
    }

    fn of<E: Hexahedron<N>, const N: usize>(
        sector: &SectorMesh,
        elements: &[[usize; N]],
        material: &Material,
    ) -> Self {
        let dofs = SectorDofs::new(sector);
        let pattern = Pattern::new(elements, &dofs.rows, dofs.list.len());
        let assembly = Assembly::new(&sector.mesh, elements, &dofs.rows);
        let element = |e: usize| E::from(sector.mesh.positions(&elements[e]));
        let mass = assembly.matrix(&pattern, |e| nodal_blocks(&element(e).mass(material.density), [1.0; 3]));
        let elastic = assembly.matrix(&pattern, |e| element(e).stiffness(material));
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
    /// Assembles the matrices and solves for the pre-stress.
    ///
    /// Spin softening is M without its axial rows and columns: the centrifugal load's change with displacement
    /// acts in the plane of rotation only, and that plane is the same in every node's cylindrical frame.
    ///
    /// # Errors
    /// [`ImpellerError`] for a bad element, an unclamped sector or impossible material constants.
    pub fn assemble(sector: &SectorMesh, material: &Material) -> Result<Self, ImpellerError> {
        let rest = RestMatrices::assemble(sector, material)?;
        match &sector.mesh.elements {
            Elements::Linear(elements) => Self::spun::<Hex8, 8>(rest, sector, elements, material),
            Elements::Quadratic(elements) => Self::spun::<Hex20, 20>(rest, sector, elements, material),
        }
    }

    fn spun<E: Hexahedron<N>, const N: usize>(
        rest: RestMatrices,
        sector: &SectorMesh,
        elements: &[[usize; N]],
        material: &Material,
    ) -> Result<Self, ImpellerError> {
        let prestress = prestress::solve::<E, N>(sector, elements, &rest.dofs, material)?;
        let assembly = Assembly::new(&sector.mesh, elements, &rest.dofs.rows);
        let spin = assembly.matrix(&rest.pattern, |e| {
            let element = E::from(sector.mesh.positions(&elements[e]));
            let geometric = element.geometric_stiffness(&prestress.stresses[e]);
            let mass = element.mass(material.density);
            let mut blocks = nodal_blocks(&(geometric - mass), [1.0, 1.0, 0.0]);
            for (a, row) in blocks.iter_mut().enumerate() {
                for (b, block) in row.iter_mut().enumerate() {
                    block[(2, 2)] = geometric[(a, b)];
                }
            }
            blocks
        });
        Ok(Self { rest, spin, prestress })
    }

    /// Stiffness matrix K(Ω), linear in Ω².
    pub fn stiffness(&self, speed_rad_s: f64) -> RawMatrix {
        let square = speed_rad_s * speed_rad_s;
        self.rest.pattern.raw_matrix(|position| self.rest.elastic[position] + square * self.spin[position])
    }
}
