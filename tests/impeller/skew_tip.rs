//! Tips whose ends are skew to their length, as those of strongly staggered blades are.

use rubmap::from_mesh::{self, MeshSettings};
use rubmap::mesh;
use rubmap::solid::element::ElementKind;

use crate::deck::deck;
use crate::meshes::block;

/// Number of elements along the chord.
const ALONG: usize = 10;

/// Blade of constant width along a helix between two planes normal to the axis, on a foot; the contact line of its tip, in cells along the
/// chord and across it from 0 to 1.
fn line(kind: ElementKind, across: usize, stagger: f64, width: f64) -> Vec<[f64; 2]> {
    let cells = [across, ALONG, 4];
    let place = |[x, along, up]: [f64; 3]| {
        let r = 50.0 + 5.0 * up + 0.4 * along;
        let z = 3.0 * along;
        // The foot is shorter than the tip.
        let theta = (width * (x / across as f64 - 0.5) + stagger * z) / (50.0 + 0.1 * up);
        [r * theta.cos(), r * theta.sin(), z]
    };
    let mut text = deck(&block(kind, cells, place)) + "*BOUNDARY\n";
    let grid = block(kind, cells, |at| at);
    for (at, id) in grid.nodes.iter().zip(1..) {
        if at[2] == 0.0 {
            text += &format!("{id}, 1, 3\n");
        }
    }
    let file = mesh::read(text.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let settings = MeshSettings { sectors: Some(1), contact_nodes: 100, ..MeshSettings::new(100.0) };
    let sector = from_mesh::sector(&file, &settings)
        .unwrap_or_else(|error| panic!("{kind:?} {across} {stagger} {width}: {error}"));
    let place = |node: u64| grid.nodes[node as usize - 1];
    sector
        .found
        .contact
        .iter()
        .map(|point| place(point.node))
        .map(|[x, along, _]| [along, x / across as f64])
        .collect()
}

/// With one element across the line is one edge from end to end, with two the middle.
#[test]
fn contact_nodes_stay_in_one_row_from_end_to_end() {
    for (kind, across, step) in
        [(ElementKind::C3D8I, 1, 1.0), (ElementKind::C3D8I, 2, 1.0), (ElementKind::C3D20, 2, 0.5)]
    {
        for stagger in [0.3, 0.6, 1.0, 1.5] {
            for width in [1.0, 2.0, 4.0, 8.0] {
                let line = line(kind, across, stagger, width);
                let side = line[0][1];
                let rows = (ALONG as f64 / step) as usize + 1;
                let expected: Vec<[f64; 2]> = (0..rows).map(|k| [step * k as f64, side]).collect();
                let of = format!("{kind:?} {across} {stagger} {width}");
                if kind == ElementKind::C3D8I {
                    assert_eq!(line, expected, "{of}");
                }
                // Single nodes beside a skew end are not in the middle between both edges.
                assert!(line.iter().all(|place| expected.contains(place)), "{of}: {line:?}");
                assert_eq!((line.first(), line.last()), (expected.first(), expected.last()), "{of}");
                assert!(side == 0.5 || across == 1, "{side}");
            }
        }
    }
}
