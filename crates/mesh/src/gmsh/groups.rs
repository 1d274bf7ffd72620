//! Physical groups on their way to sets.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashSet};

use crate::mesh_file::MeshFile;

/// Physical group: numbers count apart in each dimension.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Group {
    /// Dimension of its entities.
    pub(super) dimension: u64,
    /// Number in that dimension.
    pub(super) number: u64,
}

/// Names and members of all physical groups.
#[derive(Default)]
pub(super) struct Groups {
    names: BTreeMap<Group, String>,
    members: BTreeMap<Group, Members>,
}

/// Nodes and solid elements of a group.
#[derive(Default)]
struct Members {
    nodes: Vec<u64>,
    known: HashSet<u64>,
    solids: BTreeSet<u64>,
}

impl Members {
    fn add_nodes(&mut self, nodes: &[u64]) {
        self.nodes.extend(nodes.iter().filter(|&&node| self.known.insert(node)));
    }

    fn join(&mut self, other: Self) {
        self.add_nodes(&other.nodes);
        self.solids.extend(other.solids);
    }
}

impl Groups {
    /// Names a group.
    pub(super) fn name(&mut self, group: Group, name: &str) {
        self.names.insert(group, name.to_owned());
    }

    /// Adds the nodes of an element to a group.
    pub(super) fn add_nodes(&mut self, group: Group, nodes: &[u64]) {
        self.members.entry(group).or_default().add_nodes(nodes);
    }

    /// Adds a solid element to a group; whether it was not there.
    pub(super) fn add_solid(&mut self, group: Group, element: u64) -> bool {
        self.members.entry(group).or_default().solids.insert(element)
    }

    /// Number of groups that have solid elements.
    pub(super) fn of_solids(&self) -> usize {
        self.members.values().filter(|members| !members.solids.is_empty()).count()
    }

    /// Groups of each solid element that has any.
    pub(super) fn by_solid(&self) -> BTreeMap<u64, BTreeSet<Group>> {
        let mut found: BTreeMap<u64, BTreeSet<Group>> = BTreeMap::new();
        for (&group, members) in &self.members {
            members.solids.iter().for_each(|&solid| {
                found.entry(solid).or_default().insert(group);
            });
        }
        found
    }

    /// Replaces a solid element of a group by another.
    pub(super) fn replace(&mut self, group: Group, element: u64, by: u64) {
        let solids = &mut self.members.entry(group).or_default().solids;
        solids.remove(&element);
        solids.insert(by);
    }

    /// Adds the sets to a mesh. Groups of one name are one set. A group without a name goes by its number, with the word for its dimension
    /// where another group goes by that number, too.
    pub(super) fn into_sets(self, mesh: &mut MeshFile) {
        let Self { names, members } = self;
        let plain = |group: &Group| names.get(group).cloned().unwrap_or_else(|| group.number.to_string());
        let mut uses: BTreeMap<String, usize> = BTreeMap::new();
        members.keys().for_each(|group| *uses.entry(plain(group)).or_default() += 1);
        let mut sets: BTreeMap<String, Members> = BTreeMap::new();
        for (group, members) in members {
            let mut name = plain(&group);
            if !names.contains_key(&group) && uses.get(&name).is_some_and(|&uses| uses > 1) {
                name = format!("{} {}", word(group.dimension), group.number);
                mesh.note(NAMED_BY_WORD.to_owned());
            }
            match sets.entry(name) {
                Entry::Vacant(place) => {
                    place.insert(members);
                }
                Entry::Occupied(mut place) => place.get_mut().join(members),
            }
        }
        for (name, Members { nodes, solids, .. }) in sets {
            if !solids.is_empty() {
                mesh.element_sets.insert(name.clone(), solids);
            }
            mesh.node_sets.insert(name, nodes);
        }
    }
}

/// Note on groups that share a number.
const NAMED_BY_WORD: &str = "physical groups without a name that share a number go by their dimension, too, \
                             such as \"surface 1\" and \"volume 1\"";

/// Word for entities of a dimension.
fn word(dimension: u64) -> &'static str {
    match dimension {
        0 => "point",
        1 => "curve",
        2 => "surface",
        _ => "volume",
    }
}
