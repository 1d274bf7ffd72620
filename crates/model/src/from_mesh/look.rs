//! Look at a mesh before a model is made of it: the parts of its skin, the roles that were found, what could not be found, and the price.

use std::collections::{HashMap, HashSet};

use rubmap_mesh::MeshFile;
use rubmap_solid::frame::{AxisFrame, distance};
use rubmap_solid::mesh::SectorMesh;
use serde::Serialize;

use super::chains::chains;
use super::contact_points::contact_line;
use super::cyclic::{self, Symmetry};
use super::edges::sharp;
use super::error::FromMeshError;
use super::parts::{MeshPatch, MeshRole, Parts};
use super::sector::check_choices;
use super::settings::MeshSettings;
use super::surface::Face;
use super::{body, clamp, conforming, found, materials, surface, tip};
use crate::assembly::{AssemblyPrice, MeshedSector, assembly_price};

/// Mesh of a sector as it is seen before a model is made of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeshLook {
    /// Numbers of the nodes of the skin.
    pub node_ids: Vec<u64>,
    /// Coordinates x, y, z of the nodes in `node_ids`, one node after the other, in single precision.
    pub positions: Vec<f32>,
    /// Triangles of the skin as three places in `node_ids` each, patch after patch.
    pub triangles: Vec<u32>,
    /// Smooth patches of the skin, between sharp edges: the largest first, those of the cyclic faces last.
    pub patches: Vec<MeshPatch>,
    /// Sharp edges of the skin, from node to node where three or more meet, and closed loops: the longest first, those on cyclic faces last.
    pub chains: Vec<MeshChain>,
    /// Number of sectors, if cyclic faces were found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sectors: Option<usize>,
    /// Point on the axis of rotation, and its direction, if cyclic faces were found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<[[f64; 3]; 2]>,
    /// Clamped nodes on the skin, as places in `node_ids`.
    pub clamped: Vec<u32>,
    /// Nodes of the contact line in order, as places in `node_ids`.
    pub contact_line: Vec<u32>,
    /// Contact nodes, as places in `node_ids`.
    pub contact: Vec<u32>,
    /// Findings, in sentences.
    pub found: Vec<String>,
    /// Findings that failed.
    pub refusals: Vec<LookRefusal>,
    /// Estimated cost of making the model.
    pub price: AssemblyPrice,
}

/// Chain of sharp edges.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeshChain {
    /// Nodes in order, as places in `node_ids`; a closed chain ends with its first node.
    pub nodes: Vec<u32>,
    /// Length of the chain.
    pub length: f64,
    /// Whether the chain lies on a cyclic face.
    pub cyclic: bool,
}

/// Step of a look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum LookStep {
    /// Materials of the elements.
    Materials,
    /// Elements and nodes, as one body without slits.
    Mesh,
    /// Axis, number of sectors and cyclic faces.
    Sectors,
    /// Clamped nodes.
    Clamp,
    /// Contact line.
    Contact,
    /// Memory for the assembly.
    Memory,
}

/// Finding that failed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LookRefusal {
    /// Step that failed.
    pub step: LookStep,
    /// Reason with which the model would be refused.
    pub detail: String,
}

/// Findings, and reasons of those that failed.
#[derive(Default)]
struct Findings {
    found: Vec<String>,
    refusals: Vec<LookRefusal>,
}

impl Findings {
    /// Result of a step; none after a failure, whose reason is added to the refusals.
    fn checked<T>(&mut self, step: LookStep, result: Result<T, FromMeshError>) -> Option<T> {
        let refuse =
            |error: FromMeshError| self.refusals.push(LookRefusal { step, detail: error.to_string() });
        result.map_err(refuse).ok()
    }
}

/// Roles of nodes and faces, as far as they were found.
#[derive(Default)]
struct Roles {
    clamped: Option<Vec<bool>>,
    /// Faces of the tip, as places in the surface.
    tip: Vec<usize>,
    /// Numbers of the nodes of the contact line.
    line: Vec<u64>,
    /// Numbers of the contact nodes.
    contact: Vec<u64>,
}

