//! Node sets of a mesh file by name.

use rubmap_mesh::MeshFile;

use super::error::FromMeshError;

/// Nodes of a set in ascending order, at least one; capitals and blanks in its name do not matter.
pub(super) fn node_set(file: &MeshFile, name: &str) -> Result<Vec<u64>, FromMeshError> {
    let normal = |name: &str| -> String {
        name.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_uppercase).collect()
    };
    let found = file.node_sets.get(name).or_else(|| {
        file.node_sets.iter().find(|(other, _)| normal(other) == normal(name)).map(|(_, nodes)| nodes)
    });
    let Some(nodes) = found.filter(|nodes| !nodes.is_empty()) else {
        let known = file.node_sets.keys().cloned().collect();
        return Err(FromMeshError::NoSuchSet { name: name.to_owned(), known });
    };
    let mut nodes = nodes.clone();
    nodes.sort_unstable();
    nodes.dedup();
    Ok(nodes)
}
