//! Decks and matrices of CalculiX written by hand, which need no CalculiX.

use std::fmt::Write;
use std::path::Path;

use rubmap::package;
use rubmap::package::calculix::{self, CalculixModel, Normals};
use rubmap::package::raw::{Axis, Frame, RawMatrix, RawPackage};

use crate::calculix::{model, put};
use crate::sample::{Shape, package as sample};

/// Text of a matrix as CalculiX stores it: upper triangle, 14 digits, here with Fortran's exponents.
fn stored(matrix: &RawMatrix, row_of: impl Fn(u32) -> usize) -> String {
    let entry = |&(r, c, v): &(u32, u32, f64)| {
        format!("{} {} {}\n", row_of(c) + 1, row_of(r) + 1, format!("{v:.16e}").replace('e', "D"))
    };
    matrix.entries.iter().map(entry).collect()
}

/// Writes the sample in Cartesian components as a deck of two files and two jobs; rows at speed are listed backwards.
fn by_hand(folder: &Path) -> RawPackage {
    let package = sample(Shape { frame: Frame::Cartesian, ..Shape::default() });
    let mut deck =
        "** a comment\n*HEADING\n1, not a node\n*Include,\n** between\nInput=Mesh.inc\n".to_owned();
    deck += "*NSET, NSET=LOW, GENERATE\n1, 2\n*NSET, NSET = high\n5,6\n*NSET,NSET=Tip Nodes\n3,\n4,3\n*NSET, NSET=ALL\nLOW, High, TIPNODES\n";
    put(folder, "deck.inp", deck);
    let mut mesh = "*NODE, NSET=NALL\n".to_owned();
    for node in &package.nodes {
        let [x, y, z] = node.position.map(|x| format!("{x:.17e}").replace('e', "D"));
        writeln!(mesh, "{}, {x}, {y}, {z},", node.id).expect("text");
    }
    mesh += "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,\n5,6,7,1\n";
    put(folder, "Mesh.inc", mesh);
    let last = package.dofs.len() - 1;
    let dofs: Vec<String> =
        package.dofs.iter().map(|dof| format!("{}.{}", dof.node, dof.component)).collect();
    put(folder, "rest.dof", dofs.join("\n"));
    put(folder, "rest.mas", stored(&package.mass, |row| row as usize));
    put(folder, "rest.sti", stored(&package.stiffness[0], |row| row as usize));
    for (k, job) in [(1, "half"), (2, "full.5")] {
        put(folder, &format!("{job}.dof"), dofs.iter().rev().cloned().collect::<Vec<_>>().join("\n"));
        put(folder, &format!("{job}.sti"), stored(&package.stiffness[k], |row| last - row as usize));
    }
    package
}

fn cut_last_line(folder: &Path, name: &str) {
    let text = std::fs::read_to_string(folder.join(name)).expect("it was written");
    let lines: Vec<&str> = text.lines().collect();
    put(folder, name, lines[..lines.len() - 1].join("\n"));
}

fn hand_model(folder: &Path) -> CalculixModel {
    put(folder, "normals.csv", "node,nx,ny,nz\n4, 2, 0, 0\n3, 0, 0, -1\n");
    CalculixModel {
        at_speed: vec![(1000.0, folder.join("half")), (2000.0, folder.join("full.5"))],
        sectors: Some(3),
        low_set: Some("low".into()),
        high_set: Some("High".into()),
        contact_set: "Tip nodes".into(),
        normals: Normals::Table(folder.join("normals.csv")),
        ..model(folder, "deck.inp", "rest")
    }
}

