//! Nodes, elements and sets of a part, or of the deck itself where it has no parts.

use std::collections::{BTreeMap, BTreeSet};

use rubmap_solid::element::ElementKind;

use super::card::{Card, normal};
use super::kinds::{DeckKind, kind};
use crate::collapse::collapsed;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, quoted, real};
use crate::mesh_file::{FileElement, MeshFile};

/// Nodes, elements and sets under numbers of their own.
#[derive(Debug, Default)]
pub(super) struct Scope {
    pub(super) nodes: BTreeMap<u64, [f64; 3]>,
    pub(super) elements: BTreeMap<u64, FileElement>,
    /// Numbers of elements that were left out, which sets may name.
    pub(super) left_out: BTreeSet<u64>,
    pub(super) node_sets: BTreeMap<String, Vec<u64>>,
    pub(super) element_sets: BTreeMap<String, BTreeSet<u64>>,
    /// Element set and material of each solid section.
    pub(super) sections: Vec<(String, String)>,
}

/// Elements in the making: the numbers of one may go on over several lines.
#[derive(Debug)]
pub(super) struct ElementBlock {
    /// Kind of the solid, or none for elements that are left out.
    kind: Option<ElementKind>,
    label: String,
    set: Option<String>,
    numbers: Vec<u64>,
    from: u64,
    /// Number of nodes of an element that is left out is unknown: a line is one, unless it ends with a comma.
    goes_on: bool,
}

impl Scope {
    /// Reads a node: number and coordinates.
    pub(super) fn node(&mut self, words: &[&str], set: Option<&str>) -> Result<(), MeshProblem> {
        let [id, coordinates @ ..] = words else { return Ok(()) };
        let id = integer(id, "a node number")?;
        let mut position = [0.0; 3];
        for (x, word) in position.iter_mut().zip(coordinates) {
            *x = if word.is_empty() { 0.0 } else { real(word, "a coordinate")? };
        }
        if self.nodes.insert(id, position).is_some() {
            return Err(MeshProblem::Twice { what: "node", id });
        }
        if let Some(set) = set {
            self.node_sets.entry(set.to_owned()).or_default().push(id);
        }
        Ok(())
    }

    /// Begins a block of elements.
    pub(super) fn elements(card: &Card, mesh: &mut MeshFile) -> Result<ElementBlock, MeshProblem> {
        let label = card.value("TYPE").unwrap_or_default();
        let kind = match kind(&label) {
            DeckKind::Solid { kind, note } => {
                if note {
                    mesh.note(format!("elements of type {label} are read as {}", kind.name()));
                }
                Some(kind)
            }
            DeckKind::LeftOut => None,
            DeckKind::Refused => {
                return Err(MeshProblem::NotCarried {
                    what: format!("an element of type \"{}\"", quoted(&label)),
                    advice: "a model has solid elements C3D4 to C3D20R only",
                });
            }
        };
        let set = card.value("ELSET");
        Ok(ElementBlock { kind, label, set, numbers: Vec::new(), from: 0, goes_on: false })
    }

    /// Reads a line of a block of elements.
    pub(super) fn element(
        &mut self,
        words: &[&str],
        block: &mut ElementBlock,
        line: u64,
        mesh: &mut MeshFile,
    ) -> Result<(), MeshProblem> {
        let Some(kind) = block.kind else {
            if !block.goes_on {
                mesh.leave_out(&block.label);
                if let Some(Ok(id)) = words.first().map(|word| integer(word, "an element number")) {
                    self.left_out.insert(id);
                }
            }
            block.goes_on = words.last().is_some_and(|word| word.is_empty());
            return Ok(());
        };
        for word in words.iter().filter(|word| !word.is_empty()) {
            if block.numbers.is_empty() {
                block.from = line;
            }
            block.numbers.push(integer(word, "an element or node number")?);
            let [id, nodes @ ..] = &block.numbers[..] else { continue };
            if nodes.len() < kind.nodes() {
                continue;
            }
            let id = *id;
            let (kind, nodes) = if kind.corners() == 8 {
                collapsed(kind, nodes).ok_or(MeshProblem::Collapsed { element: id })?
            } else {
                (kind, nodes.to_vec())
            };
            if self.elements.insert(id, FileElement { kind, nodes, line: block.from }).is_some() {
                return Err(MeshProblem::Twice { what: "element", id });
            }
            if let Some(set) = &block.set {
                self.element_sets.entry(set.clone()).or_default().insert(id);
            }
            block.numbers.clear();
        }
        Ok(())
    }

