//! Matrix files of other programs: mass and stiffness of a sector, as Abaqus, Nastran and Ansys write them.
//!
//! ```text
//! bytes ── format (recognised by content) ── reader of that format ──▶ raw ── rows kept ── triangles folded ──▶ FileMatrix
//! ```
//!
//! Rows are displacements of nodes. A row that cannot be one is left out with a note if it acts on none, and refused otherwise. Formats
//! whose rows have numbers only (OUTPUT4, Matrix Market, Harwell–Boeing, Abaqus's COORDINATE) need a mapping: lines of row, node and degree
//! of freedom, such as `1 5 UX` or `1, 5, 1`.

mod abaqus;
mod boeing;
mod choice;
mod dmig;
mod dmig_fields;
mod dof;
mod file_matrix;
mod fold;
mod fortran;
mod kept;
mod mapping;
mod market;
mod op4;
mod op4_binary;
mod op4_columns;
mod op4_header;
mod raw;
mod recognise;
#[cfg(test)]
mod tests;

use crate::error::{MeshFileError, MeshProblem};

pub use file_matrix::{FileMatrix, MatrixRow};
pub use recognise::MatrixFormat;

/// Whether a file is of a format of matrices that can be read here.
pub(crate) fn is_matrix(bytes: &[u8]) -> bool {
    recognise::recognised(bytes).is_ok()
}

/// Reads the only matrix of a file. A mapping is asked for where rows have numbers only; one that is not needed is left out with a note.
///
/// # Errors
/// [`MeshFileError`] with the line of an entry that cannot be read or carried over.
pub fn read(bytes: &[u8], mapping: Option<&[u8]>) -> Result<FileMatrix, MeshFileError> {
    read_named(bytes, mapping, None)
}

/// Reads a matrix of a file by its name, as DMIG entries and OUTPUT4 have them; files of other formats hold one matrix, whatever its name.
///
/// # Errors
/// [`MeshFileError`] with the line of an entry that cannot be read or carried over, with the names if there are several and none is asked
/// for.
pub fn read_named(
    bytes: &[u8],
    mapping: Option<&[u8]>,
    name: Option<&str>,
) -> Result<FileMatrix, MeshFileError> {
    let format = recognise::recognised(bytes)?;
    let needed = |found, advice| mapping.ok_or_else(|| MeshProblem::NotAMesh { found, advice }.at(0, ""));
    let named = |raw, format| {
        let mut matrix = kept::finished(raw, format)?;
        if mapping.is_some() {
            matrix.notes.push("Mapping not read: the matrix names its nodes itself.".to_owned());
        }
        Ok(matrix)
    };
    match format {
        MatrixFormat::AbaqusLabels => named(abaqus::read_labels(bytes)?, abaqus::FORMAT),
        MatrixFormat::Dmig => named(dmig::read(bytes, name)?, dmig::FORMAT),
        MatrixFormat::AbaqusCoordinates => {
            let mapping = needed(
                "a matrix of Abaqus in FORMAT=COORDINATE, whose rows name no nodes",
                "write it in FORMAT=MATRIX INPUT or LABELS, or add a mapping: lines of row, node and component",
            )?;
            kept::finished(abaqus::read_coordinates(bytes, mapping)?, abaqus::FORMAT)
        }
        MatrixFormat::Coordinates => {
            let mapping = needed(
                "a matrix whose rows name no nodes",
                "from CalculiX (.sti, .mas) give it with its .dof file and its deck; from Abaqus write it in FORMAT=MATRIX INPUT; \
                 from elsewhere add a mapping: lines of row, node and component",
            )?;
            kept::finished(abaqus::read_coordinates(bytes, mapping)?, abaqus::FORMAT)
        }
        MatrixFormat::Op4 => {
            let mapping = needed(
                "an OUTPUT4 file of Nastran, whose rows name no nodes",
                "write DMIG entries (EXTSEOUT with DMIGPCH), or add a mapping: lines of row, node and component",
            )?;
            kept::finished(op4::read(bytes, mapping, name)?, op4_header::FORMAT)
        }
        MatrixFormat::Market => {
            let mapping = needed(
                "a Matrix Market file, whose rows name no nodes",
                "add a mapping: lines of row, node and degree of freedom, such as 1 5 UX; or make a package with sector.json of it",
            )?;
            kept::finished(market::read(bytes, mapping)?, market::FORMAT)
        }
        MatrixFormat::Boeing => {
            let mapping = needed(
                "a Harwell-Boeing file, whose rows name no nodes",
                "add the mapping file that HBMAT writes with Mapping=YES: lines of row, node and degree of freedom, such as 1 5 UX",
            )?;
            kept::finished(boeing::read(bytes, mapping)?, boeing::FORMAT)
        }
    }
}