#[test]
fn a_deck_and_its_matrices_become_the_package_they_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let expected = by_hand(folder.path());
    let (found, summary) = calculix::import(&hand_model(folder.path())).expect("imported");
    assert_eq!(found.dofs, expected.dofs);
    assert_eq!((&found.mass, &found.stiffness), (&expected.mass, &expected.stiffness));
    assert_eq!(found.manifest.cyclic, [[1, 5], [2, 6]]);
    assert!(!summary.faces_swapped);
    // Node 3 is at the smaller radius.
    let contact: Vec<_> = found.manifest.contact.iter().map(|contact| contact.node).collect();
    assert_eq!(contact, [3, 4]);
    let expected = [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]];
    for (contact, expected) in found.manifest.contact.iter().zip(expected) {
        let off = contact.normal.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-15, "{contact:?}");
    }
    package::to_sector(found).expect("passes the checks of every package");
    let exchanged = CalculixModel {
        low_set: Some("HIGH".into()),
        high_set: Some("LOW".into()),
        contact_as_listed: true,
        ..hand_model(folder.path())
    };
    let (found, summary) = calculix::import(&exchanged).expect("imported");
    assert!(summary.faces_swapped);
    let mut pairs = found.manifest.cyclic;
    pairs.sort_unstable();
    assert_eq!(pairs, [[1, 5], [2, 6]]);
}

/// Single sector: a blade on a rigid disk has no neighbour, and so no faces.
#[test]
fn a_single_sector_needs_no_faces() {
    let folder = tempfile::tempdir().expect("a folder");
    let expected = by_hand(folder.path());
    let alone =
        CalculixModel { sectors: Some(1), low_set: None, high_set: None, ..hand_model(folder.path()) };
    let (found, _) = calculix::import(&alone).expect("imported");
    assert_eq!((found.manifest.sectors, found.manifest.cyclic.len()), (1, 0));
    assert_eq!((&found.dofs, &found.mass), (&expected.dofs, &expected.mass));
    let sector = package::to_sector(found).expect("passes the checks of every package");
    assert_eq!(sector.own_dofs(), expected.dofs.len());
    // A name of one face means both.
    let half = CalculixModel { low_set: Some("LOW".into()), ..alone.clone() };
    let refused = calculix::import(&half).expect_err("no high face").to_string();
    assert!(refused.contains("which nodes are the high cyclic face?"), "{refused}");
    let wheel = CalculixModel { whole_wheel: true, ..alone };
    let refused = calculix::import(&wheel).expect_err("nothing to cut").to_string();
    assert!(refused.ends_with("or import a wheel of one sector without --wheel"), "{refused}");
}

