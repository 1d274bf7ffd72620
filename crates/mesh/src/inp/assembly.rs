//! Parts of a deck put together.

use std::collections::{BTreeMap, BTreeSet};

use super::scope::Scope;
use super::support::Support;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{quoted, real};
use crate::mesh_file::MeshFile;

/// Instance of a part: where it is put, and the sets of the assembly that name its nodes and elements.
#[derive(Debug)]
pub(super) struct Instance {
    pub(super) name: String,
    part: String,
    line: u64,
    translation: [f64; 3],
    /// Two points on the axis of a turn, and its angle in degrees.
    turn: Option<([[f64; 3]; 2], f64)>,
    lines: usize,
    /// Requests for generated sets, which the part's numbers answer.
    ranges: Vec<(bool, String, Vec<String>)>,
}

impl Instance {
    pub(super) fn new(name: String, part: String, line: u64) -> Self {
        let (translation, turn) = ([0.0; 3], None);
        Self { name, part, line, translation, turn, lines: 0, ranges: Vec::new() }
    }

    /// Reads the displacement of the instance, then its turn.
    pub(super) fn placed(&mut self, words: &[&str]) -> Result<(), MeshProblem> {
        let words = words.iter().filter(|word| !word.is_empty());
        let numbers: Vec<f64> = words.map(|word| real(word, "a coordinate")).collect::<Result<_, _>>()?;
        match (self.lines, &numbers[..]) {
            (0, &[x, y, z]) => self.translation = [x, y, z],
            (1, &[a, b, c, d, e, f, angle]) => self.turn = Some(([[a, b, c], [d, e, f]], angle)),
            _ => {
                let expected = "a displacement x, y, z, then two points on an axis and an angle".to_owned();
                return Err(MeshProblem::Expected { expected });
            }
        }
        self.lines += 1;
        Ok(())
    }

    /// Keeps a line of a node set until the part is known.
    pub(super) fn node_set(&mut self, name: &str, generate: bool, words: &[&str]) -> Result<(), MeshProblem> {
        self.request(true, name, generate, words);
        Ok(())
    }

    /// Keeps a line of an element set until the part is known.
    pub(super) fn element_set(
        &mut self,
        name: &str,
        generate: bool,
        words: &[&str],
    ) -> Result<(), MeshProblem> {
        self.request(false, name, generate, words);
        Ok(())
    }

    fn request(&mut self, nodes: bool, name: &str, generate: bool, words: &[&str]) {
        let mut words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
        words.insert(0, if generate { "GENERATE".to_owned() } else { String::new() });
        self.ranges.push((nodes, name.to_owned(), words));
    }

    /// Position of a node of the part.
    fn position(&self, at: [f64; 3]) -> [f64; 3] {
        let moved: [f64; 3] = std::array::from_fn(|k| at[k] + self.translation[k]);
        let Some(([from, to], degrees)) = self.turn else { return moved };
        let direction = std::array::from_fn(|k| to[k] - from[k]);
        let frame = rubmap_solid::frame::AxisFrame::new(from, direction);
        frame.map_or(moved, |frame| frame.turn_point(moved, degrees.to_radians()))
    }
}

/// Puts instances together, resolves supports, and checks that all that is named is there.
pub(super) fn assembled(
    mut mesh: MeshFile,
    mut root: Scope,
    mut parts: BTreeMap<String, Scope>,
    instances: Vec<Instance>,
    supports: &[Support],
) -> Result<MeshFile, MeshFileError> {
    if instances.is_empty() && parts.len() == 1 {
        // A deck of a single part that nothing instantiates is that part.
        if let Some((_, part)) = parts.pop_first() {
            root = part;
        }
    }
    let several = instances.len() > 1 || !root.nodes.is_empty();
    let mut whole = root;
    for mut instance in instances {
        let part = parts.get(&instance.part).ok_or_else(|| {
            MeshProblem::NoSuch { what: "part", name: quoted(&instance.part) }.at(instance.line, "*INSTANCE")
        })?;
        add(&mut whole, part, &mut instance, several)
            .map_err(|problem| problem.at(instance.line, "*INSTANCE"))?;
    }
    for (set, material) in &whole.sections {
        if !whole.element_sets.contains_key(set) {
            let name = quoted(set);
            return Err(MeshProblem::NoSuch { what: "element set", name }.at(0, "*SOLID SECTION"));
        }
        if !mesh.materials.contains_key(material) {
            let name = quoted(material);
            return Err(MeshProblem::NoSuch { what: "material", name }.at(0, "*SOLID SECTION"));
        }
    }
    mesh.held = held(&whole, supports)?;
    let known: BTreeSet<u64> = whole.elements.keys().copied().collect();
    mesh.element_sets = (whole.element_sets.into_iter())
        .map(|(name, set)| (name, set.intersection(&known).copied().collect::<BTreeSet<u64>>()))
        .filter(|(_, set)| !set.is_empty())
        .collect();
    mesh.sections =
        whole.sections.into_iter().filter(|(set, _)| mesh.element_sets.contains_key(set)).collect();
    (mesh.nodes, mesh.elements, mesh.node_sets) = (whole.nodes, whole.elements, whole.node_sets);
    mesh.node_sets.values_mut().for_each(|set| {
        let mut seen = BTreeSet::new();
        set.retain(|node| seen.insert(*node));
    });
    crate::whole::check(&mesh, "*ELEMENT")?;
    Ok(mesh)
}

