//! Small decks: what is carried over, what is refused, and that no damage makes the reader panic.

use super::read;
use crate::error::MeshFileError;
use crate::mesh_file::MeshFile;
use rubmap_solid::element::ElementKind;

/// Corners of a unit cube as the nodes 1 to 8.
const CUBE: &str =
    "*NODE, NSET=NALL\n1, 0,0,0\n2, 1,0,0\n3, 1,1,0\n4, 0,1,0\n5, 0,0,1\n6, 1,0,1\n7, 1,1,1\n8, 0,1,1\n";
const BRICK: &str = "*ELEMENT, TYPE=C3D8I, ELSET=EALL\n1, 1,2,3,4,5,6,7,8\n";
const STEEL: &str = "*MATERIAL, NAME=Steel\n*ELASTIC\n2.1e5, 0.3\n*DENSITY\n7.85E-9,\n*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n";

fn none(_: &str) -> Result<Vec<u8>, String> {
    Err("there is no such file".to_owned())
}

fn mesh(text: &str) -> MeshFile {
    read(text.as_bytes(), &none).unwrap()
}

fn refused(text: &str) -> String {
    read(text.as_bytes(), &none).map_err(|error: MeshFileError| error.to_string()).unwrap_err()
}

#[test]
fn a_deck_is_read_with_its_sets_material_supports_and_symmetry() {
    let deck = format!(
        "** comment\n*Heading\n a wheel\n{CUBE}{BRICK}*NSET, NSET=tip, GENERATE\n5, 8, 2\n*NSET, NSET=Both\nTIP,\n 1, 5\n\
         *NSET, NSET=OFELEMENTS, ELSET=EALL\n{STEEL}*BOUNDARY\nboth, 1, 2\nBOTH, 3\n8, 1, 3, 0.\n\
         *CYCLIC SYMMETRY MODEL, N=12, TIE=T, NGRAPH=1\n0., 0., 0.,\n 0., 0., 1.\n*STEP\n*STATIC\n*DLOAD\nEALL, CENTRIF, 1., 0,0,0, 0,0,1\n*END STEP\n"
    );
    let found = mesh(&deck);
    assert_eq!((found.nodes.len(), found.elements.len()), (8, 1));
    assert_eq!(found.node_sets["TIP"], [5, 7]);
    assert_eq!(found.node_sets["BOTH"], [5, 7, 1]);
    assert_eq!(found.node_sets["OFELEMENTS"].len(), 8);
    assert_eq!(found.held.iter().copied().collect::<Vec<_>>(), [1, 5, 7, 8]);
    assert_eq!(found.sections, [("EALL".to_owned(), "STEEL".to_owned())]);
    let steel = &found.materials["STEEL"];
    assert_eq!((steel.elastic[0].youngs_modulus, steel.density[0].density), (2.1e5, 7.85e-9));
    assert_eq!(found.symmetry.as_ref().unwrap().sectors, 12);
    assert!(found.notes.is_empty(), "{:?}", found.notes);
}

#[test]
fn tables_over_temperature_are_kept_whole() {
    let deck = format!(
        "{CUBE}{BRICK}*MATERIAL, NAME=M\n*ELASTIC\n2.1e5, 0.3, 20.\n1.8e5, 0.31, 500.\n*DENSITY\n7.85e-9, 20.\n7.7e-9, 500.\n"
    );
    let found = mesh(&deck);
    let rows: Vec<_> =
        found.materials["M"].elastic.iter().map(|row| (row.youngs_modulus, row.temperature)).collect();
    assert_eq!(rows, [(2.1e5, Some(20.0)), (1.8e5, Some(500.0))]);
    assert_eq!(found.materials["M"].density[1].temperature, Some(500.0));
}

