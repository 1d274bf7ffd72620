//! Findings about a mesh, for the user to compare with what they know.

use std::collections::BTreeMap;
use std::fmt;

use rubmap_mesh::MeshFile;
use rubmap_solid::element::ElementKind;
use rubmap_solid::mesh::{ElementSet, SectorMesh};

use super::clamp::ClampSource;
use super::contact_points::Contact;
use super::cyclic::Symmetry;
use super::settings::MeshSettings;
use super::tip::{Tip, TipSource};
use crate::package::calculix::ContactPoint;

/// Note about an axis that was found away from x, y and z through the origin.
pub(super) const AXIS_FOUND: &str = "the axis was found from the cyclic faces; its direction is the one whose largest component is positive, and rotation \
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
    /// Number of free nodes on the axis, which all sectors share.
    pub on_axis: usize,
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
    /// Findings of all steps; the clamp with a mark for each node that it holds.
    pub(super) fn of(
        file: &MeshFile,
        settings: &MeshSettings,
        mesh: &SectorMesh,
        symmetry: &Symmetry,
        (clamp, clamped): (ClampSource, &[bool]),
        tip: Tip,
        contact: &Contact,
    ) -> Self {
        let elements = kinds(mesh);
        let mut notes = file.notes.clone();
        notes.extend(locking(mesh));
        if symmetry.axis_found {
            notes.push(AXIS_FOUND.to_owned());
        }
        notes.extend(tip.notes);
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
            on_axis: on_axis(mesh, clamped),
            clamp: (clamp, clamped.iter().filter(|&&held| held).count()),
            tip: (tip.source, contact.of_line),
            contact: contact.points.clone(),
            spacing: contact.spacing,
            materials: mesh.sets.iter().map(|set| (set.name.clone(), constants(set))).collect(),
            notes,
        }
    }
}

/// Number of elements by kind.
pub(super) fn kinds(mesh: &SectorMesh) -> BTreeMap<&'static str, usize> {
    let mut kinds = BTreeMap::new();
    for element in &mesh.elements {
        *kinds.entry(element.kind.name()).or_default() += 1;
    }
    kinds
}

/// Warning about elements that are too stiff in bending.
pub(super) fn locking(mesh: &SectorMesh) -> Option<String> {
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
        writeln!(f, "{}", body_line(self.format, self.nodes, &self.elements))?;
        for (kind, count) in &self.left_out {
            writeln!(f, "{}", left_out_line(kind, *count))?;
        }
        for (set, constants) in &self.materials {
            writeln!(f, "{}", material_line(set, *constants))?;
        }
        writeln!(f, "{}", axis_line(self.axis))?;
        writeln!(f, "{}", sectors_line(self.sectors, self.sectors_found, self.pairs, self.farthest))?;
        if let Some(line) = on_axis_line(self.on_axis) {
            writeln!(f, "{line}")?;
        }
        let (clamp, count) = &self.clamp;
        writeln!(f, "{}", clamp_line(clamp, *count))?;
        let (tip, count) = &self.tip;
        writeln!(f, "{}", contact_line(tip, *count, self.contact.len(), self.spacing))?;
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        Ok(())
    }
}

/// Line about the body: format, number of nodes, elements by kind.
pub(super) fn body_line(format: &str, nodes: usize, elements: &BTreeMap<&'static str, usize>) -> String {
    let kinds: Vec<String> = elements.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    format!("{format}: {nodes} nodes, {}", kinds.join(", "))
}

/// Line about elements that were left out.
pub(super) fn left_out_line(kind: &str, count: usize) -> String {
    format!("left out: {count} of type {kind}")
}

/// Young's modulus, Poisson's ratio and density of an element set.
pub(super) fn constants(set: &ElementSet) -> [f64; 3] {
    [set.material.youngs_modulus, set.material.poissons_ratio, set.material.density]
}

/// Line about the material of an element set.
pub(super) fn material_line(set: &str, [e, nu, rho]: [f64; 3]) -> String {
    format!("material of {set}: E = {e}, ν = {nu}, ρ = {rho:?}")
}

/// Line about the axis of rotation: a point on it, and its direction.
pub(super) fn axis_line(axis: [[f64; 3]; 2]) -> String {
    let [origin, direction] = axis.map(|v| v.map(|x| x.to_string()).join(", "));
    format!("axis: through ({origin}) along ({direction})")
}

/// Line about the cyclic faces.
pub(super) fn sectors_line(sectors: usize, found: bool, pairs: usize, farthest: f64) -> String {
    let how = if found { "found" } else { "as stated" };
    let faces = match pairs {
        0 => ", no cyclic faces".to_owned(),
        pairs => format!("; {pairs} pairs of nodes on the cyclic faces, at most {farthest:.1e} apart"),
    };
    format!("sectors: {sectors} ({how}){faces}")
}

/// Number of free nodes on the axis of several sectors.
pub(super) fn on_axis(mesh: &SectorMesh, clamped: &[bool]) -> usize {
    mesh.on_axis().iter().zip(clamped).filter(|(on_axis, held)| **on_axis && !**held).count()
}

/// Line about free nodes on the axis, if there are any.
pub(super) fn on_axis_line(count: usize) -> Option<String> {
    (count > 0).then(|| format!("axis: {count} free nodes on it, shared by all sectors"))
}

/// Line about the clamp.
pub(super) fn clamp_line(source: &ClampSource, count: usize) -> String {
    let what = match source {
        ClampSource::Set(name) => format!("nodes of the set {name}"),
        ClampSource::File => return format!("clamp: {count} nodes, as the file holds them"),
        ClampSource::Bore(radius) => format!("nodes of the bore found at r = {}", digits(*radius)),
        ClampSource::Patches(nodes) => format!("nodes of the patches at {}", named(nodes)),
    };
    format!("clamp: {count} {what}")
}

/// Line about the contact nodes: usable ones, those used, and the distances between neighbours.
pub(super) fn contact_line(source: &TipSource, count: usize, used: usize, spacing: [f64; 2]) -> String {
    let what = match source {
        TipSource::Line(name) => format!("line of {count} nodes of the set {name}"),
        TipSource::Area(name) => format!("{count} nodes in the middle of the set {name}"),
        TipSource::Edge([a, b]) => format!("{count} nodes along the edge from node {a} to node {b}"),
        TipSource::Patch(nodes) => format!("{count} nodes in the middle of the patch at {}", named(nodes)),
        TipSource::Shroud([least, most]) => format!(
            "{count} nodes in the middle of the tip along the shroud curve, {} to {} away from it",
            digits(*least),
            digits(*most)
        ),
        TipSource::Found(tips) => {
            format!("{count} nodes in the middle of the longest of {tips} blade tips found")
        }
    };
    let [least, most] = spacing.map(digits);
    format!("contact: {what}; {used} used, {least} to {most} apart")
}

/// Nodes by their numbers.
fn named(nodes: &[u64]) -> String {
    let numbers: Vec<String> = nodes.iter().map(u64::to_string).collect();
    format!("node{} {}", if nodes.len() > 1 { "s" } else { "" }, numbers.join(", "))
}

/// Number with five significant digits.
fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.4e}").parse().unwrap_or(x);
    format!("{rounded:?}")
}
