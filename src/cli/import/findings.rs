//! Findings about a package, printed after an import.

use std::fmt::{self, Write};

use crate::dynamics::findings::{Findings, MaterialInSi, SpinAtSpeed};

/// Adds size, materials, K(Ω) and warnings to the description.
pub(super) fn describe_findings(text: &mut String, findings: &Findings) -> fmt::Result {
    if let Some(in_si) = &findings.in_si {
        writeln!(
            text,
            "In SI units: {:.4} kg without clamped nodes, contact nodes up to {:.4} m from the axis",
            in_si.mass_kg, in_si.contact_radius_m
        )?;
        if let Some(wheel) = &in_si.wheel {
            writeln!(
                text,
                "The wheel by its elements: {:.4} kg, {:.4e} m³, centre {:.5} m along the axis, {:.4e} kg m² about it",
                wheel.mass_kg, wheel.volume_m3, wheel.centre_m, wheel.polar_inertia_kg_m2
            )?;
        }
        if let Some(speed) = in_si.tip_speed_m_s {
            writeln!(text, "Tip speed {speed:.1} m/s at the highest speed of the stiffness")?;
        }
        for MaterialInSi { set, youngs_modulus_pa, density_kg_m3, wave_speed_m_s } in &in_si.materials {
            writeln!(
                text,
                "{set}: E {youngs_modulus_pa:.3e} Pa, ρ {density_kg_m3:.4} kg/m³, √(E/ρ) {wave_speed_m_s:.0} m/s"
            )?;
        }
    }
    for SpinAtSpeed { speed_rad_s, finding } in &findings.spin {
        writeln!(text, "Stiffness at {speed_rad_s} rad/s: {finding}")?;
    }
    for warning in findings.warnings() {
        writeln!(text, "WARNING: {warning}")?;
    }
    Ok(())
}
