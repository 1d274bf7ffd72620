//! Sector of a flat annular disk: annular plates and spinning disks, whose solutions are known in closed form.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::blocks::BlockMesher;
use super::error::ImpellerError;
use super::material::Material;
use super::mesh::{ElementOrder, SectorMesh};
use super::ranges::{above, at_least, positive};
use crate::assembly::{PackageFacts, TipNode, to_package};
use crate::package::raw::RawPackage;
use rubmap_wheel::dynamics::sector::Units;

/// Disk of constant thickness about z, in its middle plane z = 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AnnulusParameters {
    /// Consistent units (mm, N, s, t).
    pub units: Units,
    /// Number of sectors N ≥ 3.
    pub sectors: usize,
    /// Radius of the bore, positive.
    pub inner_radius: f64,
    /// Radius of the rim, above the bore's.
    pub outer_radius: f64,
    /// Thickness, positive.
    pub thickness: f64,
    /// Whether the bore is clamped; a free disk has no pre-stress solution, since it can move as a rigid body.
    pub clamped_bore: bool,
    /// Elements along the radius, around the sector (at least 2) and through the thickness.
    pub elements: [usize; 3],
    /// Order of the elements: 8-node or 20-node hexahedra.
    pub element_order: ElementOrder,
    /// Material of the disk.
    pub material: Material,
    /// Highest speed Ω1 of the stiffness matrices (rad/s).
    pub top_speed_rad_s: f64,
}

impl Default for AnnulusParameters {
    fn default() -> Self {
        Self {
            units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
            sectors: 12,
            inner_radius: 30.0,
            outer_radius: 100.0,
            thickness: 2.0,
            clamped_bore: true,
            elements: [8, 2, 1],
            element_order: ElementOrder::Quadratic,
            material: Material::default(),
            top_speed_rad_s: 1000.0,
        }
    }
}

/// Meshes the sector. Contact nodes: corners along the middle of the rim (from −z to +z), normals radially outwards.
///
/// # Errors
/// [`ImpellerError::Parameter`] names the field at fault.
pub fn annulus_mesh(p: &AnnulusParameters) -> Result<SectorMesh, ImpellerError> {
    at_least("sectors", p.sectors, 3, "must be at least 3")?;
    positive("inner_radius", p.inner_radius)?;
    above("outer_radius", p.outer_radius, p.inner_radius, "must be greater than `inner_radius`")?;
    positive("thickness", p.thickness)?;
    let [radial, around, through] = p.elements;
    at_least("elements[0]", radial, 1, "must be at least 1")?;
    let rule = "must be at least 2: contact nodes must not lie on a cyclic face";
    at_least("elements[1]", around, 2, rule)?;
    at_least("elements[2]", through, 1, "must be at least 1")?;

    let pitch = 2.0 * PI / p.sectors as f64;
    let part = |half: usize, count: usize| half as f64 / (2 * count) as f64;
    let mut mesher = BlockMesher::new(p.element_order);
    let block = mesher.add(
        p.elements,
        |_| None,
        |[i, j, k]| {
            let r = p.inner_radius + (p.outer_radius - p.inner_radius) * part(i, radial);
            let theta = pitch * (part(j, around) - 0.5);
            [r * theta.cos(), r * theta.sin(), p.thickness * (part(k, through) - 0.5)]
        },
    );
    let clamped = block.iter().map(|([i, ..], _)| [p.clamped_bore && i == 0; 3]).collect();
    let low = block.iter().filter(|([_, j, _], _)| *j == 0);
    let cyclic = low.filter_map(|([i, _, k], node)| Some((node, block.node([i, 2 * around, k])?))).collect();
    let middle = p.element_order.middle(around);
    let rim = (0..=through).filter_map(|k| block.node([2 * radial, middle, 2 * k]));
    let contact = rim.map(|node| TipNode { node, normal: [1.0, 0.0, 0.0] }).collect();
    Ok(SectorMesh { sectors: p.sectors, mesh: mesher.finish(), clamped, cyclic, contact })
}

/// Makes the disk's package.
///
/// # Errors
/// [`ImpellerError`] names the parameter at fault; [`ImpellerError::CanMove`] for a free bore.
pub fn annulus(parameters: &AnnulusParameters) -> Result<RawPackage, ImpellerError> {
    let sector = annulus_mesh(parameters)?;
    positive("top_speed_rad_s", parameters.top_speed_rad_s)?;
    parameters.material.validate()?;
    sector.mesh.check_jacobians()?;
    let facts = PackageFacts {
        name: "annular disk".to_owned(),
        units: parameters.units.clone(),
        top_speed_rad_s: parameters.top_speed_rad_s,
        gyroscopic: false,
    };
    Ok(to_package(&facts, &sector.made_of(&parameters.material))?)
}
