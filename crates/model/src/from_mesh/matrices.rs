//! Package of a mesh with the matrices of another program.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use rubmap_mesh::MeshFile;
use rubmap_mesh::matrices::{FileMatrix, MatrixRow};

use super::error::FromMeshError;
use super::found::Found;
use super::sector::sector;
use super::settings::MeshSettings;
use crate::package::gyroscopic_of_mass;
use crate::package::raw::{Axis, RawDof, RawMatrix, RawPackage};
use rubmap_solid::frame::AxisFrame;

/// Matrices of a sector as another program wrote them, Cartesian.
#[derive(Debug)]
pub struct FileMatrices {
    /// Mass matrix.
    pub mass: FileMatrix,
    /// Stiffness matrices with their speeds in rad/s, ascending from 0: one or three.
    pub stiffness: Vec<(f64, FileMatrix)>,
}

/// Package of a mesh and its matrices. Axis, sectors, cyclic faces and contact line come from the mesh; nodes without rows are clamped.
///
/// # Errors
/// Matrices whose rows do not fit each other or the mesh; errors of [`sector`].
pub fn package_with_matrices(
    mut file: MeshFile,
    settings: &MeshSettings,
    matrices: &FileMatrices,
) -> Result<(RawPackage, Found), FromMeshError> {
    if settings.clamp_set.is_some() || !settings.clamp_at.is_empty() {
        return Err(FromMeshError::ClampBesideMatrices);
    }
    if let Some((line, card)) = file.nodal_frames.clone() {
        return Err(FromMeshError::NodalFrames { line, card });
    }
    let all = || std::iter::once(&matrices.mass).chain(matrices.stiffness.iter().map(|(_, matrix)| matrix));
    let clamped: BTreeSet<MatrixRow> = all().flat_map(|matrix| matrix.clamped.iter().copied()).collect();
    let rows_of = |matrix: &FileMatrix| -> BTreeSet<MatrixRow> {
        matrix.rows.iter().filter(|row| !clamped.contains(row)).copied().collect()
    };
    let rows = rows_of(&matrices.mass);
    for (_, matrix) in &matrices.stiffness {
        if let Some(row) = rows_of(matrix).symmetric_difference(&rows).next() {
            return Err(FromMeshError::RowsDiffer { node: row.node, component: row.component });
        }
    }
    if let Some(row) = rows.iter().find(|row| !file.nodes.contains_key(&row.node)) {
        return Err(FromMeshError::RowWithoutNode { node: row.node, component: row.component });
    }
    let free: BTreeSet<u64> = rows.iter().map(|row| row.node).collect();
    let of_elements = file.elements.values().flat_map(|element| element.nodes.clone());
    file.held = of_elements.filter(|node| !free.contains(node)).collect();
    if file.held.is_empty() {
        return Err(FromMeshError::NothingHeld);
    }
    for matrix in all() {
        matrix.notes.iter().for_each(|note| file.note(format!("{}: {note}", matrix.format)));
    }
    let made = sector(&file, settings)?;
    let half = |&[low, high]: &[u64; 2]| free.contains(&low) != free.contains(&high);
    if let Some([low, high]) = made.pairs().find(half) {
        return Err(FromMeshError::HalfHeld { low, high });
    }
    let dofs: Vec<RawDof> =
        rows.iter().map(|row| RawDof { node: row.node, component: row.component }).collect();
    let place: HashMap<MatrixRow, u32> = rows.iter().copied().zip(0..).collect();
    let raw = |matrix: &FileMatrix| {
        let at = |row: u32| matrix.rows.get(row as usize).and_then(|row| place.get(row)).copied();
        let mut sums: BTreeMap<(u32, u32), f64> = BTreeMap::new();
        for &(row, column, value) in &matrix.entries {
            if let (Some(row), Some(column)) = (at(row), at(column)) {
                *sums.entry((row.min(column), row.max(column))).or_default() += value;
            }
        }
        let entries = sums.into_iter().map(|((column, row), value)| (row, column, value)).collect();
        RawMatrix { size: dofs.len(), entries }
    };
    let mut package = made.without_matrices();
    let Axis { origin, direction } = package.manifest.axis.clone();
    let axis = AxisFrame::new(origin, direction).ok_or(FromMeshError::AxisWithoutDirection)?;
    package.mass = raw(&matrices.mass);
    package.gyroscopic = settings.gyroscopic.then(|| gyroscopic_of_mass(&package.mass, &dofs, &axis));
    package.stiffness = matrices.stiffness.iter().map(|(_, matrix)| raw(matrix)).collect();
    package.manifest.speeds_rad_s = matrices.stiffness.iter().map(|(speed, _)| *speed).collect();
    package.manifest.stiffness = (0..package.stiffness.len()).map(|k| format!("k{k}.npz")).collect();
    package.dofs = dofs;
    Ok((package, made.found))
}
