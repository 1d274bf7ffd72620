//! SET of case control and SET1: sets of nodes, where all their numbers are those of nodes.

use std::collections::HashSet;

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::MeshFile;

use super::place::Place;

/// Most nodes of all sets together: a few bytes name as many nodes as the file has.
const MOST: usize = 20_000_000;

/// Set as the file states it.
struct Stated {
    id: u64,
    ranges: Vec<[u64; 2]>,
    card: &'static str,
    place: Place,
}

/// All sets of a file.
#[derive(Default)]
pub(super) struct Sets {
    sets: Vec<Stated>,
    has_exceptions: bool,
}

/// Ranges of numbers out of words such as `3`, `5 THRU 9`; empty words are passed over. None if there are other words.
pub(super) fn ranges(words: &[&str]) -> Option<Vec<[u64; 2]>> {
    let mut words = words.iter().filter(|word| !word.is_empty()).peekable();
    let mut ranges = Vec::new();
    while let Some(word) = words.next() {
        let from = word.parse().ok()?;
        let mut to = from;
        if words.next_if(|word| word.eq_ignore_ascii_case("THRU")).is_some() {
            to = words.next()?.parse().ok()?;
        }
        if to < from {
            return None;
        }
        ranges.push([from, to]);
    }
    Some(ranges)
}

impl Sets {
    /// Adds a set of these words. One that is no list of numbers, such as ALL or a list of frequencies, is none of nodes.
    pub(super) fn add(&mut self, id: u64, words: &[&str], card: &'static str, place: &Place) {
        match ranges(words) {
            Some(ranges) => self.sets.push(Stated { id, ranges, card, place: place.clone() }),
            None if words.iter().any(|word| ["EXCEPT", "BY"].contains(word)) => {
                self.has_exceptions = true;
            }
            None => {}
        }
    }

    /// Adds the sets of nodes to a mesh.
    pub(super) fn add_to(self, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
        if self.has_exceptions {
            mesh.note("sets with EXCEPT or BY are not read".to_owned());
        }
        let mut left = MOST;
        for set in self.sets {
            let name = set.id.to_string();
            if mesh.node_sets.contains_key(&name) {
                mesh.note("of several sets of one number the first is taken".to_owned());
                continue;
            }
            let nodes = set.nodes(mesh, &mut left)?;
            if let Some(nodes) = nodes.filter(|nodes| !nodes.is_empty()) {
                mesh.node_sets.insert(name, nodes);
            }
        }
        Ok(())
    }
}

impl Stated {
    /// Nodes in the order of the set; none if a number is that of no node.
    fn nodes(&self, mesh: &MeshFile, left: &mut usize) -> Result<Option<Vec<u64>>, MeshFileError> {
        let mut nodes = Vec::new();
        let mut known = HashSet::new();
        for &[from, to] in &self.ranges {
            let before = nodes.len();
            for (&node, _) in mesh.nodes.range(from..=to) {
                let Some(rest) = left.checked_sub(1) else {
                    let expected = format!("no more than {MOST} nodes in all sets");
                    return Err(self.place.error(MeshProblem::Expected { expected }, self.card));
                };
                *left = rest;
                if known.insert(node) {
                    nodes.push(node);
                }
            }
            if nodes.len() == before && mesh.nodes.range(from..=to).next().is_none() {
                return Ok(None);
            }
        }
        Ok(Some(nodes))
    }
}
