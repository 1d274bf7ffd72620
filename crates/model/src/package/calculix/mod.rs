//! Import from CalculiX to a package: the mesh of an `.inp` deck and the matrices of `*FREQUENCY, SOLVER=MATRIXSTORAGE`.
//!
//! ```text
//! deck.inp ─▶ nodes, sets, tie ──┐
//! job.dof, .sti, .mas ─▶ rows ───┴▶ faces paired, contact ordered ─▶ RawPackage ─▶ the checks of every package
//! ```
//!
//! Two routes: the matrices of one sector whose cyclic ties were inactive, or those of a whole wheel, of which one sector
//! is cut (`wheel`). Components are Cartesian, as CalculiX writes them.

mod contact;
mod deck;
mod elements;
mod error;
mod faces;
mod matrices;
mod model;
mod no_mesh;
mod sets;
mod solids;
mod strengths;
mod text;
mod wheel;

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use nalgebra::Vector3;

pub use contact::ContactPoint;
pub(crate) use contact::{nearest_neighbours, spread, with_normals};
pub use error::{CalculixError, LineProblem, ModelProblem, NoCopy, NoOrder};
pub use model::{CalculixModel, Normals};
pub use no_mesh::NoMesh;

use super::check;
use super::coriolis::gyroscopic_of_mass;
use super::raw::{Axis, Frame, Manifest, ManifestContact, RawMatrix, RawNode, RawPackage};
use deck::Deck;
use elements::SectorTable;
use faces::{check_all_paired, check_ties, faces, pair};
use matrices::DofList;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::place::tolerance;
use sets::set;
use solids::DeckElement;
use strengths::Strengths;

/// Findings of an import, for the user to compare with what they know.
#[derive(Debug, Clone)]
pub struct ImportSummary {
    /// Whether low and high face were given the other way round.
    pub faces_swapped: bool,
    /// Contact nodes in their order.
    pub contact: Vec<ContactPoint>,
    /// Largest difference of the sectors of a whole wheel, relative to the largest force, over all matrices.
    pub sectors_differ: Option<f64>,
    /// Reason why the package has no mesh, if it has none.
    pub no_mesh: Option<NoMesh>,
}

/// Reads the files and makes a package of them, which passes [`to_sector`](super::to_sector).
///
/// # Errors
///
/// The first problem found, with its file and line where it has one.
pub fn import(model: &CalculixModel) -> Result<(RawPackage, ImportSummary), CalculixError> {
    let deck = Deck::read(&model.deck)?;
    let sectors = model.sectors.or_else(|| deck.cyclic.as_ref().map(|cyclic| cyclic.sectors));
    let sectors = sectors.filter(|&sectors| sectors > 0).ok_or(ModelProblem::SectorsUnknown)?;
    let axis = axis(model, &deck);
    let frame = AxisFrame::new(axis.origin, axis.direction).ok_or(ModelProblem::AxisWithoutDirection)?;
    let strengths = Strengths::read(model.strengths.as_deref())?;
    let sections = deck.solids.sections.iter();
    strengths.check(&sections.flat_map(|(set, material)| [set.as_str(), material]).collect::<Vec<_>>())?;
    let rest = DofList::read(&extended(&model.rest, ".dof"))?;
    let positions: HashMap<u64, [f64; 3]> = deck.nodes.iter().map(|(node, at)| (*node, *at)).collect();
    require_coordinates(&positions, rest.dofs.iter().map(|dof| dof.node), &rest.path.display().to_string())?;
    let contact_set = set(&deck, &model.contact_set)?;
    require_coordinates(&positions, contact_set.iter().copied(), &model.contact_set)?;
    let (low, high) = faces(model, &deck, sectors)?;
    require_coordinates(&positions, low.iter().chain(&high).copied(), "the cyclic faces")?;
    let tolerance = tolerance(rest.dofs.iter().map(|dof| positions[&dof.node]));
    let mut files = vec![extended(&model.rest, ".mas"), extended(&model.rest, ".sti")];
    files.extend(model.at_speed.iter().map(|(_, job)| extended(job, ".sti")));
    let mut read = vec![matrices::read(&files[0], &rest, None)?, matrices::read(&files[1], &rest, None)?];
    for ((_, job), file) in model.at_speed.iter().zip(&files[2..]) {
        let dofs = DofList::read(&extended(job, ".dof"))?;
        let places = dofs.places_in(&rest)?;
        read.push(matrices::read(file, &dofs, Some(&places))?);
    }
    require_whole(&files, &read)?;
    let mut matrices: Vec<RawMatrix> = read.into_iter().map(|(matrix, _)| matrix).collect();
    let mut summary =
        ImportSummary { faces_swapped: false, contact: Vec::new(), sectors_differ: None, no_mesh: None };
    let kept;
    let (pairs, dofs, contact_nodes) = if model.whole_wheel {
        let cut = wheel::cut(&rest, &matrices[1], &positions, &low, sectors, &frame, tolerance)?;
        let mut worst: f64 = 0.0;
        for (matrix, file) in matrices.iter_mut().zip(&files) {
            let (sector, difference) = cut.sector(file, matrix)?;
            (*matrix, worst) = (sector, worst.max(difference));
        }
        summary.sectors_differ = Some(worst);
        let contact: Vec<u64> = contact_set.iter().copied().filter(|node| cut.own.contains(node)).collect();
        if contact.is_empty() {
            return Err(ModelProblem::ContactElsewhere { set: model.contact_set.clone() }.into());
        }
        kept = elements::table(&deck.solids, &strengths, |id, element| cut.has(id, &element.nodes))
            .and_then(|kept| even(kept, &deck, sectors, |element| cut.moves(&element.nodes)));
        (cut.pairs, cut.dofs, contact)
    } else {
        kept = elements::table(&deck.solids, &strengths, |_, _| Ok(true));
        let (pairs, swapped) = pair(&low, &high, &positions, &frame, sectors, tolerance)?;
        summary.faces_swapped = swapped;
        check_ties(&pairs, &rest)?;
        (pairs, rest.dofs, contact_set.to_vec())
    };
    check_all_paired(&dofs, &pairs, &positions, &frame, sectors, tolerance)?;
    let of_elements = kept.iter().flat_map(|kept| &kept.elements).flat_map(|element| &element.nodes);
    let in_sector: HashSet<u64> = (dofs.iter().map(|dof| dof.node))
        .chain(pairs.iter().flatten().copied())
        .chain(of_elements.copied())
        .collect();
    let nodes: Vec<RawNode> = (deck.nodes.iter())
        .filter(|(node, _)| !model.whole_wheel || in_sector.contains(node))
        .map(|(id, position)| RawNode { id: *id, position: *position })
        .collect();
    let mut contact: Vec<(u64, [f64; 3])> =
        contact_nodes.iter().map(|node| (*node, positions[node])).collect();
    if !model.contact_as_listed {
        contact = contact::in_chord_order(&contact, &frame)?;
    }
    if let Some(count) = model.contact_count {
        contact = contact::spread(contact, count);
    }
    let all: Vec<[f64; 3]> = nodes.iter().map(|node| node.position).collect();
    summary.contact = contact::with_normals(&contact, &model.normals, &frame, &all)?;
    let stiffness = matrices.split_off(1);
    let Some(mass) = matrices.pop() else { unreachable!("the mass is read first") };
    let manifest = Manifest {
        name: model.name.clone(),
        sectors,
        units: model.units.clone(),
        axis,
        speeds_rad_s: std::iter::once(0.0).chain(model.at_speed.iter().map(|(speed, _)| *speed)).collect(),
        frame: Frame::Cartesian,
        mass: "m.npz".to_owned(),
        stiffness: (0..stiffness.len()).map(|k| format!("k{k}.npz")).collect(),
        gyroscopic: model.gyroscopic.then(|| "g.npz".to_owned()),
        nodes: "nodes.csv".to_owned(),
        dofs: "dofs.csv".to_owned(),
        cyclic: pairs,
        contact: summary.contact.iter().map(|point| manifest_contact(point, &frame)).collect(),
        mesh: None,
    };
    let gyroscopic = model.gyroscopic.then(|| gyroscopic_of_mass(&mass, &dofs, &frame));
    let mut package = RawPackage { manifest, nodes, dofs, mass, stiffness, gyroscopic, elements: None };
    let with_mesh = kept.and_then(|SectorTable { manifest, elements }| {
        package.manifest.mesh = Some(manifest);
        package.elements = Some(elements);
        check::mesh_alone(&package).map_err(|error| NoMesh::Refused { message: error.to_string() })
    });
    if let Err(no_mesh) = with_mesh {
        package.manifest.mesh = None;
        package.elements = None;
        summary.no_mesh = Some(no_mesh);
    }
    Ok((package, summary))
}