/// Change that spoils a model, and the end of the message it must be refused with (the start is a file of a temporary folder).
type Spoil = (fn(&Path, &mut CalculixModel), &'static str);

fn replace(folder: &Path, file: &str, from: &str, to: &str) {
    let text = std::fs::read_to_string(folder.join(file)).expect("readable");
    assert!(text.contains(from), "{file} has no {from}");
    put(folder, file, text.replacen(from, to, 1));
}

#[test]
fn bad_files_are_refused_with_their_place_and_what_to_do() {
    let cases: &[Spoil] = &[
        (|f, _| replace(f, "deck.inp", "1, 2", "1, two"), "deck.inp, line 8: \"two\" is not a node number"),
        (
            |f, _| replace(f, "deck.inp", "LOW, High", "LOW, Height"),
            "line 15: the set HEIGHT is not defined before this line",
        ),
        (
            |f, _| replace(f, "deck.inp", "Mesh.inc", "deck.inp"),
            "*INCLUDE goes deeper than 20 files; does a file include itself?",
        ),
        (
            |f, _| put(f, "Mesh.inc", "*NODE\n1, 0., 0., 0.\n1, 0., 0., 1.\n"),
            "Mesh.inc, line 3: node 1 was at another place before; keep one of the two definitions",
        ),
        (|f, _| put(f, "Mesh.inc", "*NODE\n1, 0., 0., x\n"), "Mesh.inc, line 2: \"x\" is not a coordinate"),
        (
            |f, _| put(f, "Mesh.inc", "*Transform, NSET=A\n"),
            "line 1: *TRANSFORM is not supported: DOF of transformed nodes are not in global directions; export the matrices without it",
        ),
        (
            |f, _| replace(f, "rest.dof", "1.2", "1.7"),
            "rest.dof, line 2: \"1.7\" is not a DOF (node.direction, direction 1 to 3)",
        ),
        (|f, _| replace(f, "rest.dof", "1.2", "1.1"), "rest.dof, line 2: DOF 1.1 is listed twice"),
        (|f, _| replace(f, "half.dof", "1.2", "7.2"), "lists other DOF than "),
        (
            |f, _| replace(f, "rest.sti", "1 1 ", "1 19 "),
            "rest.sti, line 1: entry (1, 19) is outside the 18 rows that ",
        ),
        (|f, _| cut_last_line(f, "half.sti"), "the shorter file is cut off"),
        (|f, _| put(f, "rest.sti", ""), "rest.sti holds 0 entries and "),
        (|f, _| replace(f, "rest.mas", "1 2 ", "1 x "), "is not a matrix entry: row column value"),
        (|f, _| put(f, "rest.mas", "1 1 nan\n"), "rest.mas, line 1: entry (1, 1) is not a finite number"),
        (
            |f, _| put(f, "rest.mas", "1 2 1.\n2 1 1.\n"),
            "is given twice; *FREQUENCY, SOLVER=MATRIXSTORAGE writes it once: export again",
        ),
        (
            |_, m| m.sectors = None,
            "the deck has no *CYCLIC SYMMETRY MODEL card: give the number of sectors with --sectors",
        ),
        (
            |_, m| m.low_set = None,
            "which nodes are the low cyclic face? The deck has no cyclic *TIE of node surfaces: name a node set with --low-set",
        ),
        (
            |_, m| m.contact_set = "BLADE".into(),
            "the deck defines no node set BLADE; it has ALL, HIGH, LOW, NALL, TIPNODES",
        ),
        (
            |f, m| {
                let sets: String = (0..30).map(|k| format!("*NSET, NSET=S{k:02}\n1,\n")).collect();
                let deck = std::fs::read_to_string(f.join("deck.inp")).expect("readable");
                put(f, "deck.inp", format!("{deck}{sets}*NSET, NSET={}\n1,\n", "A".repeat(1000)));
                m.contact_set = "BLADE".into();
            },
            "…, ALL, HIGH, LOW, NALL, S00, S01, S02, S03, S04, S05, S06, S07, S08, S09, S10, S11, S12, S13, S14, 16 more",
        ),
        (
            |_, m| m.high_set = Some("ALL".into()),
            "the low face has 2 nodes and the high face 6; mesh the two faces alike (periodic)",
        ),
        (|_, m| m.sectors = Some(4), "mesh the two faces alike (periodic), and check --sectors and --axis"),
        (|_, m| m.axis = Some(Axis { origin: [0.0; 3], direction: [0.0; 3] }), "or --axis ends in zeros"),
        (
            |f, _| replace(f, "normals.csv", "4, 2", "7, 2"),
            "normals.csv: node 4 of the contact set has no normal there",
        ),
        (
            |_, m| m.normals = Normals::ContactNodes,
            "fewer than three nodes have no curve to take normals from; give --normals or --meridian",
        ),
        (
            |f, m| {
                put(f, "curve.csv", "r,z\n100,0\n101,1\n102,3\n");
                m.normals = Normals::Meridian(f.join("curve.csv"));
            },
            "is the curve given in the unit and the axis of the deck?",
        ),
        (
            |f, _| {
                let text = std::fs::read_to_string(f.join("rest.dof")).expect("readable");
                put(f, "rest.dof", text.replace("6.", "9."));
            },
            "node 9 of",
        ),
    ];
    for (spoil, message) in cases {
        let folder = tempfile::tempdir().expect("a folder");
        by_hand(folder.path());
        let mut model = hand_model(folder.path());
        spoil(folder.path(), &mut model);
        let found = calculix::import(&model).expect_err(message).to_string();
        assert!(found.contains(message), "\n    expected {message}\n    found    {found}");
    }
}
