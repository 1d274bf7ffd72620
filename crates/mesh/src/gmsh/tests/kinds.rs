//! Every type of solid element in every form of the format.

use rubmap_solid::defect::defect;
use rubmap_solid::element::ElementKind;
use rubmap_solid::topology::Topology;

use super::super::read;
use super::files::{Block, Mesh, cube};

/// Corners between which each node on an edge is, as the figures in Gmsh's manual show them, node by node.
fn figure(of: i32) -> (ElementKind, &'static [&'static [usize]]) {
    match of {
        4 => (ElementKind::C3D4, &[]),
        5 => (ElementKind::C3D8I, &[]),
        6 => (ElementKind::C3D6, &[]),
        7 => (ElementKind::C3D5, &[]),
        11 => (ElementKind::C3D10, &[&[0, 1], &[1, 2], &[0, 2], &[0, 3], &[2, 3], &[1, 3]]),
        17 => (
            ElementKind::C3D20,
            &[
                &[0, 1],
                &[0, 3],
                &[0, 4],
                &[1, 2],
                &[1, 5],
                &[2, 3],
                &[2, 6],
                &[3, 7],
                &[4, 5],
                &[4, 7],
                &[5, 6],
                &[6, 7],
            ],
        ),
        18 => (
            ElementKind::C3D15,
            &[&[0, 1], &[0, 2], &[0, 3], &[1, 2], &[1, 4], &[2, 5], &[3, 4], &[3, 5], &[4, 5]],
        ),
        _ => (ElementKind::C3D13, &[&[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 4], &[2, 3], &[2, 4], &[3, 4]]),
    }
}

/// Mesh of one element of a type.
fn one(of: i32) -> (ElementKind, Mesh) {
    let (kind, middles) = figure(of);
    let corners = Topology::of(kind).corners;
    let middle = |edge: &&[usize]| std::array::from_fn(|d| 0.5 * (corners[edge[0]][d] + corners[edge[1]][d]));
    let nodes: Vec<[f64; 3]> = corners.iter().copied().chain(middles.iter().map(middle)).collect();
    let elements = vec![(1..=nodes.len() as u64).collect()];
    (kind, Mesh { nodes, blocks: vec![Block { of, dimension: 3, entity: 1, elements }] })
}

#[test]
fn every_type_is_whole_in_every_form() {
    for of in [4, 5, 6, 7, 11, 17, 18, 19] {
        let (kind, mesh) = one(of);
        for (form, bytes) in mesh.all().iter().enumerate() {
            let read = read(bytes).unwrap_or_else(|error| panic!("{of} {form}: {error}"));
            let element = &read.elements[&1];
            assert_eq!(element.kind, kind);
            let positions: Vec<[f64; 3]> = element.nodes.iter().map(|node| read.nodes[node]).collect();
            assert_eq!(positions.len(), kind.nodes());
            assert_eq!(defect(kind, &positions), None, "{of} {form}");
            assert_eq!(element.line == 0, form % 2 == 1, "a binary file has no lines");
            assert_eq!(read.notes.len(), usize::from(of == 5), "{:?}", read.notes);
        }
    }
}

#[test]
fn hexahedra_with_repeated_nodes_are_what_they_look_like() {
    let mesh = read(cube("1 5 0 1 2 3 3 5 6 7 7").as_bytes()).unwrap();
    assert_eq!(mesh.elements[&1].kind, ElementKind::C3D6);
    assert_eq!(mesh.notes, [""; 0]);
    let error = read(cube("1 5 0 1 2 3 4 5 6 7 1").as_bytes()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "line 17 ($Elements): element 1 repeats nodes in a way that makes no wedge, pyramid or tetrahedron of a hexahedron"
    );
}
