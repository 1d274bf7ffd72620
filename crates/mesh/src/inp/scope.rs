//! Nodes, elements and sets of a part, or of the deck itself where it has no parts.

use std::collections::{BTreeMap, BTreeSet};

use rubmap_solid::element::ElementKind;

use super::card::{Card, normal};
use super::kinds::{DeckKind, kind};
use super::node_set::NodeSet;
use super::work::Work;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, quoted, real};
use crate::mesh_file::{FileElement, MeshFile};
use crate::solids;

/// Nodes, elements and sets under numbers of their own.
#[derive(Debug, Default)]
pub(super) struct Scope {
    pub(super) nodes: BTreeMap<u64, [f64; 3]>,
    pub(super) elements: BTreeMap<u64, FileElement>,
    /// Numbers of elements that were left out, which sets may name.
    pub(super) left_out: BTreeSet<u64>,
    pub(super) node_sets: BTreeMap<String, NodeSet>,
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
            self.node_sets.entry(set.to_owned()).or_default().insert(id);
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
            let element = solids::element(id, kind, nodes, block.from)?;
            if self.elements.insert(id, element).is_some() {
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
    pub(super) fn node_set(
        &mut self,
        name: &str,
        generate: bool,
        words: &[&str],
        work: &mut Work,
    ) -> Result<(), MeshProblem> {
        let known = self.node_sets.remove(name);
        let is_known = known.is_some();
        let mut set = known.unwrap_or_default();
        if generate {
            // Numbers without a node are skipped, so that no range can be longer than the mesh.
            range(words)?.of(&self.nodes, work, |id| set.insert(id))?;
        } else {
            for word in words.iter().filter(|word| !word.is_empty()) {
                match member(word)? {
                    Member::Number(id) => set.insert(id),
                    Member::Set(other) if is_known && other == name => {}
                    Member::Set(other) => {
                        let other = self.node_sets.get(&other).ok_or_else(|| no("node set", word))?;
                        work.take(other.len())?;
                        set.extend(other.nodes().iter().copied());
                    }
                }
            }
        }
        self.node_sets.insert(name.to_owned(), set);
        Ok(())
    }

    /// Reads a line of an element set.
    pub(super) fn element_set(
        &mut self,
        name: &str,
        generate: bool,
        words: &[&str],
        work: &mut Work,
    ) -> Result<(), MeshProblem> {
        let known = self.element_sets.remove(name);
        let is_known = known.is_some();
        let mut set = known.unwrap_or_default();
        if generate {
            range(words)?.of(&self.elements, work, |id| {
                set.insert(id);
            })?;
        } else {
            for word in words.iter().filter(|word| !word.is_empty()) {
                match member(word)? {
                    Member::Number(id) => drop(set.insert(id)),
                    Member::Set(other) if is_known && other == name => {}
                    Member::Set(other) => {
                        let other = self.element_sets.get(&other).ok_or_else(|| no("element set", word))?;
                        work.take(other.len())?;
                        set.extend(other.iter().copied());
                    }
                }
            }
        }
        self.element_sets.insert(name.to_owned(), set);
        Ok(())
    }

    /// Adds the nodes of an element set to a node set, in rising order.
    pub(super) fn nodes_of_elements(
        &mut self,
        name: &str,
        elements: &str,
        work: &mut Work,
    ) -> Result<(), MeshProblem> {
        let set = self.element_sets.get(elements).ok_or_else(|| no("element set", elements))?;
        work.take(set.len())?;
        let mut nodes = BTreeSet::new();
        for element in set.iter().filter_map(|id| self.elements.get(id)) {
            work.take(element.nodes.len())?;
            nodes.extend(element.nodes.iter().copied());
        }
        self.node_sets.entry(name.to_owned()).or_default().extend(nodes);
        Ok(())
    }
}

fn no(what: &'static str, name: &str) -> MeshProblem {
    MeshProblem::NoSuch { what, name: quoted(name) }
}

/// Entry of a set: a number, or the name of another set in its normal form.
enum Member {
    Number(u64),
    Set(String),
}

/// Entry of a set by its word. Digits are a number, which is refused where it is too large.
fn member(word: &str) -> Result<Member, MeshProblem> {
    let digits = word.strip_prefix('+').unwrap_or(word);
    if !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return integer(word, "a number of a set").map(Member::Number);
    }
    Ok(Member::Set(normal(word)))
}

