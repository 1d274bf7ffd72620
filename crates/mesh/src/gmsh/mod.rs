//! Gmsh's MSH files, versions 2.2 and 4.1, ASCII and little-endian binary.
//!
//! ```text
//! $MeshFormat ─ $PhysicalNames ─ $Entities (4.1) ─ $Nodes ─ $Elements      others are skipped
//! ```
//!
//! A physical group of any dimension is a node set of all nodes of its elements, a group of volumes an element set, too. Materials are no
//! part of the format.

mod elements;
mod entities;
mod groups;
mod header;
mod nodes;
mod repeated;
mod shapes;
mod source;
#[cfg(test)]
mod tests;

use crate::error::{MeshFileError, MeshProblem};
use crate::format::MeshFormat;
use crate::mesh_file::MeshFile;

use elements::Elements;
use header::Version;
use source::Source;

/// Reads a mesh.
///
/// # Errors
/// Place and reason if the file is damaged or has what a model cannot carry over.
pub(crate) fn read(bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let mut source = Source::new(bytes);
    let version = header::read(&mut source)?;
    let mut mesh = MeshFile::new(MeshFormat::Gmsh);
    let mut found = Elements::default();
    let mut complete = false;
    while let Some(section) = source.section() {
        match (section.as_str(), version) {
            ("PhysicalNames", _) => entities::names(&mut source, &mut found.groups)?,
            ("Entities", Version::Four) => found.entities = entities::read(&mut source)?,
            ("Nodes", Version::Two) => nodes::version_2(&mut source, &mut mesh)?,
            ("Nodes", Version::Four) => nodes::version_4(&mut source, &mut mesh)?,
            ("Elements", _) => {
                found.read(&mut source, version, &mut mesh)?;
                complete = true;
            }
            ("ParametricNodes", _) => return Err(source.error(parametric())),
            ("PartitionedEntities", _) => {
                mesh.note(PARTITIONED.to_owned());
                source.skip()?;
            }
            _ => source.skip()?,
        }
    }
    if !complete {
        return Err(MeshProblem::CutShort { expected: "$Elements".to_owned() }.at(source.line(), ""));
    }
    if version == Version::Two {
        repeated::unite(&mut found.groups, &mut mesh);
    }
    found.groups.into_sets(&mut mesh);
    crate::whole::check(&mesh, "$Elements")?;
    Ok(mesh)
}

/// Note on a mesh of several partitions.
const PARTITIONED: &str = "the mesh is partitioned: physical groups of the partitions are not read; \
                           save it without partitions if sets are missing";

/// Refusal of nodes with parameters in version 2.2.
fn parametric() -> MeshProblem {
    MeshProblem::NotCarried {
        what: "a list of nodes with parametric coordinates".to_owned(),
        advice: "save the mesh with Mesh.SaveParametric=0",
    }
}
