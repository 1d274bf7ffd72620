//! Formats of matrix files, recognised by their content.

use crate::error::{MeshFileError, MeshProblem};
use crate::{fields, format};

use super::op4_binary;
use super::op4_header::Header;
use crate::lines::{Lines, words};

/// Format of a matrix file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatrixFormat {
    /// Abaqus: rows and columns by node and component.
    AbaqusLabels,
    /// Rows and columns by number, separated by commas.
    AbaqusCoordinates,
    /// Rows and columns by number, separated by blanks: of Abaqus or of CalculiX.
    Coordinates,
    /// DMIG entries of Nastran.
    Dmig,
    /// OUTPUT4 of Nastran, text or binary.
    Op4,
    /// Matrix Market, as Ansys writes it.
    Market,
    /// Harwell–Boeing, as Ansys writes it.
    Boeing,
}

impl MatrixFormat {
    /// Every format.
    pub const ALL: [Self; 7] = [
        Self::AbaqusLabels,
        Self::AbaqusCoordinates,
        Self::Coordinates,
        Self::Dmig,
        Self::Op4,
        Self::Market,
        Self::Boeing,
    ];
}

/// Format of a file.
///
/// # Errors
/// [`MeshProblem::NotAMesh`] for a file of another known kind, [`MeshProblem::UnknownMatrix`] for all others.
pub(super) fn recognised(bytes: &[u8]) -> Result<MatrixFormat, MeshFileError> {
    if op4_binary::is_binary(bytes) {
        return Ok(MatrixFormat::Op4);
    }
    let mut first: Vec<String> = Vec::new();
    first.extend(Lines::new(bytes).take(4).map(|(_, line)| line.trim_end().chars().take(200).collect()));
    let line = |index: usize| first.get(index).map(String::as_str).unwrap_or_default();
    if line(0).to_ascii_uppercase().starts_with("%%MATRIXMARKET") {
        return Ok(MatrixFormat::Market);
    }
    let integers =
        |line: &str| !line.is_empty() && line.split_whitespace().all(|word| word.parse::<u64>().is_ok());
    if line(3).trim_start().starts_with('(') && integers(line(1)) {
        return Ok(MatrixFormat::Boeing);
    }
    if line(0).len() > 32 && Header::parsed(line(0)).is_ok() {
        return Ok(MatrixFormat::Op4);
    }
    if let Some(format) = by_first_entry(bytes) {
        return Ok(format);
    }
    if Lines::new(bytes).any(|(_, line)| line.get(..4).is_some_and(|card| card.eq_ignore_ascii_case("DMIG")))
    {
        return Ok(MatrixFormat::Dmig);
    }
    Err(other(bytes).at(0, ""))
}

/// Format by the first line that is no comment and no header of Abaqus.
fn by_first_entry(bytes: &[u8]) -> Option<MatrixFormat> {
    let keyword =
        |line: &str| line.trim_start().get(..7).is_some_and(|word| word.eq_ignore_ascii_case("*MATRIX"));
    let skipped = |line: &str| line.trim().is_empty() || line.trim_start().starts_with("**");
    let mut lines = Lines::new(bytes).filter(|(_, line)| !skipped(line)).peekable();
    let header = lines.next_if(|(_, line)| keyword(line)).is_some();
    let (_, line) = lines.next()?;
    let numbers = words(&line).all(|word| fields::real(word, "a number").is_ok());
    match words(&line).count() {
        3 if numbers && line.contains(',') => Some(MatrixFormat::AbaqusCoordinates),
        3 if numbers => Some(MatrixFormat::Coordinates),
        5 if numbers => Some(MatrixFormat::AbaqusLabels),
        _ => header.then_some(MatrixFormat::AbaqusLabels),
    }
}

/// Refusal of a file that is no matrix of a known format.
fn other(bytes: &[u8]) -> MeshProblem {
    // The length of the header in the order of bytes of other machines, or with integers of eight bytes.
    if bytes.starts_with(&[0, 0, 0, 24])
        || bytes.starts_with(&[48, 0, 0, 0])
        || bytes.starts_with(&[0, 0, 0, 48])
    {
        return MeshProblem::NotAMesh {
            found: "a binary file of a big-endian program, or of one with integers of eight bytes",
            advice: "write an OUTPUT4 file in text form: ASSIGN OUTPUT4='…',FORMATTED",
        };
    }
    let begins =
        |line: &str, word: &str| line.get(..word.len()).is_some_and(|l| l.eq_ignore_ascii_case(word));
    if Lines::new(bytes).take(100).any(|(_, line)| begins(&line, "*USER ELEMENT")) {
        return MeshProblem::NotAMesh {
            found: "the matrix of a substructure or an element of Abaqus",
            advice: "write the global matrices by *MATRIX GENERATE and *MATRIX OUTPUT, FORMAT=MATRIX INPUT",
        };
    }
    match format::recognised(bytes) {
        Ok(mesh) => MeshProblem::NotAMesh {
            found: match mesh {
                format::MeshFormat::Inp => "a CalculiX or Abaqus deck",
                format::MeshFormat::Gmsh => "a Gmsh mesh",
                format::MeshFormat::Nastran => "Nastran bulk data without a DMIG entry",
                format::MeshFormat::Ansys => "an Ansys archive",
                format::MeshFormat::Vtu => "a VTK unstructured grid",
            },
            advice: "it belongs in the place of the mesh; a matrix is in a file of its own",
        },
        Err(_) => MeshProblem::UnknownMatrix,
    }
}
