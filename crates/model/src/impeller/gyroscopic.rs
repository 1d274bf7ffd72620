//! Gyroscopic matrix `G_ab = 2 ∫ ρ N_a [e_z×] N_b dV`: Coriolis forces per unit speed.

use nalgebra::Matrix3;

use super::assembly::Assembly;
use super::dofs::SectorDofs;
use super::element::{Blocks, Hex8, Hex20, Hexahedron};
use super::error::ImpellerError;
use super::material::Material;
use super::mesh::{Elements, SectorMesh};
use super::pattern::Pattern;
use crate::package::raw::RawMatrix;

/// Operator 2 [e_z×]: Coriolis force per mass, speed and velocity in x, y, z, on the left side of the equation of motion.
const TWICE_CROSS: [[f64; 3]; 3] = [[0.0, -2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

/// Assembles G from the consistent mass, in the rows of the sector's other matrices; skew-symmetric, lower triangle.
///
/// # Errors
/// [`ImpellerError`] for a bad element or impossible material constants.
pub fn gyroscopic_matrix(sector: &SectorMesh, material: &Material) -> Result<RawMatrix, ImpellerError> {
    material.validate()?;
    sector.mesh.check_jacobians()?;
    let mut matrix = match &sector.mesh.elements {
        Elements::Linear(elements) => assembled::<Hex8, 8>(sector, elements, material),
        Elements::Quadratic(elements) => assembled::<Hex20, 20>(sector, elements, material),
    };
    // A node's own block is 2 m [e_z×] in any frame: what stands on its diagonal is round-off of the turn.
    matrix.entries.retain(|&(row, column, value)| row != column && value != 0.0);
    Ok(matrix)
}

fn assembled<E: Hexahedron<N>, const N: usize>(
    sector: &SectorMesh,
    elements: &[[usize; N]],
    material: &Material,
) -> RawMatrix {
    let dofs = SectorDofs::new(sector);
    let pattern = Pattern::new(elements, &dofs.rows, dofs.list.len());
    let cross = Matrix3::from_fn(|i, j| TWICE_CROSS[i][j]);
    let assembly = Assembly::new(&sector.mesh, elements, &dofs.rows);
    let values = assembly.matrix(&pattern, |e| -> Blocks<N> {
        let mass = E::from(sector.mesh.positions(&elements[e])).mass(material.density);
        Box::new(std::array::from_fn(|a| std::array::from_fn(|b| cross * mass[(a, b)])))
    });
    pattern.raw_matrix(|position| values[position])
}