#[test]
fn lines_and_surfaces_are_left_out_by_name_and_other_types_are_reported() {
    let deck = format!(
        "{CUBE}*ELEMENT, TYPE=C3D8R, ELSET=EALL\n1, 1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=S4R, ELSET=SKIN\n2, 1,2,3,4\n3, 5,6,7,8\n\
         *ELEMENT, TYPE=B31\n4, 1, 2\n*ELEMENT, TYPE=C3D6\n5, 1,2,4,5,6,8\n*MADE UP CARD\n1, 2\n"
    );
    let found = mesh(&deck);
    assert_eq!(
        found.left_out.iter().map(|(k, v)| (k.as_str(), *v)).collect::<Vec<_>>(),
        [("B31", 1), ("S4R", 2)]
    );
    assert_eq!(found.elements[&1].kind, ElementKind::C3D8I);
    assert_eq!(found.notes, ["elements of type C3D8R are read as C3D8I", "cards *MADEUPCARD are not read"]);
}

#[test]
fn collapsed_hexahedra_are_what_they_collapse_to() {
    let deck =
        format!("{CUBE}*ELEMENT, TYPE=C3D8\n1, 1,2,3,3,5,6,7,7\n2, 1,2,3,4,5,5,5,5\n3, 1,2,3,3,5,5,5,5\n");
    let found = mesh(&deck);
    let kinds: Vec<ElementKind> = found.elements.values().map(|element| element.kind).collect();
    assert_eq!(kinds, [ElementKind::C3D6, ElementKind::C3D5, ElementKind::C3D4]);
    assert_eq!(found.elements[&1].nodes, [1, 2, 3, 5, 6, 7]);
}

/// Part with a set, put twice into the assembly, once moved and turned by a quarter about z.
#[test]
fn instances_are_put_where_the_assembly_says() {
    let part = format!(
        "*PART, NAME=P\n{CUBE}{BRICK}*NSET, NSET=TOP, GENERATE\n5, 8\n*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*END PART\n"
    );
    let material = "*MATERIAL, NAME=STEEL\n*ELASTIC\n1., 0.3\n*DENSITY\n1.\n";
    let one = mesh(&format!(
        "{part}*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n10., 0., 0.\n10., 0., 0., 10., 0., 1., 90.\n*END INSTANCE\n\
         *NSET, NSET=TIP, INSTANCE=P-1\n7, 8\n*END ASSEMBLY\n{material}*BOUNDARY\nP-1.TOP, ENCASTRE\n"
    ));
    let at = one.nodes[&2];
    assert!((at[0] - 10.0).abs() < 1e-14 && (at[1] - 1.0).abs() < 1e-14, "{at:?}");
    assert_eq!((one.node_sets["TIP"].clone(), one.held.len()), (vec![7, 8], 4));
    assert_eq!(one.sections, [("EALL".to_owned(), "STEEL".to_owned())]);
    let two = mesh(&format!(
        "{part}*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n*INSTANCE, NAME=P-2, PART=P\n5., 0., 0.\n*END INSTANCE\n\
         *NSET, NSET=TIP, INSTANCE=P-2\n5\n*END ASSEMBLY\n{material}"
    ));
    assert_eq!((two.nodes.len(), two.elements.len()), (16, 2));
    assert_eq!(
        (two.node_sets["P-2.TOP"].clone(), two.node_sets["TIP"].clone()),
        (vec![13, 14, 15, 16], vec![13])
    );
    assert_eq!((two.nodes[&9], two.elements[&2].nodes[0]), ([5.0, 0.0, 0.0], 9));
}

