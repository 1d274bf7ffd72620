//! Hexahedra with repeated nodes: wedges, pyramids and tetrahedra as meshers and Ansys write them.

use rubmap_solid::element::ElementKind;
use rubmap_solid::natural::EDGES;

/// Kind and nodes of a hexahedron of eight or twenty nodes, after repeated nodes are taken together; as it is if none is repeated. None if
/// the repeated nodes make no wedge, pyramid or tetrahedron.
///
/// Corners of one edge of the hexahedron may be one node; where they are, the node on that edge is the same again, or missing, which is
/// written as 0.
pub(crate) fn collapsed(kind: ElementKind, nodes: &[u64]) -> Option<(ElementKind, Vec<u64>)> {
    let corners = &nodes[..8];
    // First corner of the same node, for every corner.
    let same: Vec<usize> =
        (0..8).map(|a| corners.iter().position(|&b| b == corners[a]).unwrap_or(a)).collect();
    let quadratic = nodes.len() == 20;
    if same.iter().enumerate().all(|(a, &first)| a == first) {
        return Some((kind, nodes.to_vec()));
    }
    for (shape, local) in SHAPES {
        for rotation in rotations() {
            let at = |k: usize| rotation[local[k]];
            let merged = merges(shape, &rotation);
            if merged != same {
                continue;
            }
            let count = local.len();
            let mut found: Vec<u64> = (0..count).map(|k| corners[at(k)]).collect();
            if quadratic {
                for [a, b] in edges(shape) {
                    found.push(middle(nodes, &same, [at(a), at(b)])?);
                }
            }
            let kind = match (shape, quadratic) {
                (Shape::Wedge, false) => ElementKind::C3D6,
                (Shape::Wedge, true) => ElementKind::C3D15,
                (Shape::Pyramid, false) => ElementKind::C3D5,
                (Shape::Pyramid, true) => ElementKind::C3D13,
                (Shape::Tetrahedron, false) => ElementKind::C3D4,
                (Shape::Tetrahedron, true) => ElementKind::C3D10,
            };
            return Some((kind, found));
        }
    }
    None
}

/// Node in the middle of an edge, which the collapsed hexahedron may have more than once; none if it has none or different ones.
fn middle(nodes: &[u64], same: &[usize], [a, b]: [usize; 2]) -> Option<u64> {
    let ends = [same[a], same[b]];
    let mut middles = EDGES.iter().zip(&nodes[8..]).filter_map(|(&[p, q], &middle)| {
        let pair = [same[p], same[q]];
        let this = pair == ends || pair == [ends[1], ends[0]];
        (this && middle != 0).then_some(middle)
    });
    let first = middles.next()?;
    middles.all(|middle| middle == first).then_some(first)
}

/// Shape that a hexahedron collapses to.
#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Wedge,
    Pyramid,
    Tetrahedron,
}

/// Corners of the hexahedron that are the corners of each shape, for the way in which `merges` takes corners together.
const SHAPES: [(Shape, &[usize]); 3] = [
    // The edges 2–3 and 6–7 are points: triangles 0, 1, 2 and 4, 5, 6.
    (Shape::Wedge, &[0, 1, 2, 4, 5, 6]),
    // The face 4, 5, 6, 7 is a point.
    (Shape::Pyramid, &[0, 1, 2, 3, 4]),
    // The edge 2–3 and the face 4, 5, 6, 7 are points.
    (Shape::Tetrahedron, &[0, 1, 2, 4]),
];

/// First corner of the same node, for every corner of a hexahedron that is turned by `rotation` and collapsed to `shape`.
fn merges(shape: Shape, rotation: &[usize; 8]) -> Vec<usize> {
    let groups: &[&[usize]] = match shape {
        Shape::Wedge => &[&[2, 3], &[6, 7]],
        Shape::Pyramid => &[&[4, 5, 6, 7]],
        Shape::Tetrahedron => &[&[2, 3], &[4, 5, 6, 7]],
    };
    let mut same: Vec<usize> = (0..8).collect();
    for group in groups {
        let turned: Vec<usize> = group.iter().map(|&k| rotation[k]).collect();
        let first = turned.iter().copied().min().unwrap_or(0);
        turned.iter().for_each(|&k| same[k] = first);
    }
    same
}

