//! Formats of mesh files, recognised by their content.

use crate::error::{MeshFileError, MeshProblem};

/// Format of a mesh file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshFormat {
    /// Deck of CalculiX or Abaqus.
    Inp,
    /// Gmsh's MSH, version 2.2 or 4.1.
    Gmsh,
    /// Bulk data of Nastran.
    Nastran,
    /// Archive of Ansys, as CDWRITE makes it.
    Ansys,
    /// Unstructured grid of VTK in XML.
    Vtu,
}

impl MeshFormat {
    /// Every format.
    pub const ALL: [Self; 5] = [Self::Inp, Self::Gmsh, Self::Nastran, Self::Ansys, Self::Vtu];

    /// Name of the format.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inp => "CalculiX or Abaqus deck",
            Self::Gmsh => "Gmsh mesh",
            Self::Nastran => "Nastran bulk data",
            Self::Ansys => "Ansys archive",
            Self::Vtu => "VTK unstructured grid",
        }
    }
}

/// Number of lines at the beginning of a file by which its format is recognised.
const LINES: usize = 400;

/// Format of a file.
///
/// # Errors
/// [`MeshProblem::NotAMesh`] for a file of another known kind, [`MeshProblem::Unknown`] for all others.
pub fn recognised(bytes: &[u8]) -> Result<MeshFormat, MeshFileError> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let lines = text.split(|&b| b == b'\n').take(LINES);
    let lines: Vec<String> = lines
        .map(|line| String::from_utf8_lossy(&line[..line.len().min(200)]).trim().to_uppercase())
        .collect();
    for (begins, found, advice) in OTHERS {
        if lines.first().is_some_and(|line| line.starts_with(begins)) {
            return Err(MeshProblem::NotAMesh { found, advice }.at(0, ""));
        }
    }
    let any = |test: &dyn Fn(&str) -> bool| lines.iter().any(|line| test(line));
    if lines.first().is_some_and(|line| line.starts_with("$MESHFORMAT")) {
        return Ok(MeshFormat::Gmsh);
    }
    // The whole file may stand on the line of the XML declaration.
    if any(&|line| line.starts_with("<VTKFILE") || line.starts_with("<?XML") && line.contains("<VTKFILE")) {
        return Ok(MeshFormat::Vtu);
    }
    if any(&|line| line.starts_with("NBLOCK") || line.starts_with("/PREP7") || line.starts_with("/COM,ANSYS"))
    {
        return Ok(MeshFormat::Ansys);
    }
    if any(&|line| INP.iter().any(|card| line.starts_with(card))) {
        return Ok(MeshFormat::Inp);
    }
    if any(&|line| NASTRAN.iter().any(|card| line.starts_with(card))) {
        return Ok(MeshFormat::Nastran);
    }
    Err(MeshProblem::Unknown.at(0, ""))
}

/// Cards by which a deck of CalculiX or Abaqus is recognised.
const INP: [&str; 6] = ["*NODE", "*HEADING", "*PART", "*INCLUDE", "*ELEMENT", "*ASSEMBLY"];

/// Cards by which bulk data of Nastran are recognised.
const NASTRAN: [&str; 7] = ["BEGIN BULK", "BEGIN,BULK", "GRID", "CTETRA", "CHEXA", "SOL ", "CEND"];

/// Beginnings of files that are no meshes, what they are, and the way to go with them.
const OTHERS: [(&str, &str, &str); 7] = [
    (
        "%%MATRIXMARKET",
        "a Matrix Market file",
        "give it to `rubmap import matrices` beside the mesh, or in a package with sector.json (docs/package.md)",
    ),
    ("\u{89}HDF", "an HDF5 file", "export the mesh as .inp, .msh, .bdf, .cdb or .vtu"),
    ("PK", "a zip archive", "a package has sector.json in it"),
    ("SOLID", "an STL surface", "a model needs volume elements: mesh the solid first"),
    ("ISO-10303", "STEP geometry", "mesh it first, with Gmsh for example (docs)"),
    ("# VTK DATAFILE", "a legacy VTK file", "save it as .vtu"),
    ("{", "JSON", "a mesh is .inp, .msh, .bdf, .cdb or .vtu"),
];
