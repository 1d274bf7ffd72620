//! Archives of Ansys, as CDWRITE makes them in its blocked form.
//!
//! Materials are named by their numbers; the elements of material 1 are the set `MAT1`. Rotations of nodes, loads and all that belongs to a
//! solution are no part of a mesh; constraints between nodes, contact, springs and masses are refused.

mod columns;
mod command;
mod components;
mod eblock;
mod etype;
mod listed;
mod materials;
mod nblock;
mod properties;
mod solids;
mod supports;
mod table;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use crate::lines::Lines;
use command::Fields;
use components::Component;
use eblock::Raw;
use etype::ElementTypes;
use properties::Properties;
use supports::Supports;

use crate::error::{MeshFileError, MeshProblem};
use crate::format::MeshFormat;
use crate::mesh_file::MeshFile;

/// Reads an archive.
///
/// # Errors
/// [`MeshFileError`] with the line and the command at fault.
pub(crate) fn read(bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let mut archive = Archive {
        mesh: MeshFile::new(MeshFormat::Ansys),
        elements: Vec::new(),
        types: ElementTypes::default(),
        components: Vec::new(),
        properties: Properties::default(),
        supports: Supports::default(),
    };
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.bytes() {
        archive.command(&String::from_utf8_lossy(line), &mut lines)?;
    }
    archive.finish()
}

/// Content of an archive that is being read.
struct Archive {
    mesh: MeshFile,
    elements: Vec<Raw>,
    types: ElementTypes,
    components: Vec<Component>,
    properties: Properties,
    supports: Supports,
}

impl Archive {
    /// Takes a command, with the block of lines behind it.
    fn command(&mut self, text: &str, lines: &mut Lines) -> Result<(), MeshFileError> {
        if text.trim_start().starts_with(['!', '/', '*']) {
            return Ok(());
        }
        let fields = Fields::of(text);
        let (name, line) = (fields.upper(0), lines.number());
        match name.as_str() {
            "NBLOCK" => return nblock::read(lines, &mut self.mesh),
            "EBLOCK" => return eblock::read(lines, &fields, &mut self.elements),
            "ETBLOCK" => return self.types.block(lines),
            "CMBLOCK" => {
                self.components.push(components::read(lines, &fields)?);
                return Ok(());
            }
            "ET" => self.types.define(&fields),
            "KEYOP" | "KEYOPT" => self.types.option(&fields),
            "MPTEMP" => self.properties.temperatures(&fields),
            "MPDATA" => self.properties.data(&fields, line),
            "MP" => self.properties.constant(&fields, line),
            "TB" => self.properties.model(&fields, line),
            "D" => self.supports.add(&fields, line),
            _ => self.other(&name, &fields),
        }
        .map_err(|problem| problem.at(line, &name))
    }

    /// Refuses commands that a model cannot do without, notes loads and passes over the rest.
    fn other(&mut self, name: &str, fields: &Fields) -> Result<(), MeshProblem> {
        let (what, advice) = match name {
            // The end of an unblocked list has the number -1.
            "N" | "EN" | "E" if fields.get(3) != "-1" => (
                format!("a node or an element of its own ({name})"),
                "write the archive in blocked form: CDWRITE,DB,name,cdb,,,,BLOCKED",
            ),
            "CE" | "CERIG" | "CEINTF" | "CECYC" | "RBE3" => (
                format!("a constraint equation ({name})"),
                "merge the parts' nodes into one mesh, then delete the equations (CEDELE)",
            ),
            "CP" | "CPINTF" | "CPNGEN" | "CPLGEN" | "CPCYC" => (
                format!("a set of coupled displacements ({name})"),
                "merge the parts' nodes into one mesh, then delete the sets (CPDELE)",
            ),
            "F" | "SF" | "SFE" | "BF" | "BFE" => {
                self.mesh.note(format!("loads ({name}) are no part of a mesh: they are left out"));
                return Ok(());
            }
            _ => return Ok(()),
        };
        Err(MeshProblem::NotCarried { what, advice })
    }

    /// Mesh of all that was read.
    fn finish(mut self) -> Result<MeshFile, MeshFileError> {
        solids::place(&self.elements, &self.types, &mut self.mesh)?;
        crate::whole::check(&self.mesh, eblock::CARD)?;
        components::place(self.components, &mut self.mesh);
        self.supports.place(&mut self.mesh)?;
        let mut by_material: BTreeMap<u64, BTreeSet<u64>> = BTreeMap::new();
        let solid = |raw: &&Raw| self.mesh.elements.get(&raw.id).is_some_and(|found| found.line == raw.line);
        for raw in self.elements.iter().filter(solid) {
            by_material.entry(raw.material).or_default().insert(raw.id);
        }
        let used = by_material.keys().copied().collect();
        materials::place(&self.properties, &used, &mut self.mesh)?;
        for (number, elements) in by_material {
            let name = free_name(&self.mesh, number);
            if self.mesh.materials.contains_key(&number.to_string()) {
                self.mesh.sections.push((name.clone(), number.to_string()));
            }
            self.mesh.element_sets.insert(name, elements);
        }
        Ok(self.mesh)
    }
}

/// Name of the set of a material's elements, which no component has.
fn free_name(mesh: &MeshFile, material: u64) -> String {
    let mut name = format!("MAT{material}");
    while mesh.element_sets.contains_key(&name) {
        name.push('_');
    }
    name
}