/// Edges of a shape by its own corners, in the order of its mid-edge nodes.
fn edges(shape: Shape) -> Vec<[usize; 2]> {
    let kind = match shape {
        Shape::Wedge => ElementKind::C3D15,
        Shape::Pyramid => ElementKind::C3D13,
        Shape::Tetrahedron => ElementKind::C3D10,
    };
    rubmap_solid::topology::Topology::of(kind).edges.to_vec()
}

/// Rotations of the cube: for each corner, the corner in its place.
fn rotations() -> Vec<[usize; 8]> {
    // Quarter turns about ζ and about ξ make all 24.
    let about_zeta = [1, 2, 3, 0, 5, 6, 7, 4];
    let about_xi = [3, 2, 6, 7, 0, 1, 5, 4];
    let after = |a: [usize; 8], b: [usize; 8]| a.map(|k| b[k]);
    let mut found = vec![[0, 1, 2, 3, 4, 5, 6, 7]];
    let mut next = 0;
    while next < found.len() {
        for turn in [about_zeta, about_xi] {
            let turned = after(turn, found[next]);
            if !found.contains(&turned) {
                found.push(turned);
            }
        }
        next += 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use rubmap_solid::defect::defect;
    use rubmap_solid::natural::CORNERS;

    use super::*;

    /// Hexahedra collapsed in each of their 24 orientations are whole elements of the right volume, with the nodes of their edges.
    #[test]
    fn every_orientation_collapses_to_a_whole_element() {
        assert_eq!(rotations().len(), 24);
        for (shape, _) in SHAPES {
            for rotation in rotations() {
                let same = merges(shape, &rotation);
                // Place of each corner's node: that of the first corner of the same node, pyramids with the apex above the middle.
                let place = |corner: usize| CORNERS[same[corner]];
                for quadratic in [false, true] {
                    let mut nodes: Vec<u64> = same.iter().map(|&k| k as u64 + 1).collect();
                    let mut places: std::collections::HashMap<u64, [f64; 3]> =
                        (0..8).map(|k| (same[k] as u64 + 1, place(k))).collect();
                    if quadratic {
                        for [p, q] in EDGES {
                            let (a, b) = (same[p].min(same[q]), same[p].max(same[q]));
                            let id = if a == b { a as u64 + 1 } else { (100 + 10 * a + b) as u64 };
                            nodes.push(id);
                            let middle = |d: usize| 0.5 * (CORNERS[a][d] + CORNERS[b][d]);
                            places.entry(id).or_insert_with(|| std::array::from_fn(middle));
                        }
                    }
                    let kind = if quadratic { ElementKind::C3D20 } else { ElementKind::C3D8 };
                    let (kind, found) = collapsed(kind, &nodes).expect("a shape");
                    assert_eq!(found.len(), kind.nodes());
                    let at: Vec<[f64; 3]> = found.iter().map(|id| places[id]).collect();
                    assert_eq!(defect(kind, &at), None, "{kind:?} {rotation:?}");
                }
            }
        }
    }

    #[test]
    fn an_edge_has_one_node_in_its_middle() {
        // A wedge whose edge between the corners 3 and 7 is there twice.
        let mut nodes = vec![1, 2, 3, 3, 5, 6, 7, 7];
        for (k, [p, q]) in EDGES.into_iter().enumerate() {
            let (a, b) = (nodes[p], nodes[q]);
            nodes.push(if a == b {
                a
            } else if [a, b] == [3, 7] {
                100
            } else {
                20 + k as u64
            });
        }
        let places: Vec<usize> = (8..20).filter(|&k| nodes[k] == 100).collect();
        assert_eq!(places.len(), 2);
        let (kind, found) = collapsed(ElementKind::C3D20, &nodes).expect("a wedge");
        assert_eq!(kind, ElementKind::C3D15);
        for (other, expected) in [(0, Some((kind, found))), (101, None)] {
            for &place in &places {
                let mut nodes = nodes.clone();
                nodes[place] = other;
                assert_eq!(collapsed(ElementKind::C3D20, &nodes), expected);
            }
        }
    }

    #[test]
    fn other_repetitions_are_refused() {
        assert_eq!(collapsed(ElementKind::C3D8, &[1, 2, 3, 4, 5, 6, 7, 1]), None);
        assert_eq!(collapsed(ElementKind::C3D8, &[1, 1, 3, 4, 5, 6, 7, 8]), None);
        let whole = [1, 2, 3, 4, 5, 6, 7, 8];
        assert_eq!(collapsed(ElementKind::C3D8, &whole), Some((ElementKind::C3D8, whole.to_vec())));
    }
}