/// Refuses a wheel whose sectors have different numbers of elements, without elements that cannot move.
fn even(
    kept: SectorTable,
    deck: &Deck,
    sectors: usize,
    moves: impl Fn(&DeckElement) -> bool,
) -> Result<SectorTable, NoMesh> {
    let (sector, wheel) = (kept.elements.len(), deck.solids.elements.values().filter(|e| moves(e)).count());
    if sector * sectors == wheel { Ok(kept) } else { Err(NoMesh::Uneven { sector, wheel, sectors }) }
}

fn manifest_contact(point: &ContactPoint, frame: &AxisFrame) -> ManifestContact {
    let local = frame.cylindrical(point.position[1]);
    ManifestContact { node: point.node, normal: local.tr_mul(&Vector3::from(point.normal)).into() }
}

/// Appends an extension such as `.sti` to `job`, whose name may have dots.
fn extended(job: &Path, extension: &str) -> PathBuf {
    let mut name = job.as_os_str().to_owned();
    name.push(extension);
    name.into()
}

fn axis(model: &CalculixModel, deck: &Deck) -> Axis {
    let stated = || {
        let [origin, end] = deck.cyclic.as_ref()?.axis;
        Some(Axis { origin, direction: std::array::from_fn(|k| end[k] - origin[k]) })
    };
    let z = || Axis { origin: [0.0; 3], direction: [0.0, 0.0, 1.0] };
    model.axis.clone().or_else(stated).unwrap_or_else(z)
}

/// Requires the same number of entries in all matrix files: CalculiX writes every matrix of a mesh with the same entries, so that a file
/// with fewer is cut short.
fn require_whole(files: &[PathBuf], read: &[(RawMatrix, u64)]) -> Result<(), ModelProblem> {
    let held = || files.iter().zip(read.iter().map(|&(_, held)| held));
    let (Some((short, fewest)), Some((long, most))) =
        (held().min_by_key(|&(_, held)| held), held().max_by_key(|&(_, held)| held))
    else {
        return Ok(());
    };
    if fewest == most {
        return Ok(());
    }
    Err(ModelProblem::CutShort { file: short.clone(), entries: fewest, other: long.clone(), more: most })
}

fn require_coordinates(
    positions: &HashMap<u64, [f64; 3]>,
    mut nodes: impl Iterator<Item = u64>,
    place: &str,
) -> Result<(), ModelProblem> {
    match nodes.find(|node| !positions.contains_key(node)) {
        None => Ok(()),
        Some(node) => Err(ModelProblem::NoCoordinates { node, place: place.to_owned() }),
    }
}
