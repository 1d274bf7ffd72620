//! Ranges of the generator's parameters.

use super::blocks::node_count;
use super::error::ImpellerError;
use super::parameters::{ImpellerParameters, MeshDensities};
use super::ranges::{above, at_least, inside, positive};
use crate::package::quote::quoted;
use crate::package::units;

/// Most degrees of freedom of a sector, clamped ones included: the pre-stress alone then fills tens of gigabytes.
const MOST_DOF: f64 = 2e6;

/// Most sectors: no wheel has more blades.
const MOST_SECTORS: f64 = 1000.0;

impl ImpellerParameters {
    /// Refuses parameters from which no impeller can be built.
    ///
    /// # Errors
    /// [`ImpellerError::Parameter`] or [`ImpellerError::Field`] names the first field at fault.
    pub fn validate(&self) -> Result<(), ImpellerError> {
        if self.units.time != "s" {
            let requirement = "must be `s`, since speeds are in rad/s";
            return Err(ImpellerError::Parameter {
                field: "units.time",
                value: quoted(&self.units.time),
                requirement,
            });
        }
        units::check(&self.units).map_err(|(field, problem)| ImpellerError::Field {
            field: field.trim_start_matches('/').replace('/', "."),
            problem: problem.into(),
        })?;
        at_least("sectors", self.sectors, 3, "must be at least 3")?;
        inside("sectors", self.sectors as f64, 3.0..=MOST_SECTORS, "must be at most 1000")?;
        positive("bore_radius", self.bore_radius)?;
        let rule = "must be greater than `bore_radius`";
        above("inlet_hub_radius", self.inlet_hub_radius, self.bore_radius, rule)?;
        let rule = "must be greater than `inlet_hub_radius`";
        above("inlet_tip_radius", self.inlet_tip_radius, self.inlet_hub_radius, rule)?;
        let rule = "must be greater than `inlet_tip_radius`";
        above("outlet_radius", self.outlet_radius, self.inlet_tip_radius, rule)?;
        positive("outlet_blade_height", self.outlet_blade_height)?;
        let rule = "must be greater than `outlet_blade_height`";
        above("axial_length", self.axial_length, self.outlet_blade_height, rule)?;
        positive("rim_thickness", self.rim_thickness)?;
        positive("root_thickness", self.root_thickness)?;
        positive("tip_thickness", self.tip_thickness)?;
        let rule = "must not exceed `root_thickness`: blades thin towards their tips";
        inside("tip_thickness", self.tip_thickness, 0.0..=self.root_thickness, rule)?;
        inside("wrap_deg", self.wrap_deg, 0.0..=120.0, "must lie between 0 and 120 degrees")?;
        inside("backsweep_deg", self.backsweep_deg, 0.0..=75.0, "must lie between 0 and 75 degrees")?;
        self.material.validate()?;
        positive("top_speed_rad_s", self.top_speed_rad_s)?;
        at_least("contact_nodes", self.contact_nodes, 2, "must be at least 2")?;
        self.mesh.validate()?;
        let dof = self.estimated_dof();
        if dof > MOST_DOF {
            return Err(ImpellerError::Parameter {
                field: "mesh",
                value: format!("{dof:.3e} degrees of freedom"),
                requirement: "must not ask for more than 2,000,000 degrees of freedom",
            });
        }
        let rule = "times `contact_nodes` - 1 must be at least 2";
        at_least("mesh.between_contact_nodes", self.elements_along_blade(), 2, rule)?;
        if let (Some(splitter), Some(start)) = (self.splitter, self.splitter_start()) {
            let inner = 1..self.elements_along_blade();
            if !inner.contains(&start) {
                return Err(ImpellerError::Parameter {
                    field: "splitter.leading_edge",
                    value: splitter.leading_edge.to_string(),
                    requirement: "must leave at least one element of the main blade before it and one behind it: \
                                  move it, or use more elements along the blade",
                });
            }
        }
        Ok(())
    }

    /// Number of degrees of freedom with the clamped ones, nodes shared by disk and blades counted twice.
    fn estimated_dof(&self) -> f64 {
        let m = &self.mesh;
        let [between, height, thickness, passage, disk] =
            [m.between_contact_nodes, m.blade_height, m.blade_thickness, m.half_passage, m.disk]
                .map(|count| count as f64);
        let along = between * (self.contact_nodes as f64 - 1.0);
        let blades = if self.splitter.is_some() { 2.0 } else { 1.0 };
        let nodes = |size| node_count(self.element_order, size);
        let columns = blades * (thickness + 2.0 * passage);
        3.0 * (nodes([columns, along, disk]) + blades * nodes([thickness, along, height]))
    }
}

impl MeshDensities {
    fn validate(&self) -> Result<(), ImpellerError> {
        for (field, value) in [
            ("mesh.between_contact_nodes", self.between_contact_nodes),
            ("mesh.blade_height", self.blade_height),
            ("mesh.blade_thickness", self.blade_thickness),
            ("mesh.half_passage", self.half_passage),
            ("mesh.disk", self.disk),
        ] {
            at_least(field, value, 1, "must be at least 1")?;
        }
        Ok(())
    }
}
