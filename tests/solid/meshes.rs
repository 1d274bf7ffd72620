//! Small meshes of every element.

use rubmap::solid::element::ElementKind;
use rubmap::solid::material::Material;
use rubmap::solid::mesh::{Element, ElementSet, SectorMesh};
use rubmap::solid::natural::{CORNERS, EDGES};

/// Steel in mm, N, s, t.
pub(crate) fn steel() -> Material {
    Material {
        youngs_modulus: 2.1e5,
        poissons_ratio: 0.3,
        density: 7.85e-9,
        yield_strength: None,
        ultimate_strength: None,
        fatigue_strength: None,
    }
}

/// Corners of the tetrahedra, wedges and pyramids that a cube is cut into, conforming with its neighbours; 8 is its centre.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
const WEDGES: [[usize; 6]; 2] = [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]];
const PYRAMIDS: [[usize; 5]; 6] =
    [[0, 1, 2, 3, 8], [7, 6, 5, 4, 8], [4, 5, 1, 0, 8], [5, 6, 2, 1, 8], [6, 7, 3, 2, 8], [7, 4, 0, 3, 8]];
const PYRAMID_EDGES: [[usize; 2]; 8] = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]];
const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
const WEDGE_EDGES: [[usize; 2]; 9] = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]];

/// Block of `cells` cubes, each cut into elements of one kind; its nodes, given in cells, are put where `place` says.
pub(crate) fn block(
    kind: ElementKind,
    cells: [usize; 3],
    place: impl Fn([f64; 3]) -> [f64; 3],
) -> SectorMesh {
    let mut nodes: Vec<[f64; 3]> = Vec::new();
    let mut found = std::collections::HashMap::new();
    // Four times the place in cells is a whole number at corners, at centres and in the middle of edges.
    let mut node = |four: [i64; 3], ends: Option<[[i64; 3]; 2]>| {
        *found.entry(four).or_insert_with(|| {
            let at = |four: [i64; 3]| place(four.map(|x| 0.25 * x as f64));
            // A centre is no point of the grid: edges to it are straight.
            let to_centre = ends.filter(|ends| ends.iter().any(|end| end.iter().any(|x| x % 4 != 0)));
            nodes.push(match to_centre {
                Some([a, b]) => std::array::from_fn(|d| 0.5 * (at(a)[d] + at(b)[d])),
                None => at(four),
            });
            nodes.len() as u32 - 1
        })
    };
    let (parts, edges): (Vec<Vec<usize>>, &[[usize; 2]]) = match kind.corners() {
        4 => (TETRAHEDRA.iter().map(|part| part.to_vec()).collect(), &TETRAHEDRON_EDGES),
        5 => (PYRAMIDS.iter().map(|part| part.to_vec()).collect(), &PYRAMID_EDGES),
        6 => (WEDGES.iter().map(|part| part.to_vec()).collect(), &WEDGE_EDGES),
        _ => (vec![(0..8).collect()], &EDGES),
    };
    let mut elements = Vec::new();
    for z in 0..cells[2] {
        for y in 0..cells[1] {
            for x in 0..cells[0] {
                let corner = |k: usize| -> [i64; 3] {
                    let c = CORNERS.get(k).copied().unwrap_or([0.0; 3]);
                    std::array::from_fn(|d| 4 * [x, y, z][d] as i64 + 2 + 2 * c[d] as i64)
                };
                for part in &parts {
                    let corners: Vec<[i64; 3]> = part.iter().map(|&k| corner(k)).collect();
                    let mut list: Vec<u32> = corners.iter().map(|&at| node(at, None)).collect();
                    if kind.nodes() > kind.corners() {
                        list.extend(edges.iter().map(|&[a, b]| {
                            let ends = [corners[a], corners[b]];
                            node(std::array::from_fn(|d| (ends[0][d] + ends[1][d]) / 2), Some(ends))
                        }));
                    }
                    elements.push(Element { id: elements.len() as u64 + 1, kind, set: 0, nodes: list });
                }
            }
        }
    }
    SectorMesh {
        sectors: 1,
        node_ids: (1..=nodes.len() as u64).collect(),
        nodes,
        axis: ([0.0; 3], [0.0, 0.0, 1.0]),
        cyclic: Vec::new(),
        elements,
        sets: vec![ElementSet { name: "ALL".into(), material: steel() }],
    }
}