/// Adds an instance of a part. Of several instances, nodes and elements get numbers of their own, and sets the instance's name.
fn add(whole: &mut Scope, part: &Scope, instance: &mut Instance, several: bool) -> Result<(), MeshProblem> {
    let mut local = Scope {
        nodes: part.nodes.clone(),
        elements: part.elements.clone(),
        node_sets: part.node_sets.clone(),
        element_sets: part.element_sets.clone(),
        ..Scope::default()
    };
    let mut of_assembly = BTreeSet::new();
    for (nodes, name, words) in std::mem::take(&mut instance.ranges) {
        let generate = words.first().is_some_and(|word| word == "GENERATE");
        let words: Vec<&str> = words.iter().skip(1).map(String::as_str).collect();
        if nodes {
            local.node_set(&name, generate, &words)?;
        } else {
            local.element_set(&name, generate, &words)?;
        }
        of_assembly.insert(name);
    }
    let offset = |most: Option<u64>| if several { most.unwrap_or(0) } else { 0 };
    let after_nodes = offset(whole.nodes.last_key_value().map(|(&id, _)| id));
    let after_elements = offset(whole.elements.last_key_value().map(|(&id, _)| id));
    let named = |name: &String| {
        if several && !of_assembly.contains(name) {
            format!("{}.{name}", instance.name)
        } else {
            name.clone()
        }
    };
    whole.nodes.extend(local.nodes.iter().map(|(id, &at)| (id + after_nodes, instance.position(at))));
    for (id, element) in &local.elements {
        let mut element = element.clone();
        element.nodes.iter_mut().for_each(|node| *node += after_nodes);
        whole.elements.insert(id + after_elements, element);
    }
    for (name, set) in &local.node_sets {
        let set = set.iter().map(|node| node + after_nodes);
        whole.node_sets.entry(named(name)).or_default().extend(set);
    }
    for (name, set) in &local.element_sets {
        let set = set.iter().map(|id| id + after_elements);
        whole.element_sets.entry(named(name)).or_default().extend(set);
    }
    whole.sections.extend(part.sections.iter().map(|(set, material)| (named(set), material.clone())));
    Ok(())
}

/// Nodes of which all three displacements are held.
fn held(whole: &Scope, supports: &[Support]) -> Result<BTreeSet<u64>, MeshFileError> {
    let mut components: BTreeMap<u64, ([bool; 3], u64)> = BTreeMap::new();
    for support in supports {
        // Of a single instance the name may stand before the set or node.
        let target = &support.target;
        let plain = target.rsplit_once('.').map_or(target.as_str(), |(_, plain)| plain);
        let set = whole.node_sets.get(target).or_else(|| whole.node_sets.get(plain));
        let nodes = match (set, plain.parse()) {
            (Some(set), _) => set.clone(),
            (None, Ok(node)) => vec![node],
            (None, Err(_)) => {
                let name = quoted(target);
                return Err(MeshProblem::NoSuch { what: "node set", name }.at(support.line, "*BOUNDARY"));
            }
        };
        for node in nodes {
            let (held, _) = components.entry(node).or_insert(([false; 3], support.line));
            (0..3).for_each(|k| held[k] |= support.components[k]);
        }
    }
    match components.iter().find(|(_, (held, _))| *held != [true; 3]) {
        None => Ok(components.into_keys().collect()),
        Some((node, (held, line))) => {
            let directions: Vec<String> = (0..3).filter(|&k| held[k]).map(|k| (k + 1).to_string()).collect();
            let what = format!("a support of node {node} in direction {} alone", directions.join(", "));
            let advice = "a clamp holds all three displacements; clamp a surface, or leave the support out";
            Err(MeshProblem::NotCarried { what, advice }.at(*line, "*BOUNDARY"))
        }
    }
}
