//! Coordinate systems.

use super::decks::{refusal, with};

fn near(cards: &str, expected: [f64; 3]) {
    let mesh = with(cards).unwrap_or_else(|error| panic!("{cards}: {error}"));
    let found = mesh.nodes[&9];
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-12, "{cards}: {found:?}");
}

#[test]
fn positions_in_every_system() {
    // Origin (1, 0, 0), z along y, x along z, so that y is along x.
    let system = |name: &str| format!("{name},4,,1.,0.,0.,1.,1.,0.\n,1.,0.,1.\n");
    near(&format!("{}GRID,9,4,1.,2.,3.", system("CORD2R")), [3.0, 3.0, 1.0]);
    near(&format!("{}GRID,9,4,2.,90.,3.", system("CORD2C")), [3.0, 3.0, 0.0]);
    near(&format!("{}GRID,9,4,2.,90.,0.", system("CORD2S")), [1.0, 0.0, 2.0]);
    near(&format!("{}GRID,9,4,2.,0.,50.", system("CORD2S")), [1.0, 2.0, 0.0]);
    near(&format!("{}GRID,9,4,2.,90.,90.", system("CORD2S")), [3.0, 0.0, 0.0]);
    // By nodes 2, 3 and 6 of the cube: the same axes; the second system of a card, too.
    near("CORD1R,4,2,3,6\nGRID,9,4,1.,2.,3.", [3.0, 3.0, 1.0]);
    near("CORD1C,3,1,2,3,4,2,3,6\nGRID,9,4,2.,90.,3.", [3.0, 3.0, 0.0]);
    near("CORD1S,4,2,3,6\nGRID,9,4,2.,0.,0.", [1.0, 2.0, 0.0]);
    near(&format!("{}GRDSET,,4\nGRID,9,0,1.,2.,3.", system("CORD2R")), [1.0, 2.0, 3.0]);
}

#[test]
fn systems_refer_to_each_other() {
    // A rectangular system whose points are in a cylindrical one: origin (0, 2, 0), z along z, x towards −x.
    let cylindrical = "CORD2C,7,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
    let within = "CORD2R,4,7,2.,90.,0.,2.,90.,1.\n,2.,180.,0.\n";
    let root = 0.5_f64.sqrt();
    near(&format!("{within}{cylindrical}GRID,9,4,1.,0.,0."), [-root, 2.0 - root, 0.0]);
    let nodes = "GRID,11,7,0.\nGRID,12,7,0.,0.,1.\nGRID,13,7,1.,90.\nCORD1R,4,11,12,13\n";
    near(&format!("{nodes}{cylindrical}GRID,9,4,1.,2.,3."), [-2.0, 1.0, 3.0]);
}

#[test]
fn systems_that_are_none() {
    let points = "0.,0.,0.,0.,0.,1.\n,1.,0.,0.";
    assert_eq!(refusal("GRID,9,4"), "line 10 (GRID): there is no coordinate system \"4\" in the file");
    assert_eq!(
        refusal(&format!("CORD2R,4,5,{points}")),
        "line 10 (CORD2R): there is no coordinate system \"5\" in the file"
    );
    assert_eq!(
        refusal(&format!("CORD2R,4,5,{points}\nCORD2R,5,4,{points}")),
        "line 12 (CORD2R): expected coordinate systems that do not refer to each other in a circle"
    );
    assert_eq!(
        refusal("CORD1R,4,9,2,3\nGRID,9,4"),
        "line 10 (CORD1R): expected coordinate systems that do not refer to each other in a circle"
    );
    assert_eq!(
        refusal("CORD2R,4,,0.,0.,0.,0.,0.,1.\n,0.,0.,2."),
        "line 10 (CORD2R): expected three points that are not on one line"
    );
    assert_eq!(refusal("CORD1R,4,1,2,99"), "line 10 (CORD1R): there is no node \"99\" in the file");
    assert_eq!(
        refusal(&format!("CORD2R,4,,{points}\nCORD2C,4,,{points}")),
        "line 12 (CORD2C): coordinate system 4 is there twice"
    );
    assert!(refusal(&format!("CORD2R,4,,{points}\nGRID,9,4,1.7+308,1.7+308\nCORD2R,5,4,{points}\nCORD2R,6,5,1.7+308,0.,0.,0.,0.,1.\n,1.,0.,0.")).contains("not on one line"));
    // A long chain, in the order that needs most steps.
    let chain: String = (1..20_000).map(|k| format!("CORD2R,{k},{},{points}\n", (k + 1) % 20_000)).collect();
    near(&format!("{chain}GRID,9,1,1.,2.,3."), [1.0, 2.0, 3.0]);
}

#[test]
fn frames_of_displacements() {
    let frames = |cards: &str| with(cards).unwrap().nodal_frames;
    let at = |line: u64, card: &str| Some((line, card.to_owned()));
    assert_eq!(frames("GRID,9,,0.,0.,0.,0\nGRID,10\nGRID,11,,0.,0.,0.,,3"), None);
    assert_eq!(frames("GRID,9\nGRID,10,,0.,0.,0.,4\nGRID,11,,0.,0.,0.,5"), at(11, "GRID"));
    assert_eq!(frames("GRDSET,,,,,,4"), at(10, "GRDSET"));
    assert_eq!(frames("GRID,9,,0.,0.,0.,-1"), at(10, "GRID"));
    // Every node states the basic system.
    let cube = super::decks::CUBE.replace(".\n", ".,0\n");
    let found = super::decks::deck(&format!("{cube}{}GRDSET,,,,,,4", super::decks::TETRAHEDRON));
    assert_eq!(found.unwrap().nodal_frames, None);
}