/// Looks at a mesh without ending at a search that fails; needs neither material nor top speed.
///
/// # Errors
/// Settings that contradict each other.
pub fn look(file: &MeshFile, settings: &MeshSettings) -> Result<MeshLook, FromMeshError> {
    check_choices(settings)?;
    let mut findings = Findings::default();
    let (sets, set_of) =
        findings.checked(LookStep::Materials, materials::assigned(file, settings)).unwrap_or_default();
    let mut mesh = body::body(file, sets, &set_of);
    findings.found.push(found::body_line(file.format.name(), mesh.nodes.len(), &found::kinds(&mesh)));
    findings.found.extend(file.left_out.iter().map(|(kind, count)| found::left_out_line(kind, *count)));
    let materials = mesh.sets.iter().map(|set| found::material_line(&set.name, found::constants(set)));
    findings.found.extend(materials);
    let surface = surface::surface(&mesh);
    let sound = body::check(file, &mesh).and_then(|()| conforming::check(&mesh, &surface));
    let symmetry = findings.checked(LookStep::Mesh, sound).and_then(|gaps| {
        findings.found.extend(gaps.map(|note| format!("note: {note}")));
        findings.checked(LookStep::Sectors, cyclic::symmetry(file, settings, &mesh, &surface))
    });
    let mut roles = Roles::default();
    if let Some(symmetry) = &symmetry {
        let axis = cyclic::frame(&symmetry.axis)?;
        mesh.axis = (symmetry.axis.origin, axis.direction().into());
        mesh.sectors = symmetry.sectors;
        mesh.cyclic.clone_from(&symmetry.pairs);
        let stated = settings.sectors.is_some() || file.symmetry.is_some();
        findings.found.push(found::axis_line([mesh.axis.0, mesh.axis.1]));
        findings.found.push(found::sectors_line(
            symmetry.sectors,
            !stated,
            symmetry.pairs.len(),
            symmetry.farthest,
        ));
        roles = find_roles(&mut findings, file, settings, &mesh, &surface, symmetry, &axis);
    }
    let axis_found = symmetry.as_ref().is_some_and(|symmetry| symmetry.axis_found);
    let of_axis = axis_found.then(|| found::AXIS_FOUND.to_owned());
    let notes = file.notes.iter().cloned().chain(found::locking(&mesh)).chain(of_axis);
    findings.found.extend(notes.map(|note| format!("note: {note}")));
    Ok(look_of(findings, settings, mesh, &surface, symmetry, roles))
}

/// Finds clamp and contact line.
fn find_roles(
    findings: &mut Findings,
    file: &MeshFile,
    settings: &MeshSettings,
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    axis: &AxisFrame,
) -> Roles {
    let mut roles = Roles::default();
    let clamp = clamp::clamped(file, settings, mesh, surface, symmetry, axis);
    if let Some((clamped, source)) = findings.checked(LookStep::Clamp, clamp) {
        let held = clamped.iter().filter(|&&held| held).count();
        findings.found.push(found::clamp_line(&source, held));
        findings.found.extend(found::on_axis_line(found::on_axis(mesh, &clamped)));
        roles.clamped = Some(clamped);
    }
    let tip = tip::tip(file, settings, mesh, surface, symmetry, axis);
    if let Some(tip) = findings.checked(LookStep::Contact, tip) {
        let free = vec![false; mesh.nodes.len()];
        let clamped = roles.clamped.as_ref().unwrap_or(&free);
        let contact = contact_line(settings, mesh, surface, symmetry, axis, clamped, &tip);
        if let Some(contact) = findings.checked(LookStep::Contact, contact) {
            let line =
                found::contact_line(&tip.source, contact.of_line, contact.points.len(), contact.spacing);
            findings.found.push(line);
            roles.contact = contact.points.iter().map(|point| point.node).collect();
        }
        findings.found.extend(tip.notes.iter().map(|note| format!("note: {note}")));
        roles.line = tip.line.iter().map(|(node, _)| *node).collect();
        roles.tip = tip.faces;
    }
    roles
}

