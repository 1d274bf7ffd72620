//! Sector in a mesh: all steps from the file to what is assembled.

use std::collections::HashSet;

use nalgebra::Vector3;
use rubmap_mesh::MeshFile;
use rubmap_solid::frame::distance;

use super::cyclic;
use super::error::FromMeshError;
use super::found::Found;
use super::settings::MeshSettings;
use super::{body, clamp, materials, surface, tip};
use crate::assembly::{MeshedSector, PackageFacts, TipNode, assembly_bytes, to_package, without_matrices};
use crate::package::by_place::tolerance;
use crate::package::calculix::{Normals, spread, with_normals};
use crate::package::check::slits::on_axis;
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
    if !(settings.top_speed_rad_s > 0.0 && settings.top_speed_rad_s.is_finite()) {
        return Err(FromMeshError::TopSpeed(settings.top_speed_rad_s));
    }
    units::check(&settings.units).map_err(|(_, problem)| FromMeshError::Units(problem.to_string()))?;
    if settings.contact_set.is_some() && settings.contact_between.is_some() {
        return Err(FromMeshError::TwoContacts);
    }
    let (sets, set_of) = materials::assigned(file, settings)?;
    let mut mesh = body::body(file, sets, &set_of)?;
    let surface = surface::surface(&mesh);
    let symmetry = cyclic::symmetry(file, settings, &mesh, &surface)?;
    let axis = cyclic::frame(&symmetry.axis)?;
    mesh.axis = (symmetry.axis.origin, axis.direction().into());
    let (clamped, clamp) = clamp::clamped(file, settings, &mesh, &surface, &symmetry, &axis)?;
    let within = tolerance(mesh.nodes.iter().copied());
    let shared = |&(node, at): &(usize, [f64; 3])| {
        symmetry.sectors > 1 && !clamped[node] && on_axis(at, &axis, symmetry.sectors, within)
    };
    if let Some((node, _)) = mesh.nodes.iter().copied().enumerate().find(shared) {
        return Err(FromMeshError::OnAxis { node: mesh.node_ids[node] });
    }
    let (line, tip) = tip::tip(file, settings, &mesh, &surface, &symmetry, &axis)?;
    mesh.sectors = symmetry.sectors;
    mesh.cyclic.clone_from(&symmetry.pairs);
    let on_faces: HashSet<u32> = symmetry.pairs.iter().flat_map(|&(low, high)| [low, high]).collect();
    let index = |id: u64| mesh.node_ids.binary_search(&id).ok();
    let usable = |(id, _): &(u64, [f64; 3])| {
        index(*id).is_some_and(|node| !clamped[node] && !on_faces.contains(&(node as u32)))
    };
    let line: Vec<_> = line.into_iter().filter(usable).collect();
    if line.len() < 3 {
        return Err(FromMeshError::FewNodes { found: line.len() });
    }
    let of_line = line.len();
    let chosen = spread(line, settings.contact_nodes.max(3));
    let points = with_normals(&chosen, &Normals::ContactNodes, &axis, &mesh.nodes)
        .map_err(|error| FromMeshError::Normals(error.to_string()))?;
    let contact: Vec<TipNode> = points
        .iter()
        .filter_map(|point| Some(TipNode { node: index(point.node)?, normal: point.normal }))
        .collect();
    let spacing = chosen.windows(2).map(|pair| distance(pair[0].1, pair[1].1));
    let spacing = spacing.fold([f64::INFINITY, 0.0_f64], |[low, high], x| [low.min(x), high.max(x)]);
    let found = Found::of(file, settings, &mesh, &symmetry, clamp, &clamped, tip, &points, of_line, spacing);
    let facts = PackageFacts {
        name: settings.name.clone().unwrap_or_else(|| file.format.name().to_owned()),
        units: settings.units.clone(),
        top_speed_rad_s: settings.top_speed_rad_s,
        gyroscopic: settings.gyroscopic,
    };
    let clamped = clamped.into_iter().map(|clamped| [clamped; 3]).collect();
    Ok(Sector { meshed: MeshedSector { mesh, clamped, contact, mass: settings.mass }, facts, found })
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
