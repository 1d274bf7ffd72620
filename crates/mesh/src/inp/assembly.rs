//! Parts of a deck put together.

use std::collections::{BTreeMap, BTreeSet};

use super::instance::Instance;
use super::scope::Scope;
use super::support::Support;
use super::work::Work;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{LARGEST, integer, quoted};
use crate::mesh_file::MeshFile;

/// Most nodes and elements of an assembly, taken together.
const MOST: usize = 20_000_000;

/// Numbers as which a set or section counts besides its own.
const OF_EACH_SET: usize = 64;

/// Puts instances together, resolves supports, and checks that all that is named is there.
pub(super) fn assembled(
    mut mesh: MeshFile,
    mut root: Scope,
    mut parts: BTreeMap<String, Scope>,
    instances: Vec<Instance>,
    supports: &[Support],
    work: &mut Work,
) -> Result<MeshFile, MeshFileError> {
    if instances.is_empty() && parts.len() == 1 {
        // A deck of a single part that nothing instantiates is that part.
        if let Some((_, part)) = parts.pop_first() {
            root = part;
        }
    }
    let several = instances.len() > 1 || !root.nodes.is_empty();
    let mut whole = root;
    for instance in &instances {
        let part = parts.get(&instance.part).ok_or_else(|| {
            MeshProblem::NoSuch { what: "part", name: quoted(&instance.part) }.at(instance.line, "*INSTANCE")
        })?;
        add(&mut whole, part, instance, several, work)
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
    let single = |support: &&Support| {
        several && support.target.split_once('.').is_some_and(|(_, node)| is_number(node))
    };
    if let Some(support) = supports.iter().find(single) {
        let what = "a support of a single node of one of several instances".to_owned();
        let advice = "name a node set of the instance";
        return Err(MeshProblem::NotCarried { what, advice }.at(support.line, "*BOUNDARY"));
    }
    mesh.held = held(&whole, supports, work)?;
    let known: BTreeSet<u64> = whole.elements.keys().copied().collect();
    mesh.element_sets = (whole.element_sets.into_iter())
        .map(|(name, set)| (name, set.intersection(&known).copied().collect::<BTreeSet<u64>>()))
        .filter(|(_, set)| !set.is_empty())
        .collect();
    mesh.sections =
        whole.sections.into_iter().filter(|(set, _)| mesh.element_sets.contains_key(set)).collect();
    (mesh.nodes, mesh.elements) = (whole.nodes, whole.elements);
    mesh.node_sets = whole.node_sets.into_iter().map(|(name, set)| (name, set.into_list())).collect();
    crate::whole::check(&mesh, "*ELEMENT")?;
    Ok(mesh)
}

/// Adds an instance of a part. Where there are several, nodes and elements get numbers of their own, and sets the instance's name.
fn add(
    whole: &mut Scope,
    part: &Scope,
    instance: &Instance,
    several: bool,
    work: &mut Work,
) -> Result<(), MeshProblem> {
    let counts = [&whole.nodes, &part.nodes].map(BTreeMap::len).iter().sum::<usize>()
        + [&whole.elements, &part.elements].map(BTreeMap::len).iter().sum::<usize>();
    if counts > MOST {
        return Err(MeshProblem::NotCarried {
            what: format!("an assembly of more than {MOST} nodes and elements"),
            advice: "a sector is one body; leave the instances out that are no part of it",
        });
    }
    work.take(size_of_sets(part, &instance.name))?;
    let mut local = Scope {
        nodes: part.nodes.clone(),
        elements: part.elements.clone(),
        node_sets: part.node_sets.clone(),
        element_sets: part.element_sets.clone(),
        ..Scope::default()
    };
    let mut of_assembly = BTreeSet::new();
    for (request, lines) in &instance.requests {
        for line in lines {
            request.answer(&mut local, &line.split(',').collect::<Vec<_>>(), work)?;
        }
        of_assembly.insert(request.name.as_str());
    }
    let named = |name: &str| {
        if several && !of_assembly.contains(name) {
            format!("{}.{name}", instance.name)
        } else {
            name.to_owned()
        }
    };
    let after_nodes = offset("node", several, &whole.nodes, &local.nodes)?;
    let after_elements = offset("element", several, &whole.elements, &local.elements)?;
    whole.nodes.extend(local.nodes.iter().map(|(id, &at)| (id + after_nodes, instance.position(at))));
    for (id, mut element) in local.elements {
        element.nodes.iter_mut().for_each(|node| *node += after_nodes);
        whole.elements.insert(id + after_elements, element);
    }
    for (name, set) in &local.node_sets {
        let set = set.nodes().iter().map(|node| node + after_nodes);
        whole.node_sets.entry(named(name)).or_default().extend(set);
    }
    for (name, set) in &local.element_sets {
        let set = set.iter().map(|id| id + after_elements);
        whole.element_sets.entry(named(name)).or_default().extend(set);
    }
    whole.sections.extend(part.sections.iter().map(|(set, material)| (named(set), material.clone())));
    Ok(())
}

/// Numbers and letters of a part's sets and sections, which each instance has anew.
fn size_of_sets(part: &Scope, instance: &str) -> usize {
    let nodes = part.node_sets.iter().map(|(name, set)| name.len() + set.len());
    let elements = part.element_sets.iter().map(|(name, set)| name.len() + set.len());
    let sections = part.sections.iter().map(|(set, material)| set.len() + material.len());
    nodes.chain(elements).chain(sections).map(|size| size + instance.len() + OF_EACH_SET).sum()
}

/// Number that is added to the numbers of an instance. Sums stay within the range of numbers that files may have.
fn offset<T>(
    what: &'static str,
    several: bool,
    whole: &BTreeMap<u64, T>,
    part: &BTreeMap<u64, T>,
) -> Result<u64, MeshProblem> {
    let last = |map: &BTreeMap<u64, T>| map.last_key_value().map_or(0, |(&id, _)| id);
    let offset = if several { last(whole) } else { 0 };
    if offset + last(part) <= LARGEST {
        return Ok(offset);
    }
    Err(MeshProblem::NotCarried {
        what: format!("an assembly with a {what} number above {LARGEST}"),
        advice: "number nodes and elements from 1",
    })
}

/// Whether a text is a number without sign.
fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Nodes of which all three displacements are held.
fn held(whole: &Scope, supports: &[Support], work: &mut Work) -> Result<BTreeSet<u64>, MeshFileError> {
    let mut components: BTreeMap<u64, ([bool; 3], u64)> = BTreeMap::new();
    for support in supports {
        let failed = |problem: MeshProblem| problem.at(support.line, "*BOUNDARY");
        // Where there is a single instance, its name may stand before the set or node.
        let target = &support.target;
        let plain = target.rsplit_once('.').map_or(target.as_str(), |(_, plain)| plain);
        let set = whole.node_sets.get(target).or_else(|| whole.node_sets.get(plain));
        let node;
        let nodes = match set {
            Some(set) => set.nodes(),
            None if is_number(plain) => {
                node = [integer(plain, "a node number").map_err(failed)?];
                &node[..]
            }
            None => {
                return Err(failed(MeshProblem::NoSuch { what: "node set", name: quoted(target) }));
            }
        };
        work.take(nodes.len()).map_err(failed)?;
        for &node in nodes {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn supports_have_a_bound_in_all() {
        let mut scope = Scope::default();
        scope.node_set("A", false, &["1", "2", "3"], &mut Work::default()).unwrap();
        let support = |target: &str, line| Support { target: target.to_owned(), components: [true; 3], line };
        let supports = [support("A", 4), support("I.A", 5), support("7", 6)];
        assert_eq!(held(&scope, &supports, &mut Work::of(7)), Ok([1, 2, 3, 7].into()));
        let error = held(&scope, &supports, &mut Work::of(5)).unwrap_err();
        assert_eq!((error.line, error.card.as_str()), (5, "*BOUNDARY"));
        let far = [support("1000000000000001", 7)];
        assert_eq!(held(&scope, &far, &mut Work::default()).unwrap_err().line, 7);
    }
}
