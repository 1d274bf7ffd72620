//! Check that no two elements fill the same space: each set of nodes is one element, and a face lies between two at most, one on either
//! side.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::topology::Topology;

use crate::package::content::SourceLines;
use crate::package::error::{PackageError, TableProblem};

/// Rows of the elements at a face, and the sense in which the first sees its corners turn.
struct Shared {
    first: u32,
    second: Option<u32>,
    upwards: bool,
}

/// Refuses elements and faces that are listed twice, with the numbers of the elements.
pub(crate) fn check(file: &str, mesh: &SectorMesh, lines: &SourceLines) -> Result<(), PackageError> {
    let wrong = |row: usize, problem| {
        Err(PackageError::Table { file: file.to_owned(), line: lines.of_element(row), problem })
    };
    let number = |row: u32| mesh.elements[row as usize].id;
    let mut known = HashMap::with_capacity(mesh.elements.len());
    for (row, element) in mesh.elements.iter().enumerate() {
        let mut nodes = element.nodes.clone();
        nodes.sort_unstable();
        if let Some(first) = known.insert(nodes, row) {
            let (other, line) = (mesh.elements[first].id, lines.of_element(first));
            return wrong(row, TableProblem::ElementTwice { element: element.id, other, line });
        }
    }
    let mut faces: HashMap<[u32; 4], Shared> = HashMap::with_capacity(4 * mesh.elements.len());
    for (row, element) in mesh.elements.iter().enumerate() {
        for corners in Topology::of(element.kind).faces {
            let (key, upwards) = seen(corners.iter().map(|&corner| element.nodes[corner]));
            let this = row as u32;
            let mut shared = match faces.entry(key) {
                Entry::Vacant(place) => {
                    place.insert(Shared { first: this, second: None, upwards });
                    continue;
                }
                Entry::Occupied(shared) => shared,
            };
            let Shared { first, second, upwards: of_first } = shared.get_mut();
            if let Some(second) = *second {
                let others = [number(*first), number(second)];
                return wrong(row, TableProblem::FaceOfThree { element: element.id, others });
            }
            if *of_first == upwards {
                return wrong(row, TableProblem::OnOneSide { element: element.id, other: number(*first) });
            }
            *second = Some(this);
        }
    }
    Ok(())
}

/// Corners of a face in ascending order (of a triangle the last twice), and the sense in which they turn: the elements on both sides of a
/// face see it turn differently.
fn seen(corners: impl Iterator<Item = u32>) -> ([u32; 4], bool) {
    let corners: Vec<u32> = corners.collect();
    let count = corners.len();
    let smallest = (0..count).min_by_key(|&k| corners[k]).unwrap_or_default();
    let (next, last) = (corners[(smallest + 1) % count], corners[(smallest + count - 1) % count]);
    let mut sorted = corners;
    sorted.sort_unstable();
    (std::array::from_fn(|k| sorted[k.min(count - 1)]), next < last)
}