#[test]
fn refusals_name_card_line_and_number() {
    let with = |text: &str| refused(&format!("{CUBE}{BRICK}{text}"));
    for (message, expected) in [
        (
            with("*EQUATION\n2\n1,1,1.,2,1,-1.\n"),
            "line 12 (*EQUATION): a linear equation between displacements cannot be carried over",
        ),
        (with("*TIE, NAME=T\nA, B\n"), "line 12 (*TIE): a tie between surfaces cannot be carried over"),
        (
            with("*ELEMENT, TYPE=SPRINGA\n2, 1, 2\n"),
            "line 12 (*ELEMENT): an element of type \"SPRINGA\" cannot be carried over",
        ),
        (
            with("*ELASTIC, TYPE=ORTHO\n1.\n"),
            "line 12 (*ELASTIC): elasticity of type \"ORTHO\" cannot be carried over",
        ),
        (
            with("*BOUNDARY\n3, 2\n"),
            "line 13 (*BOUNDARY): a support of node 3 in direction 2 alone cannot be carried over",
        ),
        (
            with("*BOUNDARY\n3, 1, 1, 0.5\n"),
            "line 13 (*BOUNDARY): a prescribed displacement cannot be carried over",
        ),
        (with("*BOUNDARY\nHUB, 1, 3\n"), "line 13 (*BOUNDARY): there is no node set \"HUB\" in the file"),
        (with("*NODE\n3, 1,2,3\n"), "line 13 (*NODE): node 3 is there twice"),
        (
            with("*ELEMENT, TYPE=C3D4\n2, 1,2,3,9\n"),
            "line 13 (*ELEMENT): element 2 has node 9, which the file does not have",
        ),
        (
            with("*ELEMENT, TYPE=C3D4\n2, 1,2,3\n"),
            "line 13 (*ELEMENT): expected 4 nodes of element 2, a C3D4; 3 are there",
        ),
        (with("*ELEMENT, TYPE=C3D8\n2, 1,1,3,4,5,6,7,8\n"), "line 13 (*ELEMENT): element 2 repeats nodes"),
        (with("*NSET, NSET=A\nHUB\n"), "line 13 (*NSET): there is no node set \"HUB\" in the file"),
        (
            with("*SOLID SECTION, ELSET=EALL, MATERIAL=M\n"),
            "*SOLID SECTION: there is no material \"M\" in the file",
        ),
        (
            with("*INCLUDE, INPUT=other.inp\n"),
            "line 12 (*INCLUDE): the included file \"other.inp\" cannot be read: there is no such file",
        ),
        (with("*PART, NAME=P\n"), "the file ends here, before *END PART"),
        (refused("*NODE\n1, x, 0, 0\n"), "line 2 (*NODE): \"x\" is not a coordinate"),
        (
            refused(&format!("{CUBE}*ELEMENT, TYPE=S4\n1, 1,2,3,4\n")),
            "the file has no solid element (left out: 1 of type S4)",
        ),
    ] {
        assert!(message.starts_with(expected), "{message}\nexpected {expected}");
    }
}

#[test]
fn files_that_include_each_other_end() {
    let itself = |_: &str| Ok(b"*INCLUDE, INPUT=a.inp\n".to_vec());
    let message = read(b"*INCLUDE, INPUT=a.inp\n", &itself).unwrap_err().to_string();
    assert!(message.contains("more than 20 deep"), "{message}");
}

#[test]
fn included_files_have_a_limit_in_all() {
    let count = std::cell::Cell::new(0);
    let twice = |_: &str| {
        count.set(count.get() + 1);
        Ok(b"*INCLUDE, INPUT=a.inp\n".repeat(2))
    };
    let flat = |_: &str| Ok(Vec::new());
    let message = read(b"*INCLUDE, INPUT=a.inp\n", &twice).unwrap_err().to_string();
    assert!(message.contains("more than 20 deep"), "{message}");
    assert!(count.get() < 1001);
    let cards = "*INCLUDE, INPUT=a.inp\n".repeat(1001);
    let message = read(cards.as_bytes(), &flat).unwrap_err().to_string();
    assert_eq!(
        message,
        "line 1001 (*INCLUDE): the included file \"a.inp\" cannot be read: it is one of more than 1000 included files"
    );
}

/// Part of the cube with a tetrahedron, and the cards of its assembly.
fn assembly(cards: &str) -> String {
    format!(
        "*PART, NAME=P\n{CUBE}*ELEMENT, TYPE=C3D4\n1, 1,2,4,5\n*END PART\n*ASSEMBLY, NAME=A\n{cards}*END ASSEMBLY\n"
    )
}

#[test]
fn instances_have_a_limit() {
    let instances = |count: usize| -> String {
        (0..count).map(|k| format!("*INSTANCE, NAME=I{k}, PART=P\n*END INSTANCE\n")).collect()
    };
    let found = mesh(&assembly(&instances(1000)));
    assert_eq!((found.nodes.len(), found.elements[&1000].nodes[3]), (8000, 999 * 8 + 5));
    let message = refused(&assembly(&instances(1001)));
    assert!(
        message.starts_with("line 2015 (*INSTANCE): an assembly of more than 1000 instances cannot be"),
        "{message}"
    );
}

