//! Structured, conforming mesh of one impeller sector.
//!
//! Three directions: columns in θ, stations along the flow (equal arc lengths of hub and shroud, so contact nodes are
//! evenly spaced), and layers outwards. The disk's layers run straight from the inner curve (up the bore, then out
//! along the back face) to the hub curve; a blade's layers run straight from hub to shroud curve, on the columns the
//! disk gathers under it.

use super::blocks::BlockMesher;
use super::error::ImpellerError;
use super::geometry::Geometry;
use super::mesh::SectorMesh;
use super::parameters::ImpellerParameters;
use crate::assembly::TipNode;

/// Meshes one sector of the impeller.
///
/// # Errors
/// [`ImpellerError::Parameter`] for a field out of range, [`ImpellerError::Jacobian`] for an element turned inside out.
pub fn impeller_sector(parameters: &ImpellerParameters) -> Result<SectorMesh, ImpellerError> {
    sector_like(parameters, parameters)
}

/// Meshes the sector of `parameters` with the nodes and the clamp of the mesh of `pattern`, which has the same numbers of elements.
pub(super) fn sector_like(
    parameters: &ImpellerParameters,
    pattern: &ImpellerParameters,
) -> Result<SectorMesh, ImpellerError> {
    parameters.validate()?;
    pattern.validate()?;
    let geometry = Geometry::like(parameters, pattern);
    geometry.check_passage()?;
    let sector = mesh(&geometry);
    sector.mesh.check_jacobians()?;
    Ok(sector)
}

fn mesh(geometry: &Geometry) -> SectorMesh {
    let p = geometry.parameters;
    let m = &p.mesh;
    let (stations, columns) = (geometry.stations, p.columns());
    let mut mesher = BlockMesher::new(p.element_order);
    let disk = mesher.add([columns, stations, m.disk], |_| None, |[j, i, k]| geometry.disk_point(j, i, k));
    let mut blades = Vec::new();
    for (index, lane) in geometry.lanes.iter().enumerate() {
        let first = 2 * (index * p.lane_columns() + m.half_passage);
        let start = 2 * lane.start;
        blades.push(mesher.add(
            [m.blade_thickness, stations - lane.start, m.blade_height],
            // The blade's lowest layer of nodes is the hub's surface.
            |[j, i, k]| if k == 0 { disk.node([first + j, start + i, 2 * m.disk]) } else { None },
            |[j, i, k]| geometry.lane_point(lane, j, start + i, k),
        ));
    }
    let mesh = mesher.finish();

    let mut clamped = vec![[false; 3]; mesh.nodes.len()];
    let mut cyclic = Vec::new();
    for ([j, i, k], node) in disk.iter() {
        if k == 0 && i <= 2 * geometry.corner {
            clamped[node] = [true; 3];
        }
        if j == 0 {
            cyclic.extend(disk.node([2 * columns, i, k]).map(|high| (node, high)));
        }
    }
    let mid_line = p.element_order.middle(m.blade_thickness);
    let contact = (0..p.contact_nodes).filter_map(|c| {
        let along = 2 * c * m.between_contact_nodes;
        let [n_r, n_z] = geometry.shroud.outward_normal(geometry.fraction(along));
        let node = blades[0].node([mid_line, along, 2 * m.blade_height])?;
        Some(TipNode { node, normal: [n_r, 0.0, n_z] })
    });
    let contact = contact.collect();
    SectorMesh { sectors: p.sectors, mesh, clamped, cyclic, contact }
}
