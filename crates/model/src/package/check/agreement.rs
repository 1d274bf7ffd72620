//! Agreement of the matrices with the elements of a package: both must be of the same material.
//!
//! At a node whose neighbours are all free, the forces under two uniform strains and a translation depend on E, ν and ρ by geometry alone:
//! in every formulation that passes a patch test, whatever its integration or internal modes. Sets are judged by the median of their nodes,
//! which springs, supports and point masses at some of them do not change.

use faer::sparse::SparseColMat;
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::uniform::{UniformStrain, displacements, uniform_strain};
use rubmap_wheel::dynamics::sector::{CyclicMatrix, SectorModel};

use super::layout::{Layout, NONE};
use super::materials::pointer;
use crate::package::error::{ManifestProblem, PackageError};
use crate::package::raw::Manifest;

/// Accepted ratio of a matrix to the value that follows from the elements. Generated wheels of both orders agree to 1e-11, so the range is
/// for distorted elements that fail the patch test (C3D8I) and for a modulus at another temperature; wrong units are off by a thousand and
/// more.
const AGREEING: std::ops::RangeInclusive<f64> = 0.8..=1.25;

/// Share of the forces of neighbouring elements below which they are in balance: inside one material, away from its surface.
const IN_BALANCE: f64 = 0.1;

/// Ratios at the nodes of one set, matrix over elements.
#[derive(Default)]
struct Found {
    of_shape: Vec<f64>,
    of_volume: Vec<f64>,
    mass: Vec<f64>,
    /// Total mass from the matrix and from the elements.
    total_mass: [f64; 2],
}

/// Compares the first stiffness matrix and the mass matrix with the elements. Sets without a free node of their own are judged where they
/// meet others.
pub(crate) fn check(
    sector: &SectorModel,
    mesh: &SectorMesh,
    layout: &Layout,
    names: &Manifest,
) -> Result<(), PackageError> {
    let Some(elements) = uniform_strain(mesh) else { return Ok(()) };
    let found = compare(sector, mesh, layout, &elements);
    for (set, found) in found.iter().enumerate() {
        stiffness(mesh, set, found, &names.stiffness[0])?;
        mass(mesh, set, found, &names.mass)?;
    }
    Ok(())
}

fn stiffness(mesh: &SectorMesh, set: usize, found: &Found, file: &str) -> Result<(), PackageError> {
    let (Some(shape), Some(volume)) = (median(&found.of_shape), median(&found.of_volume)) else {
        return Ok(());
    };
    if AGREEING.contains(&shape) && AGREEING.contains(&volume) {
        return Ok(());
    }
    let file = file.to_owned();
    let Some(set) = mesh.sets.get(set) else {
        let problem = ManifestProblem::MeetingSetsDisagree { file, factor: shape };
        return Err(PackageError::manifest("/mesh/sets", problem));
    };
    let (e, nu) = (set.material.youngs_modulus, set.material.poissons_ratio);
    let (of_shape, of_volume) = (shape * e / (1.0 + nu), volume * e / (1.0 - 2.0 * nu));
    let poissons_ratio = (of_volume - of_shape) / (2.0 * of_volume + of_shape);
    let youngs_modulus = of_shape * (1.0 + poissons_ratio);
    let field = if AGREEING.contains(&(youngs_modulus / e)) { "poissons_ratio" } else { "youngs_modulus" };
    let problem =
        ManifestProblem::StiffnessDisagrees { file, youngs_modulus, poissons_ratio, stated: [e, nu] };
    Err(PackageError::manifest(format!("{}/{field}", pointer(&set.name)), problem))
}

/// Refuses the mass of a set if its total and the median of its nodes are both off, to the same side. Lumping moves mass between
/// neighbouring nodes, which the total does not see; a point mass is in the total, and not in the median.
fn mass(mesh: &SectorMesh, set: usize, found: &Found, file: &str) -> Result<(), PackageError> {
    let [of_matrix, of_elements] = found.total_mass;
    let Some(median) = median(&found.mass) else { return Ok(()) };
    let total = of_matrix / of_elements;
    let beyond = |factor: f64| !AGREEING.contains(&factor);
    if !beyond(median) || !beyond(total) || (median > 1.0) != (total > 1.0) {
        return Ok(());
    }
    let file = file.to_owned();
    let Some(set) = mesh.sets.get(set) else {
        let problem = ManifestProblem::MeetingSetsDisagree { file, factor: total };
        return Err(PackageError::manifest("/mesh/sets", problem));
    };
    let stated = set.material.density;
    let problem = ManifestProblem::MassDisagrees { file, density: total * stated, stated };
    Err(PackageError::manifest(format!("{}/density", pointer(&set.name)), problem))
}

