//! Sector in a mesh: all steps from the file to what is assembled.

use nalgebra::Vector3;
use rubmap_mesh::MeshFile;

use super::contact_points::contact_line;
use super::cyclic;
use super::error::FromMeshError;
use super::found::Found;
use super::settings::MeshSettings;
use super::{body, clamp, conforming, contact_points, materials, shroud, surface, tip};
use crate::assembly::{MeshedSector, PackageFacts, assembly_bytes, to_package, without_matrices};
use crate::package::raw::{Frame, RawPackage};
use crate::package::units;

/// Sector that was made of a mesh, before its matrices are assembled.
#[derive(Debug, Clone)]
pub struct Sector {
    meshed: MeshedSector,
    facts: PackageFacts,
    /// Findings about the mesh, for the user to compare with what they know.
    pub found: Found,
}

/// Finds the sector in a mesh: materials, cyclic faces, clamp and contact line.
///
/// # Errors
/// The first problem, with the element or node at fault and what to do.
pub fn sector(file: &MeshFile, settings: &MeshSettings) -> Result<Sector, FromMeshError> {
    check_settings(settings)?;
    let (sets, set_of) = materials::assigned(file, settings)?;
    let mut mesh = body::body(file, sets, &set_of);
    body::check(file, &mesh)?;
    let surface = surface::surface(&mesh);
    let gaps = conforming::check(&mesh, &surface)?;
    let symmetry = cyclic::symmetry(file, settings, &mesh, &surface)?;
    let axis = cyclic::frame(&symmetry.axis)?;
    mesh.axis = (symmetry.axis.origin, axis.direction().into());
    let steps = || {
        let (clamped, clamp) = clamp::clamped(file, settings, &mesh, &surface, &symmetry, &axis)?;
        let tip = tip::tip(file, settings, &mesh, &surface, &symmetry, &axis)?;
        let contact = contact_line(settings, &mesh, &surface, &symmetry, &axis, &clamped, &tip)?;
        Ok((clamped, clamp, tip, contact))
    };
    // These follow from axis and number of sectors, which may have been found wrongly.
    let (clamped, clamp, tip, contact) = steps().map_err(|error: FromMeshError| FromMeshError::With {
        error: Box::new(error),
        sectors: symmetry.sectors,
        origin: symmetry.axis.origin,
        direction: symmetry.axis.direction,
        found: settings.sectors.is_none() && file.symmetry.is_none(),
    })?;
    mesh.sectors = symmetry.sectors;
    mesh.cyclic.clone_from(&symmetry.pairs);
    let mut found = Found::of(file, settings, &mesh, &symmetry, (clamp, &clamped), tip, &contact);
    found.notes.extend(gaps);
    let facts = PackageFacts {
        name: settings.name.clone().unwrap_or_else(|| file.format.name().to_owned()),
        units: settings.units.clone(),
        top_speed_rad_s: settings.top_speed_rad_s,
        gyroscopic: settings.gyroscopic,
    };
    let clamped = clamped.into_iter().map(|clamped| [clamped; 3]).collect();
    let contact = contact.tips(&mesh);
    Ok(Sector { meshed: MeshedSector { mesh, clamped, contact, mass: settings.mass }, facts, found })
}

/// Refuses settings that contradict themselves or lie outside of their ranges.
fn check_settings(settings: &MeshSettings) -> Result<(), FromMeshError> {
    if !(settings.top_speed_rad_s > 0.0 && settings.top_speed_rad_s.is_finite()) {
        return Err(FromMeshError::TopSpeed(settings.top_speed_rad_s));
    }
    check_choices(settings)
}

/// Refuses settings of which only one may be given, units that do not fit each other, and too few contact nodes.
pub(super) fn check_choices(settings: &MeshSettings) -> Result<(), FromMeshError> {
    units::check(&settings.units).map_err(|(_, problem)| FromMeshError::Units(problem.to_string()))?;
    let clamps = [("clamp_set", settings.clamp_set.is_some()), ("clamp_at", !settings.clamp_at.is_empty())];
    let contacts = [
        ("contact_set", settings.contact_set.is_some()),
        ("contact_between", settings.contact_between.is_some()),
        ("contact_at", !settings.contact_at.is_empty()),
        ("shroud", settings.shroud.is_some()),
    ];
    one_at_most(&clamps, "clamp")?;
    one_at_most(&contacts, "contact line")?;
    settings.shroud.as_deref().map_or(Ok(()), shroud::check)?;
    if settings.contact_nodes < contact_points::LEAST {
        return Err(FromMeshError::ContactNodes(settings.contact_nodes));
    }
    Ok(())
}

/// Refuses settings of which two are given for one part of the model.
fn one_at_most(settings: &[(&'static str, bool)], of: &'static str) -> Result<(), FromMeshError> {
    let mut given = settings.iter().filter(|(_, given)| *given).map(|(name, _)| *name);
    match (given.next(), given.next()) {
        (Some(one), Some(other)) => Err(FromMeshError::Conflict { settings: [one, other], of }),
        _ => Ok(()),
    }
}

impl Sector {
    /// Peak of the memory, in bytes, while its package is made, written and read back.
    pub fn assembly_bytes(&self) -> u64 {
        assembly_bytes(&self.meshed)
    }

    /// Pairs of low and high nodes, clamped ones included.
    pub(super) fn pairs(&self) -> impl Iterator<Item = [u64; 2]> {
        let mesh = &self.meshed.mesh;
        mesh.cyclic.iter().map(|&(low, high)| [low, high].map(|node| mesh.node_ids[node as usize]))
    }

    /// Package in Cartesian components, without rows and matrices.
    pub(super) fn without_matrices(&self) -> RawPackage {
        let mut package = without_matrices(&self.facts, &self.meshed);
        let axis = self.meshed.axis();
        for (contact, tip) in package.manifest.contact.iter_mut().zip(&self.meshed.contact) {
            let [_, theta, _] = axis.coordinates(self.meshed.mesh.nodes[tip.node]);
            contact.normal = axis.cylindrical(theta).tr_mul(&Vector3::from(tip.normal)).into();
        }
        package.manifest.frame = Frame::Cartesian;
        package
    }

    /// Assembles the matrices and packs them.
    ///
    /// # Errors
    /// [`FromMeshError::CanMove`] for a sector that the clamp leaves free to move.
    pub fn package(&self) -> Result<RawPackage, FromMeshError> {
        Ok(to_package(&self.facts, &self.meshed)?)
    }
}