/// Look at the skin with its parts, their roles and the price.
fn look_of(
    findings: Findings,
    settings: &MeshSettings,
    mesh: SectorMesh,
    surface: &[Face],
    symmetry: Option<Symmetry>,
    roles: Roles,
) -> MeshLook {
    let mut skin: Vec<u32> = surface.iter().flat_map(|face| face.skin.nodes.iter().copied()).collect();
    skin.sort_unstable();
    skin.dedup();
    let place: HashMap<u32, u32> = skin.iter().copied().zip(0..).collect();
    let parts = Parts { mesh: &mesh, surface, place: &place };
    let (mut patches, faces) = parts.patches(symmetry.as_ref());
    let tip: HashSet<usize> = roles.tip.iter().copied().collect();
    let held = |node: &u32| roles.clamped.as_ref().is_some_and(|clamped| clamped[*node as usize]);
    for (patch, faces) in patches.iter_mut().zip(&faces).filter(|(patch, _)| patch.role.is_none()) {
        if faces.iter().all(|face| tip.contains(face)) {
            patch.role = Some(MeshRole::Contact);
        } else if faces.iter().all(|&face| surface[face].skin.nodes.iter().all(held)) {
            patch.role = Some(MeshRole::Clamp);
        }
    }
    let pairs = || symmetry.iter().flat_map(|symmetry| &symmetry.pairs);
    let cuts: [HashSet<u32>; 2] =
        [pairs().map(|pair| pair.0).collect(), pairs().map(|pair| pair.1).collect()];
    let chain = |nodes: Vec<u32>| MeshChain {
        length: nodes
            .windows(2)
            .map(|pair| distance(mesh.nodes[pair[0] as usize], mesh.nodes[pair[1] as usize]))
            .sum(),
        cyclic: cuts.iter().any(|cut| nodes.iter().all(|node| cut.contains(node))),
        nodes: nodes.iter().map(|node| place[node]).collect(),
    };
    let places = |nodes: &[u64]| -> Vec<u32> {
        let place =
            |id| mesh.node_ids.binary_search(id).ok().and_then(|node| place.get(&(node as u32)).copied());
        nodes.iter().filter_map(place).collect()
    };
    let mut look = MeshLook {
        node_ids: skin.iter().map(|&node| mesh.node_ids[node as usize]).collect(),
        positions: skin.iter().flat_map(|&node| mesh.nodes[node as usize].map(|x| x as f32)).collect(),
        triangles: faces.iter().flatten().flat_map(|&face| parts.triangles(face)).collect(),
        patches,
        chains: sorted(chains(&sharp(surface)).into_iter().map(chain).collect()),
        sectors: symmetry.as_ref().map(|symmetry| symmetry.sectors),
        axis: symmetry.is_some().then_some([mesh.axis.0, mesh.axis.1]),
        clamped: skin.iter().filter(|node| held(node)).map(|node| place[node]).collect(),
        contact_line: places(&roles.line),
        contact: places(&roles.contact),
        found: findings.found,
        refusals: findings.refusals,
        price: AssemblyPrice::default(),
    };
    let free = || vec![false; mesh.nodes.len()];
    let clamped = roles.clamped.unwrap_or_else(free).into_iter().map(|held| [held; 3]).collect();
    let sector = MeshedSector { mesh, clamped, contact: Vec::new(), mass: settings.mass };
    look.price = assembly_price(&sector, settings.gyroscopic);
    look
}

/// Chains by length, those on cyclic faces last.
fn sorted(mut chains: Vec<MeshChain>) -> Vec<MeshChain> {
    chains.sort_by(|a, b| a.cyclic.cmp(&b.cyclic).then(b.length.total_cmp(&a.length)));
    chains
}