    /// Refuses a block of elements that ends in the middle of one.
    pub(super) fn end_of_elements(block: &ElementBlock) -> Result<(), MeshFileError> {
        match (&block.numbers[..], block.kind) {
            ([id, nodes @ ..], Some(kind)) => {
                let expected = format!(
                    "{} nodes of element {id}, a {}; {} are there",
                    kind.nodes(),
                    kind.name(),
                    nodes.len()
                );
                Err(MeshProblem::Expected { expected }.at(block.from, "*ELEMENT"))
            }
            _ => Ok(()),
        }
    }

    /// Reads a line of a node set.
    pub(super) fn node_set(&mut self, name: &str, generate: bool, words: &[&str]) -> Result<(), MeshProblem> {
        let numbers: Vec<u64> = if generate {
            let (first, last, step) = range(words)?;
            // Numbers without a node are skipped, so that no range can be longer than the mesh.
            self.nodes
                .range(first..=last.max(first))
                .map(|(&id, _)| id)
                .filter(|id| (id - first) % step == 0)
                .collect()
        } else {
            let mut numbers = Vec::new();
            for word in words.iter().filter(|word| !word.is_empty()) {
                match word.parse() {
                    Ok(id) => numbers.push(id),
                    Err(_) => {
                        numbers.extend(self.node_sets.get(&normal(word)).ok_or_else(|| no("node set", word))?)
                    }
                }
            }
            numbers
        };
        self.node_sets.entry(name.to_owned()).or_default().extend(numbers);
        Ok(())
    }

    /// Reads a line of an element set.
    pub(super) fn element_set(
        &mut self,
        name: &str,
        generate: bool,
        words: &[&str],
    ) -> Result<(), MeshProblem> {
        let numbers: BTreeSet<u64> = if generate {
            let (first, last, step) = range(words)?;
            let known = self.elements.range(first..=last.max(first)).map(|(&id, _)| id);
            known.filter(|id| (id - first) % step == 0).collect()
        } else {
            let mut numbers = BTreeSet::new();
            for word in words.iter().filter(|word| !word.is_empty()) {
                match word.parse::<u64>() {
                    Ok(id) => drop(numbers.insert(id)),
                    Err(_) => {
                        let set =
                            self.element_sets.get(&normal(word)).ok_or_else(|| no("element set", word))?;
                        numbers.extend(set.iter().copied());
                    }
                }
            }
            numbers
        };
        self.element_sets.entry(name.to_owned()).or_default().extend(numbers);
        Ok(())
    }

    /// Adds the nodes of an element set to a node set.
    pub(super) fn nodes_of_elements(&mut self, name: &str, elements: &str) -> Result<(), MeshProblem> {
        let set = self.element_sets.get(elements).ok_or_else(|| no("element set", elements))?;
        let nodes: BTreeSet<u64> = set
            .iter()
            .filter_map(|id| self.elements.get(id))
            .flat_map(|element| element.nodes.clone())
            .collect();
        self.node_sets.entry(name.to_owned()).or_default().extend(nodes);
        Ok(())
    }
}

fn no(what: &'static str, name: &str) -> MeshProblem {
    MeshProblem::NoSuch { what, name: quoted(name) }
}

/// First and last number of a generated range, and its step.
fn range(words: &[&str]) -> Result<(u64, u64, u64), MeshProblem> {
    let words = words.iter().filter(|word| !word.is_empty());
    let numbers: Vec<u64> = words.map(|word| integer(word, "a number")).collect::<Result<_, _>>()?;
    match numbers[..] {
        [first] => Ok((first, first, 1)),
        [first, last] => Ok((first, last, 1)),
        [first, last, step] if step > 0 => Ok((first, last, step)),
        _ => Err(MeshProblem::Expected { expected: "first number, last number, step".to_owned() }),
    }
}
