//! Content of a mesh file, in the same terms for all formats.

use std::collections::{BTreeMap, BTreeSet};

use rubmap_solid::element::ElementKind;

use crate::format::MeshFormat;

/// Mesh of solid elements, with its sets, materials and supports.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    /// Format of the file.
    pub format: MeshFormat,
    /// Cartesian positions by node number.
    pub nodes: BTreeMap<u64, [f64; 3]>,
    /// Solid elements by number. Collapsed hexahedra are wedges, pyramids or tetrahedra here.
    pub elements: BTreeMap<u64, FileElement>,
    /// Node sets by name, each node once, in the order of the file.
    pub node_sets: BTreeMap<String, Vec<u64>>,
    /// Element sets by name: numbers of solid elements.
    pub element_sets: BTreeMap<String, BTreeSet<u64>>,
    /// Materials by name.
    pub materials: BTreeMap<String, FileMaterial>,
    /// Element set and material of each section, where the file assigns materials.
    pub sections: Vec<(String, String)>,
    /// Nodes of which the file holds all three displacements at zero.
    pub held: BTreeSet<u64>,
    /// Line and card of the first node with a frame of its own, if there is one: its rows in matrices are not in x, y, z. Positions are all
    /// the same in x, y, z here.
    pub nodal_frames: Option<(u64, String)>,
    /// Cyclic symmetry, if the file states one.
    pub symmetry: Option<StatedSymmetry>,
    /// Elements that were left out (points, lines and surfaces): number by name of the type.
    pub left_out: BTreeMap<String, usize>,
    /// Substitutions that the user should know of, such as an element type read as another, each a sentence, each once.
    pub notes: Vec<String>,
}

/// Solid element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileElement {
    /// Kind of the element.
    pub kind: ElementKind,
    /// Numbers of its nodes in CalculiX's order: corners, then the nodes on the edges.
    pub nodes: Vec<u64>,
    /// Line of the file on which the element begins, from 1; 0 where the format has no lines.
    pub line: u64,
}

/// Isotropic material, as far as the file states it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileMaterial {
    /// Elastic constants, one row per temperature.
    pub elastic: Vec<ElasticRow>,
    /// Density, one row per temperature.
    pub density: Vec<DensityRow>,
}

/// Elastic constants at a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticRow {
    /// Young's modulus E.
    pub youngs_modulus: f64,
    /// Poisson's ratio ν.
    pub poissons_ratio: f64,
    /// Temperature, if the file states one.
    pub temperature: Option<f64>,
}

/// Density at a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DensityRow {
    /// Mass density ρ.
    pub density: f64,
    /// Temperature, if the file states one.
    pub temperature: Option<f64>,
}

/// Cyclic symmetry as a file states it.
#[derive(Debug, Clone, PartialEq)]
pub struct StatedSymmetry {
    /// Number of sectors N.
    pub sectors: usize,
    /// Two points on the axis of rotation.
    pub axis: [[f64; 3]; 2],
}

impl MeshFile {
    /// Mesh without content.
    pub fn new(format: MeshFormat) -> Self {
        Self {
            format,
            nodes: BTreeMap::new(),
            elements: BTreeMap::new(),
            node_sets: BTreeMap::new(),
            element_sets: BTreeMap::new(),
            materials: BTreeMap::new(),
            sections: Vec::new(),
            held: BTreeSet::new(),
            nodal_frames: None,
            symmetry: None,
            left_out: BTreeMap::new(),
            notes: Vec::new(),
        }
    }

    /// Counts an element that is left out.
    pub fn leave_out(&mut self, kind: &str) {
        *self.left_out.entry(kind.to_owned()).or_default() += 1;
    }

    /// Elements that were left out, as ` (left out: 38 of type S4)`; empty if none were.
    pub(crate) fn left_out_said(&self) -> String {
        let each = self.left_out.iter().map(|(kind, count)| format!("{count} of type {kind}"));
        let each: Vec<String> = each.collect();
        if each.is_empty() { String::new() } else { format!(" (left out: {})", each.join(", ")) }
    }

    /// Adds a note, unless it is there already.
    pub fn note(&mut self, note: String) {
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }
}
