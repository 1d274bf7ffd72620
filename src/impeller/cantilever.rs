//! A straight rotating beam or plate, clamped at its root: a single blade on a rigid disk.

use serde::{Deserialize, Serialize};

use super::error::ImpellerError;
use super::material::Material;
use super::mesh::{Elements, Grid, HexMesh, SectorMesh, TipNode, cell};
use super::parameters::{at_least, positive};
use super::to_package::to_package;
use crate::dynamics::sector::Units;
use crate::package::raw::RawPackage;

/// A rectangular block along x from the root (clamped) to the tip, spinning about z.
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
    /// Elements along x, y and z.
    pub elements: [usize; 3],
    /// Material.
    pub material: Material,
    /// Ω1 (rad/s).
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
            material: Material::default(),
            top_speed_rad_s: 1000.0,
        }
    }
}

/// Meshes the beam. Contact nodes: the tip's edge along z (from −z to +z), normals radially outwards.
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
    let grid = Grid { size: [nx + 1, ny + 1, nz + 1], first: 0 };
    let mut mesh = HexMesh::default();
    let mut clamped = Vec::with_capacity(grid.len());
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                mesh.nodes.push([
                    p.root_radius + p.length * i as f64 / nx as f64,
                    p.width * (j as f64 / ny as f64 - 0.5),
                    p.depth * (k as f64 / nz as f64 - 0.5),
                ]);
                clamped.push([i == 0; 3]);
            }
        }
    }
    let mut elements = Vec::with_capacity(nx * ny * nz);
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                elements.push(cell(|i, j, k| grid.node(i, j, k), i, j, k));
            }
        }
    }
    mesh.elements = Elements::Linear(elements);
    let contact =
        (0..=nz).map(|k| TipNode { node: grid.node(nx, ny / 2, k), normal: [1.0, 0.0, 0.0] }).collect();
    Ok(SectorMesh { sectors: 1, mesh, clamped, cyclic: Vec::new(), contact })
}

/// Makes the beam's package: one sector, no cyclic faces.
///
/// # Errors
/// [`ImpellerError`] names the parameter at fault.
pub fn cantilever(parameters: &CantileverParameters) -> Result<RawPackage, ImpellerError> {
    let sector = cantilever_mesh(parameters)?;
    to_package(
        "rotating cantilever",
        &sector,
        &parameters.material,
        &parameters.units,
        parameters.top_speed_rad_s,
    )
}
