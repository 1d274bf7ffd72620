//! Rows that are kept: displacements of nodes. All others are left out with a note, or refused where they matter.

use crate::error::{MeshFileError, MeshProblem};

use super::dof::{Dof, DofKind};
use super::file_matrix::{FileMatrix, MatrixRow};
use super::fold;
use super::raw::{RawEntry, RawMatrix};

/// Diagonal from which a row is a clamped one: Abaqus writes 1e36, in few digits where it has to.
const CLAMPED: f64 = 0.999e36;

/// Fate of a row.
#[derive(Clone, Copy)]
enum Fate {
    /// Row of the result, with its number there.
    Kept(u32),
    /// Row that is clamped in the file.
    Clamped,
    Rotation,
    Abstract,
}

/// Matrix of the rows that are kept.
pub(super) fn finished(raw: RawMatrix, format: &'static str) -> Result<FileMatrix, MeshFileError> {
    let (rows, fates) = fates(&raw);
    if rows.is_empty() {
        let expected = "rows of nodes in x, y or z".to_owned();
        return Err(MeshProblem::Expected { expected }.at(0, format));
    }
    let entries = raw.entries.into_iter();
    let entries = entries.filter_map(|entry| kept(&raw.dofs, &fates, entry, format).transpose());
    let entries = entries.collect::<Result<Vec<RawEntry>, _>>()?;
    let entries = fold::lower(&rows, entries, raw.triangles, format)?;
    let mut clamped: Vec<MatrixRow> = Vec::new();
    let (mut rotations, mut abstracts) = (0, 0);
    for (dof, fate) in raw.dofs.iter().zip(&fates) {
        match (fate, dof.kind()) {
            (Fate::Clamped, DofKind::Translation(row)) => clamped.push(row),
            (Fate::Rotation, _) => rotations += 1,
            (Fate::Abstract, _) => abstracts += 1,
            _ => {}
        }
    }
    clamped.sort_unstable();
    let notes = [
        (clamped.len(), "clamped (1e36 on the diagonal)"),
        (rotations, "rotations without any entry but zero"),
        (abstracts, "of internal nodes, scalar points or other fields, which act on no displacement"),
    ];
    let notes = notes.into_iter().filter(|(count, _)| *count > 0);
    let notes = notes.map(|(count, which)| format!("Rows left out: {count}, {which}.")).collect();
    Ok(FileMatrix { format, rows, entries, clamped, notes })
}

/// Rows that are kept, sorted, and the fates of all.
fn fates(raw: &RawMatrix) -> (Vec<MatrixRow>, Vec<Fate>) {
    let mut fates: Vec<Fate> = Vec::with_capacity(raw.dofs.len());
    let mut kept: Vec<(MatrixRow, usize)> = Vec::new();
    for (index, dof) in raw.dofs.iter().enumerate() {
        fates.push(match dof.kind() {
            DofKind::Rotation => Fate::Rotation,
            // Displacements become clamped or kept rows below.
            DofKind::Translation(_) | DofKind::Abstract => Fate::Abstract,
        });
        if let DofKind::Translation(row) = dof.kind() {
            kept.push((row, index));
        }
    }
    let mut clamped = vec![false; raw.dofs.len()];
    for entry in raw.entries.iter().filter(|entry| entry.row == entry.column && raw.marks_clamped) {
        if let (true, Some(clamped)) = (entry.value >= CLAMPED, clamped.get_mut(entry.row as usize)) {
            *clamped = true;
        }
    }
    kept.retain(|(_, index)| !clamped.get(*index).copied().unwrap_or_default());
    kept.sort_unstable();
    for (fate, _) in fates.iter_mut().zip(&clamped).filter(|(_, clamped)| **clamped) {
        *fate = Fate::Clamped;
    }
    for ((_, index), number) in kept.iter().zip(0..) {
        if let Some(fate) = fates.get_mut(*index) {
            *fate = Fate::Kept(number);
        }
    }
    (kept.into_iter().map(|(row, _)| row).collect(), fates)
}

/// Entry between kept rows, in their numbers; nothing of one that may be left out.
fn kept(
    dofs: &[Dof],
    fates: &[Fate],
    entry: RawEntry,
    format: &str,
) -> Result<Option<RawEntry>, MeshFileError> {
    let of = |row: u32| Some((fates.get(row as usize)?, dofs.get(row as usize)?));
    let (Some((row, row_dof)), Some((column, column_dof))) = (of(entry.row), of(entry.column)) else {
        return Ok(None);
    };
    let refused = |what: String, advice| {
        Err(MeshProblem::NotCarried { what, advice }.at(u64::from(entry.line), format))
    };
    let rotation = |dof: &Dof| {
        let advice = "rows are displacements in x, y and z only; model the sector in solid elements";
        refused(format!("the rotation {dof}"), advice)
    };
    match (row, column) {
        (Fate::Kept(row), Fate::Kept(column)) => Ok(Some(RawEntry { row: *row, column: *column, ..entry })),
        (Fate::Clamped, _) | (_, Fate::Clamped) => Ok(None),
        _ if entry.value == 0.0 => Ok(None),
        (Fate::Rotation, _) => rotation(row_dof),
        (_, Fate::Rotation) => rotation(column_dof),
        (Fate::Abstract, Fate::Abstract) => Ok(None),
        _ => refused(
            format!("the coupling of {row_dof} with {column_dof}"),
            "each row must be a displacement of a node; take out what makes the program add unknowns of its own \
             (contact, ties, couplings, hybrid elements, modal coordinates)",
        ),
    }
}
