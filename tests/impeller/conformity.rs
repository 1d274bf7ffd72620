//! Properties that every mesh must have, whatever its shape: checked from its nodes and elements alone.

use std::collections::{HashMap, HashSet};

use rubmap::impeller::mesh::{Elements, HexMesh, SectorMesh};
use rubmap::solid::element::ElementKind;
use rubmap::solid::gauss::{GaussPoint, gauss_points};
use rubmap::solid::jacobian;
use rubmap::solid::natural::EDGES;

/// Corners of each face, counter-clockwise seen from outside.
const FACES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// Outer surface of a mesh: faces of one element only, as four corners counter-clockwise seen from outside.
///
/// Checks on the way that every face belongs to one element, or to two from opposite sides.
pub(crate) fn boundary(mesh: &HexMesh) -> Vec<[usize; 4]> {
    let mut faces: HashMap<[usize; 4], Vec<[usize; 4]>> = HashMap::new();
    for e in 0..mesh.elements.len() {
        let nodes = mesh.elements.nodes_of(e);
        for face in FACES {
            let face = face.map(|c| nodes[c]);
            let mut key = face;
            key.sort_unstable();
            faces.entry(key).or_default().push(face);
        }
    }
    let mut outer = Vec::new();
    for sides in faces.values() {
        match sides.as_slice() {
            [one] => outer.push(*one),
            [a, b] => {
                // The other element has the same corners in the opposite sense.
                let at = b.iter().position(|n| *n == a[0]).unwrap();
                assert_eq!(a[1], b[(at + 3) % 4], "a face is entered twice from one side");
            }
            _ => panic!("a face of {} elements", sides.len()),
        }
    }
    outer
}

/// Checks that no two nodes are in one place, none is without an element, every edge has one middle, and the outer
/// surface is closed and has the topology of a ball.
pub(crate) fn check_conforming(mesh: &HexMesh, size: f64) {
    let mut used: HashSet<usize> = HashSet::new();
    let mut middles: HashMap<[usize; 2], usize> = HashMap::new();
    for e in 0..mesh.elements.len() {
        let nodes = mesh.elements.nodes_of(e);
        assert_eq!(nodes.iter().collect::<HashSet<_>>().len(), nodes.len(), "element {e} has a node twice");
        used.extend(nodes);
        for ([a, b], middle) in EDGES.into_iter().zip(&nodes[8..]) {
            let edge = [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
            assert_eq!(middles.entry(edge).or_insert(*middle), middle, "an edge with two middles");
        }
    }
    assert_eq!(used.len(), mesh.nodes.len());

    let mut order: Vec<usize> = (0..mesh.nodes.len()).collect();
    order.sort_by(|&a, &b| mesh.nodes[a][0].total_cmp(&mesh.nodes[b][0]));
    for (i, &a) in order.iter().enumerate() {
        let near = order[i + 1..].iter().take_while(|&&b| mesh.nodes[b][0] - mesh.nodes[a][0] < 1e-6 * size);
        for &b in near {
            let far = (1..3).any(|d| (mesh.nodes[a][d] - mesh.nodes[b][d]).abs() > 1e-6 * size);
            assert!(far, "nodes {a} and {b} lie in one place");
        }
    }

    let outer = boundary(mesh);
    let mut edges: HashSet<[usize; 2]> = HashSet::new();
    let mut corners: HashSet<usize> = HashSet::new();
    for face in &outer {
        for c in 0..4 {
            corners.insert(face[c]);
            assert!(edges.insert([face[c], face[(c + 1) % 4]]), "an edge walked twice in one direction");
        }
    }
    assert!(edges.iter().all(|&[a, b]| edges.contains(&[b, a])), "the surface is open");
    // This is V − E + F of a sphere.
    assert_eq!(corners.len() + outer.len(), edges.len() / 2 + 2);
}

/// Volume ∫ dV of a mesh by 3 × 3 × 3 Gauss points (exact for these elements); every determinant on the way must be positive.
pub(crate) fn volume(mesh: &HexMesh) -> f64 {
    let kind = match mesh.elements {
        Elements::Linear(_) => ElementKind::QM6,
        Elements::Quadratic(_) => ElementKind::C3D20,
    };
    let of = |e: usize| {
        let positions: Vec<[f64; 3]> = mesh.elements.nodes_of(e).iter().map(|&n| mesh.nodes[n]).collect();
        let part = |point: &GaussPoint| {
            let determinant = jacobian(kind, &positions, point.xi).determinant();
            assert!(determinant > 0.0, "{determinant}");
            determinant * point.weight
        };
        gauss_points(3).iter().map(part).sum::<f64>()
    };
    (0..mesh.elements.len()).map(of).sum()
}

/// Checks that the high face is the low face turned by 2π/N, to a few roundings of sine and cosine, and that the two
/// cover the same piece of the surface.
pub(crate) fn check_cyclic(sector: &SectorMesh, size: f64) {
    let (s, c) = (2.0 * std::f64::consts::PI / sector.sectors as f64).sin_cos();
    for &(low, high) in &sector.cyclic {
        let [x, y, z] = sector.mesh.nodes[low];
        let turned = [c * x - s * y, s * x + c * y, z];
        for (turned, x) in turned.iter().zip(&sector.mesh.nodes[high]) {
            assert!((turned - x).abs() < 4e-15 * size);
        }
        assert_eq!(sector.clamped[low], sector.clamped[high]);
    }
    // Each face of the low side, turned, is a face of the high side in the opposite sense.
    let high_of: HashMap<usize, usize> = sector.cyclic.iter().copied().collect();
    let outer = boundary(&sector.mesh);
    let sorted = |mut face: [usize; 4]| {
        face.sort_unstable();
        face
    };
    let known: HashSet<[usize; 4]> = outer.iter().map(|f| sorted(*f)).collect();
    let mut pairs = 0;
    for face in &outer {
        if let [Some(a), Some(b), Some(c), Some(d)] = face.map(|n| high_of.get(&n).copied()) {
            assert!(known.contains(&sorted([a, b, c, d])), "a low face without its high face");
            pairs += 1;
        }
    }
    let corner_pairs = outer.iter().flatten().filter(|n| high_of.contains_key(n)).collect::<HashSet<_>>();
    assert!(pairs > 0 && corner_pairs.len() > pairs);
}