/// Generated range of numbers.
struct Range {
    first: u64,
    last: u64,
    step: u64,
}

impl Range {
    /// Gives each number of the range that a map has.
    fn of<T>(
        &self,
        known: &BTreeMap<u64, T>,
        work: &mut Work,
        mut each: impl FnMut(u64),
    ) -> Result<(), MeshProblem> {
        for &id in known.range(self.first..=self.last.max(self.first)).map(|(id, _)| id) {
            work.take(1)?;
            if (id - self.first).is_multiple_of(self.step) {
                each(id);
            }
        }
        Ok(())
    }
}

/// Range of a line: first number, last number and step.
fn range(words: &[&str]) -> Result<Range, MeshProblem> {
    let words = words.iter().filter(|word| !word.is_empty());
    let numbers: Vec<u64> = words.map(|word| integer(word, "a number")).collect::<Result<_, _>>()?;
    match numbers[..] {
        [first] => Ok(Range { first, last: first, step: 1 }),
        [first, last] => Ok(Range { first, last, step: 1 }),
        [first, last, step] if step > 0 => Ok(Range { first, last, step }),
        _ => Err(MeshProblem::Expected { expected: "first number, last number, step".to_owned() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scope of ten nodes and an element set of one tetrahedron, with a set `A` of all nodes.
    fn scope() -> Scope {
        let mut scope = Scope::default();
        for id in 1..=10 {
            scope.node(&[&id.to_string()], Some("A")).unwrap();
        }
        let element = FileElement { kind: ElementKind::C3D4, nodes: vec![1, 2, 3, 4], line: 1 };
        scope.elements.insert(1, element);
        scope.element_set("E", false, &["1"], &mut Work::default()).unwrap();
        scope
    }

    #[test]
    fn sets_keep_each_node_once() {
        let (mut scope, mut work) = (scope(), Work::default());
        for _ in 0..3 {
            scope.node_set("A", false, &["A", "A", "3"], &mut work).unwrap();
            scope.node_set("A", true, &["1", "10"], &mut work).unwrap();
            scope.element_set("E", false, &["E", "1"], &mut work).unwrap();
        }
        assert_eq!(scope.node_sets["A"].nodes(), (1..=10).collect::<Vec<u64>>());
        assert_eq!(scope.element_sets["E"], [1].into());
    }

    #[test]
    fn sets_and_ranges_have_a_bound_in_all() {
        let mut scope = scope();
        for (count, name, generate, words) in
            [(10, "B", false, ["A", ""]), (10, "B", true, ["1", "99"]), (1, "F", false, ["E", ""])]
        {
            let mut work = Work::of(2 * count);
            let mut line = || match name {
                "F" => scope.element_set(name, generate, &words, &mut work),
                _ => scope.node_set(name, generate, &words, &mut work),
            };
            assert_eq!((line(), line()), (Ok(()), Ok(())));
            assert!(line().unwrap_err().to_string().contains("more than 100000000 numbers"));
        }
        let mut work = Work::of(9);
        assert_eq!(scope.nodes_of_elements("N", "E", &mut work), Ok(()));
        assert!(scope.nodes_of_elements("N", "E", &mut work).is_err());
    }

    #[test]
    fn numbers_of_sets_have_a_limit() {
        let (mut scope, mut work) = (scope(), Work::default());
        let message = scope.node_set("B", false, &["18446744073709551615"], &mut work).unwrap_err();
        assert_eq!(message.to_string(), "\"18446744073709551615\" is not a number of a set");
        assert!(scope.element_set("B", false, &["1000000000000001"], &mut work).is_err());
        assert!(scope.element_set("B", false, &["1000000000000000"], &mut work).is_ok());
    }
}
