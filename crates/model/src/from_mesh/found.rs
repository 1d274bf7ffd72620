//! Findings about a mesh, for the user to compare with what they know.

use std::collections::BTreeMap;
use std::fmt;

use rubmap_mesh::MeshFile;
use rubmap_solid::element::ElementKind;
use rubmap_solid::mesh::SectorMesh;

use super::clamp::ClampSource;
use super::contact_points::Contact;
use super::cyclic::Symmetry;
use super::settings::MeshSettings;
use super::tip::{Tip, TipSource};
use crate::package::calculix::ContactPoint;

/// Note about an axis that was found away from x, y and z through the origin.
const AXIS_FOUND: &str = "the axis was found from the cyclic faces; its direction is the one whose largest component is positive, and rotation \
                          is positive about it: give `axis` the other way round for a wheel that turns against it";

/// Findings about a mesh: what was read, what was found, and what the user should know.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Name of the file's format.
    pub format: &'static str,
    /// Number of nodes of the body.
    pub nodes: usize,
    /// Number of elements by kind.
    pub elements: BTreeMap<&'static str, usize>,
    /// Elements that were left out, by type.
    pub left_out: BTreeMap<String, usize>,
    /// Number of sectors.
    pub sectors: usize,
    /// Whether the number of sectors was found, not stated.
    pub sectors_found: bool,
    /// Point on the axis of rotation, and its direction.
    pub axis: [[f64; 3]; 2],
    /// Number of pairs of nodes on the cyclic faces.
    pub pairs: usize,
    /// Largest distance of a turned low node from its high node.
    pub farthest: f64,
    /// Source of the clamp, and number of clamped nodes.
    pub clamp: (ClampSource, usize),
    /// Source of the contact line, and number of its usable nodes.
    pub tip: (TipSource, usize),
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<ContactPoint>,
    /// Least and largest distance between neighbouring contact nodes.
    pub spacing: [f64; 2],
    /// Element sets with their Young's modulus, Poisson's ratio and density.
    pub materials: Vec<(String, [f64; 3])>,
    /// Sentences that the user should know of.
    pub notes: Vec<String>,
}

impl Found {
    /// Findings of all steps; the clamp with the number of its nodes.
    pub(super) fn of(
        file: &MeshFile,
        settings: &MeshSettings,
        mesh: &SectorMesh,
        symmetry: &Symmetry,
        clamp: (ClampSource, usize),
        tip: Tip,
        contact: &Contact,
    ) -> Self {
        let mut elements: BTreeMap<&'static str, usize> = BTreeMap::new();
        for element in &mesh.elements {
            *elements.entry(element.kind.name()).or_default() += 1;
        }
        let mut notes = file.notes.clone();
        notes.extend(locking(mesh));
        if symmetry.axis_found {
            notes.push(AXIS_FOUND.to_owned());
        }
        notes.extend(tip.notes);
        let constants = |set: &rubmap_solid::mesh::ElementSet| {
            let material = &set.material;
            (set.name.clone(), [material.youngs_modulus, material.poissons_ratio, material.density])
        };
        Self {
            format: file.format.name(),
            nodes: mesh.nodes.len(),
            elements,
            left_out: file.left_out.clone(),
            sectors: symmetry.sectors,
            sectors_found: settings.sectors.is_none() && file.symmetry.is_none(),
            axis: [mesh.axis.0, mesh.axis.1],
            pairs: symmetry.pairs.len(),
            farthest: symmetry.farthest,
            clamp,
            tip: (tip.source, contact.of_line),
            contact: contact.points.clone(),
            spacing: contact.spacing,
            materials: mesh.sets.iter().map(constants).collect(),
            notes,
        }
    }
}

/// Warning about elements that are too stiff in bending.
fn locking(mesh: &SectorMesh) -> Option<String> {
    let stiff = |kind: ElementKind| {
        matches!(kind, ElementKind::C3D4 | ElementKind::C3D5 | ElementKind::C3D6 | ElementKind::C3D8)
    };
    let count = mesh.elements.iter().filter(|element| stiff(element.kind)).count();
    // Single pyramids and wedges between better elements do no harm.
    (10 * count > mesh.elements.len()).then(|| {
        format!(
            "{count} of {} elements are linear tetrahedra, pyramids, wedges or fully integrated linear hexahedra, which are too stiff in \
             bending: frequencies of thin blades may come out too high by a tenth to several times; use quadratic elements",
            mesh.elements.len()
        )
    })
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds: Vec<String> =
            self.elements.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
        writeln!(f, "{}: {} nodes, {}", self.format, self.nodes, kinds.join(", "))?;
        for (kind, count) in &self.left_out {
            writeln!(f, "left out: {count} of type {kind}")?;
        }
        for (set, [e, nu, rho]) in &self.materials {
            writeln!(f, "material of {set}: E = {e}, ν = {nu}, ρ = {rho:?}")?;
        }
        let [origin, direction] = self.axis.map(|v| v.map(|x| x.to_string()).join(", "));
        writeln!(f, "axis: through ({origin}) along ({direction})")?;
        let how = if self.sectors_found { "found" } else { "as stated" };
        write!(f, "sectors: {} ({how})", self.sectors)?;
        match self.pairs {
            0 => writeln!(f, ", no cyclic faces")?,
            pairs => writeln!(
                f,
                "; {pairs} pairs of nodes on the cyclic faces, at most {:.1e} apart",
                self.farthest
            )?,
        }
        let (clamp, count) = &self.clamp;
        match clamp {
            ClampSource::Set(name) => writeln!(f, "clamp: {count} nodes of the set {name}")?,
            ClampSource::File => writeln!(f, "clamp: {count} nodes, as the file holds them")?,
            ClampSource::Bore(radius) => {
                writeln!(f, "clamp: {count} nodes of the bore found at r = {}", digits(*radius))?
            }
        }
        let (tip, count) = &self.tip;
        match tip {
            TipSource::Line(name) => write!(f, "contact: line of {count} nodes of the set {name}")?,
            TipSource::Area(name) => write!(f, "contact: {count} nodes in the middle of the set {name}")?,
            TipSource::Edge([a, b]) => {
                write!(f, "contact: {count} nodes along the edge from node {a} to node {b}")?
            }
            TipSource::Shroud([least, most]) => write!(
                f,
                "contact: {count} nodes in the middle of the tip along the shroud curve, {} to {} away from it",
                digits(*least),
                digits(*most)
            )?,
            TipSource::Found(tips) => {
                write!(f, "contact: {count} nodes in the middle of the longest of {tips} blade tips found")?;
            }
        }
        let [least, most] = self.spacing;
        writeln!(f, "; {} used, {} to {} apart", self.contact.len(), digits(least), digits(most))?;
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        Ok(())
    }
}

/// Number with five significant digits.
fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.4e}").parse().unwrap_or(x);
    format!("{rounded:?}")
}
