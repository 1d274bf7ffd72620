//! What the generator can be asked for.

use serde::{Deserialize, Serialize};

use super::error::ImpellerError;
use super::material::Material;
use crate::dynamics::sector::Units;

/// Most elements the generator makes: some 650,000 DOF, beyond what this module's pre-stress solve is meant for.
const MOST_ELEMENTS: f64 = 200_000.0;

/// A parametric centrifugal impeller: one main blade per sector on a solid hub.
///
/// Lengths, times and forces are in the consistent units named by `units`; the defaults are the demo's impeller
/// in mm-t-s-N. The axis of rotation is z; the flow enters at z = 0 towards +z and leaves radially at
/// `outlet_radius`. The wheel turns towards +θ and the blades lean back towards −θ on their way out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ImpellerParameters {
    /// Consistent units of everything below (mm, N, s, t); time in `s`.
    pub units: Units,
    /// Number of sectors (main blades) N ≥ 3.
    pub sectors: usize,
    /// Radius of the bore, which is clamped to the shaft (mm).
    pub bore_radius: f64,
    /// Hub radius at the leading edge, above the bore's (mm).
    pub inlet_hub_radius: f64,
    /// Blade-tip radius at the leading edge, above the hub's (mm).
    pub inlet_tip_radius: f64,
    /// Radius of the trailing edge and of the disk's rim, above the inlet tip's (mm).
    pub outlet_radius: f64,
    /// Axial length from the leading edge to the hub's surface at the trailing edge (mm).
    pub axial_length: f64,
    /// Height of the blade at the trailing edge, below `axial_length` (mm).
    pub outlet_blade_height: f64,
    /// Thickness of the disk at its rim; the back face is plane (mm).
    pub rim_thickness: f64,
    /// Thickness of the blade at the hub, normal to its camber surface (mm).
    pub root_thickness: f64,
    /// Thickness of the blade at its tip, normal to its camber surface (mm).
    pub tip_thickness: f64,
    /// Angle between leading and trailing edge about the axis, in degrees; the trailing edge lags behind.
    pub wrap_deg: f64,
    /// Angle of the blade from the radial direction at the trailing edge (mid-height), in degrees, backwards
    /// positive.
    pub backsweep_deg: f64,
    /// Material (titanium).
    pub material: Material,
    /// Ω1: the highest of the three speeds of the stiffness matrices (rad/s).
    pub top_speed_rad_s: f64,
    /// Number of contact nodes along the blade tip, evenly spaced from leading to trailing edge, at least 2.
    pub contact_nodes: usize,
    /// Mesh densities.
    pub mesh: MeshDensities,
}

/// Numbers of elements in each part of the sector, all at least 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MeshDensities {
    /// Elements along the blade between two contact nodes.
    pub between_contact_nodes: usize,
    /// Elements over the height of the blade, from hub to tip.
    pub blade_height: usize,
    /// Elements through the thickness of the blade; with an odd number the contact nodes sit on the suction-side
    /// edge of the tip's middle element, with an even number on the tip's mid-line.
    pub blade_thickness: usize,
    /// Elements across the passage on each side of the blade, up to the cyclic face.
    pub half_passage: usize,
    /// Elements through the disk, from bore or back face to the hub's surface.
    pub disk: usize,
}

impl Default for MeshDensities {
    fn default() -> Self {
        Self { between_contact_nodes: 2, blade_height: 8, blade_thickness: 2, half_passage: 3, disk: 3 }
    }
}

impl Default for ImpellerParameters {
    fn default() -> Self {
        Self {
            units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
            sectors: 10,
            bore_radius: 16.0,
            inlet_hub_radius: 22.0,
            inlet_tip_radius: 86.0,
            outlet_radius: 130.0,
            axial_length: 62.0,
            outlet_blade_height: 10.0,
            rim_thickness: 7.0,
            root_thickness: 1.7,
            tip_thickness: 0.6,
            wrap_deg: 25.0,
            backsweep_deg: 25.0,
            material: Material::default(),
            top_speed_rad_s: 4000.0,
            contact_nodes: 10,
            mesh: MeshDensities::default(),
        }
    }
}

