//! Checks of `sector.json` by itself.

use super::materials;
use crate::package::error::{ManifestProblem, PackageError};
use crate::package::raw::{LONGEST_NAME, Manifest};
use crate::package::units;
use rubmap_solid::frame::AxisFrame;

/// Largest number of sectors. More are typing errors; the sector Fourier basis grows with the square.
const MOST_SECTORS: usize = 1000;

/// Largest number of contact nodes, more than any blade needs along one chord; the reduced matrices grow with the square.
const MOST_CONTACT_NODES: usize = 200;

/// Lowest and highest of highest speeds that are accepted, rad/s.
const LOWEST: f64 = 1e-3;
const HIGHEST: f64 = 1e7;

/// Least distance of two speeds, as a part of the highest.
const APART: f64 = 1e-3;

/// Checks name, counts, units, axis and speeds; returns the axis.
///
/// Three speeds need not be equally spaced: the polynomial passes through any three (docs/method.md, Centrifugal
/// stiffening).
pub(crate) fn check(manifest: &Manifest) -> Result<AxisFrame, PackageError> {
    let wrong = |field: &str, problem| Err(PackageError::manifest(field, problem));
    if manifest.name.chars().nth(LONGEST_NAME).is_some() {
        return wrong("/name", ManifestProblem::TextTooLong { limit: LONGEST_NAME });
    }
    if manifest.sectors == 0 {
        return wrong("/sectors", ManifestProblem::NoSectors);
    }
    if manifest.sectors > MOST_SECTORS {
        return wrong("/sectors", ManifestProblem::TooMany { what: "sectors", limit: MOST_SECTORS });
    }
    if manifest.contact.len() > MOST_CONTACT_NODES {
        return wrong(
            "/contact",
            ManifestProblem::TooMany { what: "contact nodes", limit: MOST_CONTACT_NODES },
        );
    }
    units::check(&manifest.units).map_err(|(field, problem)| PackageError::manifest(field, problem))?;
    if manifest.axis.origin.iter().any(|x| !x.is_finite()) {
        return wrong("/axis/origin", ManifestProblem::NotFinite);
    }
    if manifest.axis.direction.iter().any(|x| !x.is_finite()) {
        return wrong("/axis/direction", ManifestProblem::NotFinite);
    }
    let Some(frame) = AxisFrame::new(manifest.axis.origin, manifest.axis.direction) else {
        return wrong("/axis/direction", ManifestProblem::AxisWithoutDirection);
    };
    let speeds = &manifest.speeds_rad_s;
    if !matches!(speeds.len(), 1 | 3) {
        return wrong("/speeds_rad_s", ManifestProblem::SpeedCount { count: speeds.len() });
    }
    for (k, speed) in speeds.iter().enumerate() {
        let field = format!("/speeds_rad_s/{k}");
        let previous = k.checked_sub(1).map(|before| speeds[before]);
        if !speed.is_finite() {
            return wrong(&field, ManifestProblem::NotFinite);
        }
        match previous {
            None if *speed != 0.0 => {
                return wrong(&field, ManifestProblem::SpeedsNotFromZero { value: *speed });
            }
            Some(previous) if *speed <= previous => {
                return wrong(&field, ManifestProblem::SpeedsNotAscending { previous, value: *speed });
            }
            _ => {}
        }
    }
    if let [_, middle, highest] = speeds[..] {
        if !(LOWEST..=HIGHEST).contains(&highest) {
            let problem = ManifestProblem::SpeedOutOfRange { value: highest, least: LOWEST, most: HIGHEST };
            return wrong("/speeds_rad_s/2", problem);
        }
        for (k, [previous, value]) in [[0.0, middle], [middle, highest]].into_iter().enumerate() {
            if value - previous < APART * highest {
                let problem = ManifestProblem::SpeedsTooClose { previous, value, highest };
                return wrong(&format!("/speeds_rad_s/{}", k + 1), problem);
            }
        }
    }
    if manifest.stiffness.len() != speeds.len() {
        let problem =
            ManifestProblem::StiffnessCount { matrices: manifest.stiffness.len(), speeds: speeds.len() };
        return wrong("/stiffness", problem);
    }
    if let Some(mesh) = &manifest.mesh {
        materials::check(mesh)?;
    }
    Ok(frame)
}
