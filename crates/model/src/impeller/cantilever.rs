//! Straight rotating beam or plate, clamped at its root: a single blade on a rigid disk.

use serde::{Deserialize, Serialize};

use super::blocks::BlockMesher;
use super::error::ImpellerError;
use super::material::Material;
use super::mesh::{ElementOrder, SectorMesh};
use super::ranges::{at_least, positive};
use crate::assembly::{PackageFacts, TipNode, to_package};
use crate::package::raw::RawPackage;
use rubmap_wheel::dynamics::sector::Units;

/// Rectangular block along x from the root (clamped) to the tip, spinning about z.
///
/// Bending along z is "flap" (out of the plane of rotation), bending along y is "lag".
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CantileverParameters {
    /// Consistent units (mm, N, s, t).
    pub units: Units,
    /// Distance of the clamped root from the axis, ≥ 0.
    pub root_radius: f64,
    /// Length along x.
    pub length: f64,
    /// Width along y (tangential), centred on the x axis.
    pub width: f64,
    /// Depth along z (axial), centred on the x axis.
    pub depth: f64,
    /// Numbers of elements along x, y and z.
    pub elements: [usize; 3],
    /// Order of the elements: 8-node or 20-node hexahedra.
    pub element_order: ElementOrder,
    /// Material of the beam.
    pub material: Material,
    /// Highest speed Ω1 of the stiffness matrices (rad/s).
    pub top_speed_rad_s: f64,
}

impl Default for CantileverParameters {
    fn default() -> Self {
        Self {
            units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
            root_radius: 0.0,
            length: 100.0,
            width: 2.0,
            depth: 20.0,
            elements: [20, 1, 4],
            element_order: ElementOrder::default(),
            material: Material::default(),
            top_speed_rad_s: 1000.0,
        }
    }
}

/// Meshes the beam. Contact nodes: corners along the middle of the tip (from −z to +z), normals radially outwards.
///
/// # Errors
/// [`ImpellerError::Parameter`] names the field at fault.
pub fn cantilever_mesh(p: &CantileverParameters) -> Result<SectorMesh, ImpellerError> {
    if !(p.root_radius.is_finite() && p.root_radius >= 0.0) {
        return Err(ImpellerError::Parameter {
            field: "root_radius",
            value: p.root_radius.to_string(),
            requirement: "must be zero or positive",
        });
    }
    positive("length", p.length)?;
    positive("width", p.width)?;
    positive("depth", p.depth)?;
    for (d, field) in ["elements[0]", "elements[1]", "elements[2]"].into_iter().enumerate() {
        at_least(field, p.elements[d], 1, "must be at least 1")?;
    }
    let [nx, ny, nz] = p.elements;
    let mut mesher = BlockMesher::new(p.element_order);
    let part = |half: usize, count: usize| half as f64 / (2 * count) as f64;
    let block = mesher.add(
        p.elements,
        |_| None,
        |[i, j, k]| {
            [
                p.root_radius + p.length * part(i, nx),
                p.width * (part(j, ny) - 0.5),
                p.depth * (part(k, nz) - 0.5),
            ]
        },
    );
    let clamped = block.iter().map(|([i, ..], _)| [i == 0; 3]).collect();
    let edge = (0..=nz).filter_map(|k| block.node([2 * nx, p.element_order.middle(ny), 2 * k]));
    let contact = edge.map(|node| TipNode { node, normal: [1.0, 0.0, 0.0] }).collect();
    let mesh = mesher.finish();
    Ok(SectorMesh { sectors: 1, mesh, clamped, cyclic: Vec::new(), contact })
}

/// Makes the beam's package: one sector, no cyclic faces.
///
/// # Errors
/// [`ImpellerError`] names the parameter at fault.
pub fn cantilever(parameters: &CantileverParameters) -> Result<RawPackage, ImpellerError> {
    let sector = cantilever_mesh(parameters)?;
    positive("top_speed_rad_s", parameters.top_speed_rad_s)?;
    parameters.material.validate()?;
    sector.mesh.check_jacobians()?;
    let facts = PackageFacts {
        name: "rotating cantilever".to_owned(),
        units: parameters.units.clone(),
        top_speed_rad_s: parameters.top_speed_rad_s,
        gyroscopic: false,
    };
    Ok(to_package(&facts, &sector.made_of(&parameters.material))?)
}