impl ImpellerParameters {
    /// Refuses parameters from which no impeller can be built.
    ///
    /// # Errors
    /// [`ImpellerError::Parameter`] names the first field at fault.
    pub fn validate(&self) -> Result<(), ImpellerError> {
        if self.units.time != "s" {
            let requirement = "must be `s`, since speeds are in rad/s";
            return Err(ImpellerError::Parameter {
                field: "units.time",
                value: self.units.time.clone(),
                requirement,
            });
        }
        at_least("sectors", self.sectors, 3, "must be at least 3")?;
        positive("bore_radius", self.bore_radius)?;
        above(
            "inlet_hub_radius",
            self.inlet_hub_radius,
            self.bore_radius,
            "must be greater than `bore_radius`",
        )?;
        above(
            "inlet_tip_radius",
            self.inlet_tip_radius,
            self.inlet_hub_radius,
            "must be greater than `inlet_hub_radius`",
        )?;
        above(
            "outlet_radius",
            self.outlet_radius,
            self.inlet_tip_radius,
            "must be greater than `inlet_tip_radius`",
        )?;
        positive("outlet_blade_height", self.outlet_blade_height)?;
        above(
            "axial_length",
            self.axial_length,
            self.outlet_blade_height,
            "must be greater than `outlet_blade_height`",
        )?;
        positive("rim_thickness", self.rim_thickness)?;
        positive("root_thickness", self.root_thickness)?;
        positive("tip_thickness", self.tip_thickness)?;
        inside("wrap_deg", self.wrap_deg, 0.0..=120.0, "must lie between 0 and 120 degrees")?;
        inside("backsweep_deg", self.backsweep_deg, 0.0..=75.0, "must lie between 0 and 75 degrees")?;
        self.material.validate()?;
        positive("top_speed_rad_s", self.top_speed_rad_s)?;
        at_least("contact_nodes", self.contact_nodes, 2, "must be at least 2")?;
        let mesh = &self.mesh;
        for (field, value) in [
            ("mesh.between_contact_nodes", mesh.between_contact_nodes),
            ("mesh.blade_height", mesh.blade_height),
            ("mesh.blade_thickness", mesh.blade_thickness),
            ("mesh.half_passage", mesh.half_passage),
            ("mesh.disk", mesh.disk),
        ] {
            at_least(field, value, 1, "must be at least 1")?;
        }
        let elements = self.element_count();
        if elements > MOST_ELEMENTS {
            return Err(ImpellerError::Parameter {
                field: "mesh",
                value: format!("{elements:.3e} elements"),
                requirement: "must not ask for more than 200,000 elements",
            });
        }
        Ok(())
    }

    /// Elements of the sector, as a float: hostile densities must not overflow.
    fn element_count(&self) -> f64 {
        let [along, height, thickness, passage, disk] = [
            self.mesh.between_contact_nodes,
            self.mesh.blade_height,
            self.mesh.blade_thickness,
            self.mesh.half_passage,
            self.mesh.disk,
        ]
        .map(|count| count as f64);
        along * (self.contact_nodes as f64 - 1.0) * ((thickness + 2.0 * passage) * disk + thickness * height)
    }

    /// Elements along the blade from leading to trailing edge.
    pub fn elements_along_blade(&self) -> usize {
        self.mesh.between_contact_nodes * (self.contact_nodes - 1)
    }
}

/// Refuses values that are not finite and positive.
pub(super) fn positive(field: &'static str, value: f64) -> Result<(), ImpellerError> {
    above(field, value, 0.0, "must be a positive number")
}

/// Refuses values that are not finite and above `bound`.
pub(super) fn above(
    field: &'static str,
    value: f64,
    bound: f64,
    requirement: &'static str,
) -> Result<(), ImpellerError> {
    if value.is_finite() && value > bound {
        return Ok(());
    }
    Err(ImpellerError::Parameter { field, value: value.to_string(), requirement })
}

/// Refuses values outside a closed range.
pub(super) fn inside(
    field: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
    requirement: &'static str,
) -> Result<(), ImpellerError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(ImpellerError::Parameter { field, value: value.to_string(), requirement })
}

/// Refuses counts below `least`.
pub(super) fn at_least(
    field: &'static str,
    value: usize,
    least: usize,
    requirement: &'static str,
) -> Result<(), ImpellerError> {
    if value >= least {
        return Ok(());
    }
    Err(ImpellerError::Parameter { field, value: value.to_string(), requirement })
}
