//! SPC, SPC1 and SPCADD: nodes that are held, after all cards that hold a node are taken together.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::MeshFile;

use super::card::Card;
use super::components;
use super::place::Place;

/// Support of a range of nodes.
pub(super) struct Support {
    /// Set of supports; none of a permanent one.
    pub(super) set: Option<u64>,
    /// First and last number.
    pub(super) nodes: [u64; 2],
    /// Displacements that are held.
    pub(super) mask: u8,
    /// Whether they are held elsewhere than at zero.
    pub(super) moved: bool,
    /// Name of the card.
    pub(super) card: &'static str,
    /// Place of the card.
    pub(super) place: Place,
}

/// All supports of a file.
#[derive(Default)]
pub(super) struct Supports {
    all: Vec<Support>,
    unions: BTreeMap<u64, Vec<u64>>,
}

impl Supports {
    /// Adds a support.
    pub(super) fn add(&mut self, support: Support) {
        if support.mask != 0 {
            self.all.push(support);
        }
    }

    /// Adds an SPC.
    pub(super) fn add_values(&mut self, card: &Card) -> Result<(), MeshFileError> {
        let set = Some(card.integer(1, "the number of a set of supports")?);
        for first in [2, 5] {
            if first == 2 || !card.text(first).is_empty() {
                let node = card.integer(first, "a node number")?;
                let mask = components::mask(card, first + 1)?;
                let moved = card.real(first + 2, "a displacement")?.is_some_and(|value| value != 0.0);
                let place = card.place.clone();
                self.add(Support { set, nodes: [node, node], mask, moved, card: "SPC", place });
            }
        }
        Ok(())
    }

    /// Adds an SPC1.
    pub(super) fn add_nodes(&mut self, card: &Card) -> Result<(), MeshFileError> {
        let set = Some(card.integer(1, "the number of a set of supports")?);
        let mask = components::mask(card, 2)?;
        let words: Vec<&str> = card.fields.iter().skip(2).map(String::as_str).collect();
        let ranges = super::sets::ranges(&words)
            .filter(|ranges| !ranges.is_empty())
            .ok_or_else(|| card.expected("node numbers, or two with THRU between them"))?;
        for nodes in ranges {
            let place = card.place.clone();
            self.add(Support { set, nodes, mask, moved: false, card: "SPC1", place });
        }
        Ok(())
    }

    /// Adds an SPCADD.
    pub(super) fn add_union(&mut self, card: &Card) -> Result<(), MeshFileError> {
        let expected = "the number of a set of supports";
        let union = self.unions.entry(card.integer(1, expected)?).or_default();
        for field in 2..=card.fields.len() {
            union.extend(card.optional(field, expected)?);
        }
        Ok(())
    }

    /// Holds the nodes of a mesh by permanent supports and those of the `selected` sets, or of all sets if none is selected.
    pub(super) fn hold(mut self, selected: &BTreeSet<u64>, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
        let sets: BTreeSet<u64> = self.all.iter().filter_map(|support| support.set).collect();
        if sets.len() > 1 && selected.len() != 1 {
            mesh.note("supports of several SPC sets are taken together".to_owned());
        }
        if !selected.is_empty() {
            let members = selected.iter().filter_map(|set| self.unions.get(set)).flatten();
            let active: BTreeSet<u64> = members.chain(selected).copied().collect();
            self.all.retain(|support| support.set.is_none_or(|set| active.contains(&set)));
        }
        self.check(mesh)?;
        let mut masks: BTreeMap<u64, u8> = BTreeMap::new();
        for bit in [0b001, 0b010, 0b100] {
            for [from, to] in self.united(bit) {
                mesh.nodes.range(from..=to).for_each(|(&node, _)| *masks.entry(node).or_default() |= bit);
            }
        }
        let partly = |mask: u8| mask != components::ALL;
        let in_part: BTreeSet<u64> =
            masks.iter().filter(|&(_, &mask)| partly(mask)).map(|(&node, _)| node).collect();
        self.refuse(&in_part, mesh)?;
        mesh.held = masks.into_keys().filter(|node| !in_part.contains(node)).collect();
        Ok(())
    }

    /// Refuses nodes that are moved or not there.
    fn check(&self, mesh: &MeshFile) -> Result<(), MeshFileError> {
        for Support { nodes: [from, to], moved, card, place, .. } in &self.all {
            if *moved {
                let what = "a displacement that is not zero".to_owned();
                let advice = "a sector is held at rest: take it out";
                return Err(place.error(MeshProblem::NotCarried { what, advice }, card));
            }
            if from == to && !mesh.nodes.contains_key(from) {
                let problem = MeshProblem::NoSuch { what: "node", name: from.to_string() };
                return Err(place.error(problem, card));
            }
        }
        Ok(())
    }

    /// Ranges of nodes of which a displacement is held, in order and apart.
    fn united(&self, bit: u8) -> Vec<[u64; 2]> {
        let mut ranges: Vec<[u64; 2]> =
            self.all.iter().filter(|support| support.mask & bit != 0).map(|support| support.nodes).collect();
        ranges.sort_unstable();
        let mut united: Vec<[u64; 2]> = Vec::new();
        for [from, to] in ranges {
            match united.last_mut() {
                Some([_, end]) if from <= *end => *end = to.max(*end),
                _ => united.push([from, to]),
            }
        }
        united
    }

    /// Refuses nodes of solid elements that are held in some directions only.
    fn refuse(&self, in_part: &BTreeSet<u64>, mesh: &MeshFile) -> Result<(), MeshFileError> {
        if in_part.is_empty() {
            return Ok(());
        }
        let mut nodes = mesh.elements.values().flat_map(|element| &element.nodes);
        let Some(node) = nodes.find(|node| in_part.contains(node)) else { return Ok(()) };
        let holds = |support: &&Support| (support.nodes[0]..=support.nodes[1]).contains(node);
        let (place, card) = match self.all.iter().find(holds) {
            Some(support) => (support.place.clone(), support.card),
            None => (Place::default(), ""),
        };
        let what = format!("the support of node {node} in some directions only");
        let advice = "hold all three displacements (123) of a node, or none";
        Err(place.error(MeshProblem::NotCarried { what, advice }, card))
    }
}
