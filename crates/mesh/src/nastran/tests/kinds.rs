//! Every solid element in every format of cards.

use rubmap_solid::defect::defect;
use rubmap_solid::element::ElementKind;
use rubmap_solid::topology::Topology;

use super::decks::{Format, deck};

/// Cards with their kinds, and the ends of the edge of each node on an edge as the Quick Reference Guide shows them, from 1.
const CARDS: [(&str, ElementKind, &[[usize; 2]]); 8] = [
    ("CTETRA", ElementKind::C3D4, &[]),
    ("CHEXA", ElementKind::C3D8I, &[]),
    ("CPENTA", ElementKind::C3D6, &[]),
    ("CPYRAM", ElementKind::C3D5, &[]),
    ("CTETRA", ElementKind::C3D10, &[[1, 2], [2, 3], [1, 3], [1, 4], [2, 4], [3, 4]]),
    (
        "CHEXA",
        ElementKind::C3D20,
        &[[1, 2], [2, 3], [3, 4], [1, 4], [1, 5], [2, 6], [3, 7], [4, 8], [5, 6], [6, 7], [7, 8], [5, 8]],
    ),
    ("CPENTA", ElementKind::C3D15, &[[1, 2], [2, 3], [1, 3], [1, 4], [2, 5], [3, 6], [4, 5], [5, 6], [4, 6]]),
    ("CPYRAM", ElementKind::C3D13, &[[1, 2], [2, 3], [3, 4], [1, 4], [1, 5], [2, 5], [3, 5], [4, 5]]),
];

#[test]
fn every_element_is_whole_in_every_format() {
    for (card, kind, middles) in CARDS {
        let corners = Topology::of(kind).corners;
        let middle =
            |&[a, b]: &[usize; 2]| std::array::from_fn(|d| 0.5 * (corners[a - 1][d] + corners[b - 1][d]));
        let nodes: Vec<[f64; 3]> = corners.iter().copied().chain(middles.iter().map(middle)).collect();
        for format in Format::ALL {
            let mut text = String::new();
            for (k, [x, y, z]) in nodes.iter().enumerate() {
                let fields = [
                    (k + 1).to_string(),
                    String::new(),
                    format!("{x:?}"),
                    format!("{y:?}"),
                    format!("{z:?}"),
                ];
                text += &format.card("GRID", &fields);
            }
            let numbers = [7, 3].into_iter().chain(1..=nodes.len()).map(|number| number.to_string());
            text += &format.card(card, &numbers.collect::<Vec<_>>());
            let mesh = deck(&text).unwrap_or_else(|error| panic!("{card} {format:?}: {error}"));
            let element = &mesh.elements[&7];
            assert_eq!(element.kind, kind);
            let positions: Vec<[f64; 3]> = element.nodes.iter().map(|node| mesh.nodes[node]).collect();
            assert_eq!(positions.len(), kind.nodes());
            assert_eq!(defect(kind, &positions), None, "{card} {format:?}");
            assert_eq!(mesh.element_sets["3"], [7].into());
            assert_eq!(mesh.notes.len(), usize::from(kind == ElementKind::C3D8I));
        }
    }
}

#[test]
fn hexahedra_with_repeated_nodes_are_what_they_look_like() {
    let grids = super::decks::CUBE;
    let mesh = deck(&format!("{grids}CHEXA,1,1,1,2,3,3,5,6\n,7,7")).unwrap();
    assert_eq!(mesh.elements[&1].kind, ElementKind::C3D6);
    assert_eq!(mesh.notes, [""; 0]);
    // The collapsed edges 3–4 and 7–8 go without nodes; 2–3 and 4–1 have one each, which are not the same edge.
    let middles = "GRID,21,,.5\nGRID,22,,1.,.5\nGRID,24,,.5,.5\nGRID,25,,,,.5\nGRID,26,,1.,,.5\nGRID,27,,1.,1.,.5\n\
                   GRID,29,,.5,,1.\nGRID,30,,1.,.5,1.\nGRID,32,,.5,.5,1.\n";
    let hexahedron = "CHEXA,1,1,1,2,3,3,5,6\n,7,7,21,22,,24,25,26\n,27,,29,30,,32";
    let mesh = deck(&format!("{grids}{middles}{hexahedron}")).unwrap();
    let element = &mesh.elements[&1];
    assert_eq!(element.kind, ElementKind::C3D15);
    let positions: Vec<[f64; 3]> = element.nodes.iter().map(|node| mesh.nodes[node]).collect();
    assert_eq!(defect(element.kind, &positions), None);
}
