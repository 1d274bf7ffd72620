//! Estimate of the memory for making a package of a meshed sector, before it is made.

use super::dofs::SectorDofs;
use super::sector::MeshedSector;

/// Rows of the sector whose peaks were measured.
const MEASURED_ROWS: f64 = 125_499.0;

/// Peak with the measured number of rows of 20-node elements (the preset `paper`) and the gyroscopic matrix.
const QUADRATIC_BYTES: f64 = 2.2e9;

/// Peak with the measured number of rows of 8-node elements, whose nodes have fewer neighbours.
const LINEAR_BYTES: f64 = 1.4e9;

/// Exponent of the growth of the factor with the number of rows, for three-dimensional meshes under nested dissection.
const FACTOR_GROWTH: f64 = 1.4;

/// Safety factor, since meshes of the same size differ in their factors.
const MARGIN: f64 = 1.25;

/// Peak of the memory, in bytes, while the package of `sector` is made, written and read back.
///
/// Estimated from measured peaks: proportional to the rows below the measured size, where matrices prevail, growing like the factor above;
/// with a quarter added.
pub fn assembly_bytes(sector: &MeshedSector) -> u64 {
    let elements = &sector.mesh.elements;
    let quadratic = elements.iter().any(|element| element.kind.nodes() > element.kind.corners());
    let measured = if quadratic { QUADRATIC_BYTES } else { LINEAR_BYTES };
    let size = SectorDofs::new(sector).list.len() as f64 / MEASURED_ROWS;
    (MARGIN * measured * size.max(size.powf(FACTOR_GROWTH))) as u64
}
