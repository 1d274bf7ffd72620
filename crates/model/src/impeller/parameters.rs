//! Parameters of the impeller generator.

use serde::{Deserialize, Serialize};

use super::material::Material;
use super::mesh::ElementOrder;
use crate::package::units::factors;
use rubmap_wheel::dynamics::sector::Units;

/// Parametric centrifugal impeller: per sector one main blade, and a splitter if asked for, on a solid hub.
///
/// Lengths, times and forces are in the consistent units named by `units`; the defaults are in mm-t-s-N. The axis of
/// rotation is z; the flow enters at z = 0 towards +z and leaves radially at `outlet_radius`. Hub and shroud are quarter
/// ellipses that turn from axial to radial. The wheel turns towards +θ and the blades lean back towards −θ on their way
/// out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct ImpellerParameters {
    /// Consistent units of all parameters (mm, N, s, t); time in `s`. Parameters that are not given come from the preset, converted to
    /// these units.
    pub units: Units,
    /// Number of sectors (main blades), at least 3.
    #[cfg_attr(feature = "schema", schema(minimum = 3))]
    pub sectors: usize,
    /// Radius of the bore, which is clamped to the shaft, positive (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub bore_radius: f64,
    /// Hub radius at the leading edge, above the bore's (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub inlet_hub_radius: f64,
    /// Blade-tip radius at the leading edge, above the hub's (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub inlet_tip_radius: f64,
    /// Radius of the trailing edge and of the disk's rim, above the inlet tip's (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub outlet_radius: f64,
    /// Axial length from the leading edge to the hub's surface at the trailing edge (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub axial_length: f64,
    /// Height of the blade at the trailing edge, below `axial_length` (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub outlet_blade_height: f64,
    /// Thickness of the disk at its rim; the back face is plane (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub rim_thickness: f64,
    /// Thickness of the blades at the hub, normal to their camber surface (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub root_thickness: f64,
    /// Thickness of the blades at their tip, normal to their camber surface, at most `root_thickness` (mm).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub tip_thickness: f64,
    /// Angle between leading and trailing edge about the axis, 0 to 120 degrees; the trailing edge lags behind.
    #[cfg_attr(feature = "schema", schema(minimum = 0, maximum = 120))]
    pub wrap_deg: f64,
    /// Angle of the blade from the radial direction at the trailing edge (mid-height), 0 to 75 degrees, backwards
    /// positive.
    #[cfg_attr(feature = "schema", schema(minimum = 0, maximum = 75))]
    pub backsweep_deg: f64,
    /// Splitter, a shorter blade between two main blades; `null`: none.
    #[cfg_attr(feature = "schema", schema(required))]
    pub splitter: Option<Splitter>,
    /// Material of the impeller (titanium).
    pub material: Material,
    /// Highest speed Ω1 of the three stiffness matrices, positive (rad/s).
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub top_speed_rad_s: f64,
    /// Whether the package has a gyroscopic matrix, for Coriolis forces.
    pub gyroscopic: bool,
    /// Number of contact nodes along the main blade's tip, evenly spaced from leading to trailing edge, at least 2.
    #[cfg_attr(feature = "schema", schema(minimum = 2))]
    pub contact_nodes: usize,
    /// Order of the elements: 8-node or 20-node hexahedra.
    pub element_order: ElementOrder,
    /// Mesh densities, in numbers of elements.
    pub mesh: MeshDensities,
}

/// Splitter blade in the middle of the passage, with the main blade's shape from its own leading edge on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Splitter {
    /// Position of the leading edge, as a fraction of the meridional length between 0 and 1, both excluded; the mesh rounds it to the
    /// nearest of its elements along the blade.
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0, exclusive_maximum = 1))]
    pub leading_edge: f64,
}

/// Numbers of elements in each part of the sector, all at least 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct MeshDensities {
    /// Number of elements along the blade between two contact nodes.
    #[cfg_attr(feature = "schema", schema(minimum = 1))]
    pub between_contact_nodes: usize,
    /// Number of elements over the height of a blade, from hub to tip.
    #[cfg_attr(feature = "schema", schema(minimum = 1))]
    pub blade_height: usize,
    /// Number of elements through the thickness of a blade. Contact nodes lie on the mid-line of the tip, or on the suction-side edge of
    /// its middle element where an odd number of 8-node elements has no node on the mid-line.
    #[cfg_attr(feature = "schema", schema(minimum = 1))]
    pub blade_thickness: usize,
    /// Number of elements across half a passage: from a blade to the middle between it and the next.
    #[cfg_attr(feature = "schema", schema(minimum = 1))]
    pub half_passage: usize,
    /// Number of elements through the disk, from bore or back face to the hub's surface.
    #[cfg_attr(feature = "schema", schema(minimum = 1))]
    pub disk: usize,
}

impl Default for MeshDensities {
    fn default() -> Self {
        Self { between_contact_nodes: 2, blade_height: 8, blade_thickness: 2, half_passage: 3, disk: 3 }
    }
}

impl Default for Splitter {
    fn default() -> Self {
        Self { leading_edge: 1.0 / 3.0 }
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
            splitter: None,
            material: Material::default(),
            top_speed_rad_s: 4000.0,
            gyroscopic: false,
            contact_nodes: 10,
            element_order: ElementOrder::default(),
            mesh: MeshDensities::default(),
        }
    }
}

impl ImpellerParameters {
    /// Converts the impeller to other units of length, force and mass.
    ///
    /// # Errors
    /// Field of a unit whose size is not known.
    pub(super) fn in_units(mut self, units: &Units) -> Result<Self, &'static str> {
        let [length, force, mass] = factors(&self.units, units)?;
        for own in [
            &mut self.bore_radius,
            &mut self.inlet_hub_radius,
            &mut self.inlet_tip_radius,
            &mut self.outlet_radius,
            &mut self.axial_length,
            &mut self.outlet_blade_height,
            &mut self.rim_thickness,
            &mut self.root_thickness,
            &mut self.tip_thickness,
        ] {
            *own *= length;
        }
        // Presets have no strengths.
        self.material.youngs_modulus *= force / length.powi(2);
        self.material.density *= mass / length.powi(3);
        self.units = units.clone();
        Ok(self)
    }

    /// Number of elements along the blade from leading to trailing edge.
    pub fn elements_along_blade(&self) -> usize {
        self.mesh.between_contact_nodes * (self.contact_nodes - 1)
    }

    /// Number of elements across one blade and half a passage on either side of it.
    pub(super) fn lane_columns(&self) -> usize {
        self.mesh.blade_thickness + 2 * self.mesh.half_passage
    }

    /// Number of elements across the sector.
    pub(super) fn columns(&self) -> usize {
        let blades = if self.splitter.is_some() { 2 } else { 1 };
        blades * self.lane_columns()
    }

    /// Number of elements along the main blade before the splitter begins.
    pub(super) fn splitter_start(&self) -> Option<usize> {
        let along = self.elements_along_blade() as f64;
        self.splitter.map(|splitter| (splitter.leading_edge * along).round() as usize)
    }
}