#[test]
fn sets_of_instances_have_a_bound_in_all() {
    // Names count, too: 10 000 sets of a short part, put a thousand times into the assembly.
    let sets: String = (0..10_000).map(|k| format!("*NSET, NSET=S{k}\n1\n")).collect();
    let part = format!("*PART, NAME=P\n{CUBE}{sets}*END PART\n");
    let instances: String =
        (0..1000).map(|k| format!("*INSTANCE, NAME=I{k}, PART=P\n*END INSTANCE\n")).collect();
    let message = refused(&format!("{part}{instances}"));
    assert!(message.contains("(*INSTANCE): a deck whose sets of sets, ranges and instances"), "{message}");
}

#[test]
fn numbers_of_instances_stay_in_range() {
    let far = CUBE.replace("8, 0,1,1", "1000000000000000, 0,1,1");
    let part = format!("*PART, NAME=P\n{far}*ELEMENT, TYPE=C3D4\n1, 1,2,4,5\n*END PART\n");
    let one = "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n";
    assert_eq!(mesh(&format!("{part}{one}")).nodes.len(), 8);
    let message = refused(&format!("{part}{one}{}", one.replace("=I", "=J")));
    assert!(message.contains("(*INSTANCE): an assembly with a node number above 10000"), "{message}");
}

#[test]
fn sets_of_unknown_instances_are_refused() {
    let one = "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n";
    assert_eq!(mesh(&assembly(&format!("{one}*NSET, NSET=A, INSTANCE=i\n1, 1\n"))).node_sets["A"], [1]);
    for set in ["*NSET, NSET=A", "*ELSET, ELSET=A"] {
        let message = refused(&assembly(&format!("{one}{set}, INSTANCE=X\n1\n")));
        assert!(message.contains("): there is no instance \"X\" in the file"), "{message}");
    }
}

#[test]
fn cards_that_change_the_model_are_refused() {
    for card in
        ["MODEL CHANGE, REMOVE", "MATRIX INPUT, NAME=K", "MATRIX ASSEMBLE", "FASTENER", "NMAP, NSET=A"]
    {
        let message = refused(&format!("{CUBE}{BRICK}*{card}\n1, 2\n"));
        assert!(message.starts_with("line 12 (*"), "{message}");
        assert!(message.contains("cannot be carried over"), "{message}");
    }
    let found = mesh(&format!("{CUBE}{BRICK}*MATRIX GENERATE, MASS\n*MATRIX OUTPUT, MASS\n"));
    assert!(found.notes.is_empty(), "{:?}", found.notes);
}

#[test]
fn transforms_are_frames_of_nodes() {
    let transform = "*TRANSFORM, NSET=NALL, TYPE=C\n0, 0, 0, 0, 0, 1\n";
    let found = mesh(&format!("{CUBE}{BRICK}{transform}{transform}"));
    assert_eq!(found.nodal_frames, Some((12, "*TRANSFORM".to_owned())));
    assert!(found.notes.is_empty());
    assert_eq!(mesh(&format!("{CUBE}{BRICK}")).nodal_frames, None);
}

/// Cut at every byte, and with single bytes changed: an answer or a refusal.
#[test]
fn damage_makes_no_panic() {
    let deck =
        format!("{CUBE}{BRICK}*NSET, NSET=T, GENERATE\n1, 99999999999999, 3\n{STEEL}*BOUNDARY\nT, 1, 3\n");
    for end in 0..deck.len() {
        let _ = read(&deck.as_bytes()[..end], &none);
    }
    let mut state = 7_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for _ in 0..20_000 {
        let mut bytes = deck.clone().into_bytes();
        let at = random(bytes.len());
        bytes[at] = b"0123456789,=*-+.eE\n \0\xffTNP"[random(25)];
        let _ = read(&bytes, &none);
    }
}