/// Ratios of every set; the last entry is for nodes where sets meet.
fn compare(sector: &SectorModel, mesh: &SectorMesh, layout: &Layout, elements: &UniformStrain) -> Vec<Found> {
    let dofs = |node: usize| {
        let rows = layout.rows_of_node[node];
        let own = |row: u32| layout.own_of_row[row as usize] as usize;
        (!rows.contains(&NONE)).then(|| rows.map(own))
    };
    let size = sector.own_dofs();
    let mut strains = [vec![0.0; size], vec![0.0; size]];
    let mut translation = vec![0.0; size];
    let along_axis = |node: usize| layout.frame.coordinates(mesh.nodes[node]);
    // A translation along the axis changes nothing, and keeps digits where the axis begins far away.
    let [_, _, origin] = along_axis(0);
    for node in (0..mesh.nodes.len()).filter(|&node| layout.low_of[node] == NONE) {
        let Some(dofs) = dofs(node) else { continue };
        let [r, theta, z] = along_axis(node);
        for (strain, moved) in strains.iter_mut().zip(displacements([r, theta, z - origin])) {
            dofs.iter().zip(moved).for_each(|(&dof, moved)| strain[dof] = moved);
        }
        translation[dofs[2]] = 1.0;
    }
    let forces = strains.map(|strain| times(&sector.stiffness[0], &strain));
    let masses = times(&sector.mass, &translation);

    let mut found: Vec<Found> = (0..=mesh.sets.len()).map(|_| Found::default()).collect();
    for (node, set) in groups(mesh, layout).into_iter().enumerate() {
        let (Some(set), Some(dofs)) = (set, dofs(node)) else { continue };
        let found = &mut found[set];
        let expected = [&elements.of_shape[node], &elements.of_volume[node]];
        for (k, shares) in [&mut found.of_shape, &mut found.of_volume].into_iter().enumerate() {
            if expected[k].norm() > IN_BALANCE * elements.unbalanced[k][node] {
                let along: f64 = (0..3).map(|d| forces[k][dofs[d]] * expected[k][d]).sum();
                shares.push(along / expected[k].norm_squared());
            }
        }
        let [of_matrix, of_elements] = [masses[dofs[2]], elements.mass[node]];
        found.mass.push(of_matrix / of_elements);
        found.total_mass[0] += of_matrix;
        found.total_mass[1] += of_elements;
    }
    found
}

/// Set of each own node whose elements have free nodes only, or the number of sets where several meet.
fn groups(mesh: &SectorMesh, layout: &Layout) -> Vec<Option<usize>> {
    let low = |node: u32| match layout.low_of[node as usize] {
        NONE => node as usize,
        low => low as usize,
    };
    let mut groups: Vec<Option<usize>> = vec![None; mesh.nodes.len()];
    let mut free = vec![true; mesh.nodes.len()];
    for element in &mesh.elements {
        let all_free = element.nodes.iter().all(|&node| !layout.rows_of_node[node as usize].contains(&NONE));
        for node in element.nodes.iter().map(|&node| low(node)) {
            free[node] &= all_free;
            let set = element.set as usize;
            let group = groups[node].get_or_insert(set);
            if *group != set {
                *group = mesh.sets.len();
            }
        }
    }
    groups.into_iter().zip(free).map(|(group, free)| group.filter(|_| free)).collect()
}

/// Product (Y0 + Y1 + Y1ᵀ) x: forces on a sector of the whole wheel if all sectors move alike.
pub(crate) fn times(matrix: &CyclicMatrix, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    let mut add = |part: &SparseColMat<usize, f64>, both: bool| {
        for entry in part.triplet_iter() {
            y[entry.row] += entry.val * x[entry.col];
            if both {
                y[entry.col] += entry.val * x[entry.row];
            }
        }
    };
    add(&matrix.own, false);
    add(&matrix.next, true);
    y
}

/// Median; of an even number of values the lower of the two in the middle.
fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    let middle = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
