use std::fmt::Write;

use rubmap_solid::defect::defect;
use rubmap_solid::element::ElementKind;
use rubmap_solid::natural::{CORNERS, EDGES};
use rubmap_solid::topology::Topology;

use super::*;

/// Archive with nodes, one element type and one element, and more commands behind.
fn archive(etype: &str, positions: &[[f64; 3]], nodes: &[u64], more: &str) -> String {
    let mut text = format!("/COM,ANSYS RELEASE 2023\n/PREP7\nET,1,{etype}\n{more}\n");
    text += &nblock(positions);
    text += "EBLOCK,19,SOLID,1,1\n(19i9)\n";
    text += &element(7, 1, nodes);
    text + "       -1\n"
}

fn nblock(positions: &[[f64; 3]]) -> String {
    let mut text = "NBLOCK,6,SOLID,99,99\n(3i9,6e21.13e3)\n".to_owned();
    for (k, [x, y, z]) in positions.iter().enumerate() {
        let id = k + 1;
        writeln!(text, "{id:9}{:9}{:9}{x:21.13e}{y:21.13e}{z:21.13e}{:21.13e}", 0, 0, 30.0).expect("text");
    }
    text + "N,R5.3,LOC,       -1,\n"
}

fn element(id: u64, material: u64, nodes: &[u64]) -> String {
    let mut text = String::new();
    for number in [material, 1, 1, 1, 0, 0, 0, 0, nodes.len() as u64, 0, id] {
        write!(text, "{number:9}").expect("text");
    }
    for (k, node) in nodes.iter().enumerate() {
        let separator = if k == 8 { "\n" } else { "" };
        write!(text, "{separator}{node:9}").expect("text");
    }
    text + "\n"
}

/// Positions of an element's nodes: mid-edge nodes in the middles of the edges of Ansys's order, which is stated here anew.
fn middles(corners: &[[f64; 3]], edges: &[[usize; 2]]) -> Vec<[f64; 3]> {
    let middle = |&[a, b]: &[usize; 2]| std::array::from_fn(|d| 0.5 * (corners[a][d] + corners[b][d]));
    corners.iter().copied().chain(edges.iter().map(middle)).collect()
}

/// Edges of SOLID186: Q R S T, U V W X, Y Z A B.
const SOLID186: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
/// Edges of SOLID187: M between I and J, N J–K, O K–I, P I–L, Q J–L, R K–L.
const SOLID187: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

fn tetrahedron() -> Vec<[f64; 3]> {
    Topology::of(ElementKind::C3D4).nodes()
}

fn numbered(count: usize) -> Vec<u64> {
    (1..=count as u64).collect()
}

/// Kind of the only element, which must be whole.
fn kind_of(text: &str) -> ElementKind {
    let mesh = read(text.as_bytes()).expect("a mesh");
    let element = &mesh.elements[&7];
    let positions: Vec<[f64; 3]> = element.nodes.iter().map(|node| mesh.nodes[node]).collect();
    assert_eq!(defect(element.kind, &positions), None, "{text}");
    element.kind
}

fn refusal(text: &str) -> String {
    read(text.as_bytes()).expect_err("a refusal").to_string()
}

fn hexahedron(more: &str) -> String {
    archive("185", &CORNERS, &numbered(8), more)
}

#[test]
fn elements_of_every_type() {
    use ElementKind::{C3D4, C3D8I, C3D10, C3D20, C3D20R};
    let brick = middles(&CORNERS, &SOLID186);
    let tetrahedron10 = middles(&tetrahedron(), &SOLID187);
    for (etype, positions, more, kind) in [
        ("185", CORNERS.to_vec(), "", C3D8I),
        ("SOLID45", CORNERS.to_vec(), "", C3D8I),
        ("SOLID186", brick.clone(), "", C3D20R),
        ("186", brick.clone(), "KEYOP,1,2,1", C3D20),
        ("186,,1", brick.clone(), "", C3D20),
        ("95", brick.clone(), "", C3D20),
        ("95", brick, "KEYOPT,1,11,1", C3D20R),
        ("187", tetrahedron10.clone(), "", C3D10),
        ("solid92", tetrahedron10, "", C3D10),
        ("285", tetrahedron(), "", C3D4),
    ] {
        let text = archive(etype, &positions, &numbered(positions.len()), more);
        assert_eq!(kind_of(&text), kind, "{etype} {more}");
    }
    let mesh = read(hexahedron("").as_bytes()).expect("a mesh");
    assert_eq!(mesh.notes, ["SOLID185 is read as C3D8I: hexahedra with incompatible modes"]);
    assert_eq!(mesh.elements[&7].line, 18);
}

#[test]
fn collapsed_bricks() {
    use ElementKind::{C3D4, C3D5, C3D6, C3D10, C3D13, C3D15};
    // Corners that are one node, as Ansys writes each shape.
    let wedge = [0, 1, 2, 2, 4, 5, 6, 6];
    let pyramid = [0, 1, 2, 3, 4, 4, 4, 4];
    let tetrahedron = [0, 1, 2, 2, 4, 4, 4, 4];
    for (same, linear, quadratic) in
        [(wedge, C3D6, C3D15), (pyramid, C3D5, C3D13), (tetrahedron, C3D4, C3D10)]
    {
        let nodes: Vec<u64> = same.iter().map(|&k: &usize| k as u64 + 1).collect();
        assert_eq!(kind_of(&archive("185", &CORNERS, &nodes, "")), linear);
        let corners = same.map(|k| CORNERS[k]);
        let positions = middles(&corners, &SOLID186);
        let mut nodes = nodes;
        for (k, [a, b]) in EDGES.into_iter().enumerate() {
            nodes.push(if same[a] == same[b] { nodes[a] } else { k as u64 + 9 });
        }
        // Edges that fall together have one node.
        for k in 8..20 {
            let twin = (8..k).find(|&j| positions[j] == positions[k] && nodes[j] > 8);
            nodes[k] = twin.filter(|_| nodes[k] > 8).map_or(nodes[k], |j| nodes[j]);
        }
        assert_eq!(kind_of(&archive("186", &positions, &nodes, "")), quadratic);
    }
    let nodes = [1, 1, 3, 4, 5, 6, 7, 8];
    assert!(refusal(&archive("185", &CORNERS, &nodes, "")).contains("element 7 repeats nodes"));
}

#[test]
fn dropped_nodes_are_refused() {
    let positions = middles(&CORNERS, &SOLID186);
    let mut nodes = numbered(20);
    nodes[15] = 0;
    assert!(refusal(&archive("186", &positions, &nodes, "")).contains("dropped mid-edge nodes"));
    assert!(refusal(&archive("186", &positions, &nodes[..8], "")).contains("dropped mid-edge nodes"));
    assert!(refusal(&archive("187", &positions, &nodes[..9], "")).contains("dropped mid-edge nodes"));
    assert!(refusal(&archive("186", &positions, &nodes[..7], "")).contains("20 nodes of element 7"));
    let mut wedge = vec![1, 2, 3, 3, 5, 6, 7, 7];
    wedge.extend([0; 12]);
    assert!(refusal(&archive("186", &positions, &wedge, "")).contains("dropped mid-edge nodes"));
}

#[test]
fn formats_of_nodes() {
    let nodes = "nblock,3\r\n(1i9,3e21.9e3)\r\n        1      1.000000000E+000\r\n        2 -2.5D0\r\n-1\r\n";
    let more = format!("{nodes}EBLOCK,19,SOLID\r\n(19i8)\r\n      -1\r\n");
    let error = refusal(&more);
    assert_eq!(error, "the file has no solid element");
    let mut mesh = MeshFile::new(MeshFormat::Ansys);
    let mut lines = Lines::new(nodes.as_bytes());
    lines.bytes();
    nblock::read(&mut lines, &mut mesh).expect("nodes");
    assert_eq!(mesh.nodes[&1], [1.0, 0.0, 0.0]);
    assert_eq!(mesh.nodes[&2], [-2.5, 0.0, 0.0]);
}

#[test]
fn rotated_nodes_are_reported() {
    let frames = |text: &str| read(text.as_bytes()).unwrap().nodal_frames;
    let text = archive("285", &tetrahedron(), &numbered(4), "");
    assert_eq!(frames(&text), Some((7, "NBLOCK".to_owned())));
    let angle = format!("{:21.13e}", 30.0);
    assert_eq!(frames(&text.replace(&angle, &format!("{:21.13e}", 0.0))), None);
    assert_eq!(frames(&text.replace(&angle, "")), None);
    assert!(refusal(&text.replacen(&angle, " x", 1)).contains("\"x\" is not an angle of rotation"));
}

#[test]
fn left_out_and_refused_types() {
    let surface = "ET,2,154\nET,3,188\nEBLOCK,10,,,2\n(15i9)\n       20        2        1        1       12        1        2        3        4\n       21        3        1        1       12        1        2\n       -1";
    let mesh = read(hexahedron(surface).as_bytes()).expect("a mesh");
    let left_out: Vec<_> = mesh.left_out.iter().map(|(name, &count)| (name.as_str(), count)).collect();
    assert_eq!(left_out, [("BEAM188", 1), ("SURF154", 1)]);
    for (etype, name) in [
        ("174", "line 18 (EBLOCK): CONTA174 cannot"),
        ("170", "TARGE170"),
        ("14", "COMBIN14"),
        ("21", "MASS21"),
        ("184", "MPC184"),
        ("226", "element type 226"),
        ("190", "SOLSH190"),
        ("186,,,1", "SOLID186"),
    ] {
        let error = refusal(&archive(etype, &CORNERS, &numbered(8), ""));
        assert!(error.contains(name), "{error}");
    }
    let shells = refusal(&archive("SHELL181", &CORNERS, &numbered(4), ""));
    assert_eq!(shells, "the file has no solid element (left out: 1 of type SHELL181)");
    let loose = hexahedron("EBLOCK,10\n(15i9)\n        8        1        1        1       12        1\n-1");
    assert!(refusal(&loose).contains("SOLID185 in a block without SOLID"));
    assert!(refusal(&archive("X", &CORNERS, &numbered(8), "")).contains("is not an element type"));
    let undefined = archive("185", &CORNERS, &numbered(8), "").replace("ET,1,", "ET,9,");
    assert!(refusal(&undefined).contains("no element type \"1\""));
    let block = undefined.replace("ET,9,185", "ETBLOCK,1,1\n(2i9,19a9)\n        1      185\n       -1");
    assert_eq!(kind_of(&block), ElementKind::C3D8I);
}

#[test]
fn constraints_and_unblocked_lists_are_refused() {
    for (command, what) in [
        ("CE,R5.0,DEFI,2,1", "line 4 (CE): a constraint equation (CE) cannot be carried over"),
        ("CERIG,1,2", "constraint equation (CERIG)"),
        ("CP,1,UX,1,2", "coupled displacements (CP)"),
        ("N,R5.3,LOC,1,0,0,0", "of its own (N)"),
        ("EN,R5.5,ATTR,8", "of its own (EN)"),
        ("MP,EX,1,1,2", "EX as a polynomial"),
    ] {
        let error = refusal(&hexahedron(command));
        assert!(error.contains(what), "{error}");
    }
    for command in ["N,UNBL,LOC,       -1,", "! CE,1", "*SET,CE,1", "/TITLE,CE", "ALLSEL", "SFE,1,1,PRES,,1"]
    {
        assert!(read(hexahedron(command).as_bytes()).is_ok(), "{command}");
    }
}

#[test]
fn sets() {
    let sets = "CMBLOCK,FIXED   ,NODE,       3  ! held\n(8i10)\n         1        -3         8\n\
                CMBLOCK,BLADE,ELEM,2\n(8i10)\n         7       -20\nCMBLOCK,AREAS,AREA,1\n(8i10)\n         1\n\
                CMBLOCK,MAT1,ELEMENT,1\n(8i10)\n         7";
    let mesh = read(hexahedron(sets).as_bytes()).expect("a mesh");
    assert_eq!(mesh.node_sets.len(), 1);
    assert_eq!(mesh.node_sets["FIXED"], [1, 2, 3, 8]);
    let names: Vec<_> = mesh.element_sets.keys().map(String::as_str).collect();
    assert_eq!(names, ["BLADE", "MAT1", "MAT1_"]);
    assert_eq!(mesh.element_sets["BLADE"], BTreeSet::from([7]));
    let many = "CMBLOCK,ALL,NODE,4\n(8i10)\n         1-999999999         5      -100";
    let mesh = read(hexahedron(many).as_bytes()).expect("a mesh");
    assert_eq!(mesh.node_sets["ALL"], numbered(8));
    let missing = "CMBLOCK,ALL,NODE,1\n(8i10)\n       100";
    let mesh = read(hexahedron(missing).as_bytes()).expect("a mesh");
    assert!(mesh.notes.iter().any(|note| note.ends_with("does not have: ALL")), "{:?}", mesh.notes);
    for (entries, what) in [
        ("         5        -3", "end of a range"),
        ("        -3", "end of a range"),
        ("         x", "node or"),
    ] {
        let error = refusal(&hexahedron(&format!("CMBLOCK,A,NODE,2\n(8i10)\n{entries}")));
        assert!(error.contains(what), "{error}");
    }
    let endless = hexahedron("CMBLOCK,A,NODE,1000000000000000000\n(8i10)\n         1");
    assert!(refusal(&endless).contains("CMBLOCK"));
}

#[test]
fn materials() {
    let mesh = |more: &str| read(hexahedron(more).as_bytes()).expect("a mesh");
    let one = mesh(
        "MP,EX,1,2.1e11\nMPTEMP,R5.0, 1, 1,  0.0    ,\nMPDATA,R5.0, 1,NUXY,     1, 1, 0.3    ,\nMPDATA,R5.0,1,DENS,1,1,7850.,",
    );
    let material = &one.materials["1"];
    assert_eq!(material.elastic.len(), 1);
    let row = material.elastic[0];
    assert_eq!((row.youngs_modulus, row.poissons_ratio, row.temperature), (2.1e11, 0.3, None));
    assert_eq!((material.density[0].density, material.density[0].temperature), (7850.0, None));
    assert_eq!(one.sections, [("MAT1".to_owned(), "1".to_owned())]);
    let two = mesh(
        "MPTEMP,1,20,220\nMPDATA,EX,1,1,2e11,1.8e11\nMP,PRXY,1,0.25\nMP,EY,1,1\nMPDATA,EY,1,1,2e11,1.8e11",
    );
    let rows: Vec<_> =
        two.materials["1"].elastic.iter().map(|row| (row.temperature, row.youngs_modulus)).collect();
    assert_eq!(rows, [(Some(20.0), 2e11), (Some(220.0), 1.8e11)]);
    let default = mesh("MP,EX,1,1\nMP,DENS,2,1\nTB,PLAS,1");
    assert_eq!(default.materials["1"].elastic[0].poissons_ratio, 0.3);
    assert_eq!(default.materials.len(), 2);
    assert_eq!(default.sections.len(), 1);
    assert_eq!(default.notes.len(), 3);
    assert!(mesh("").sections.is_empty());
    mesh("MP,EX,1,2.6\nMP,NUXY,1,0.3\nMP,GXY,1,1.0");
    mesh("MP,EX,9,2.6\nMP,EY,9,3");
    for other in ["MP,EY,1,2.0", "MP,EZ,1,2.0", "MP,GXY,1,2.0", "MP,PRYZ,1,0.2", "TB,ANEL,1"] {
        let error = refusal(&hexahedron(&format!("MP,EX,1,2.6\nMP,PRXY,1,0.3\n{other}")));
        assert!(error.starts_with("line 6 (MPDATA): material 1, anisotropic"), "{error}");
    }
    let unstated = refusal(&hexahedron("MPDATA,EX,1,1,1,2"));
    assert!(unstated.contains("a temperature for each value"), "{unstated}");
}

#[test]
fn supports() {
    let mesh = |more: &str| read(hexahedron(more).as_bytes());
    let held = mesh(
        "D,1,ALL,0\nD,      2,UX  ,  0.000000000    ,  0.000000000\nD,2,UY,0\nD,2,UZ,\nD,3,UX,0,,,,UY,UZ\nD,4,TEMP,5",
    );
    assert_eq!(held.expect("a mesh").held, BTreeSet::from([1, 2, 3]));
    for (command, what) in [
        ("D,1,UX,0", "line 4 (D): a support of node 1 in some directions"),
        ("D,1,ALL,1.5", "the displacement 1.5 of node 1"),
        ("D,1,UX,%TABLE%", "is not a displacement"),
        ("D,ALL,ALL,0", "a support of \"ALL\""),
        ("D,1,ALL,0,,5", "a support of \"1\""),
        ("D,99,ALL,0", "no node \"99\""),
    ] {
        let error = mesh(command).expect_err(command).to_string();
        assert!(error.contains(what), "{error}");
    }
}

#[test]
fn numbers_that_are_twice_or_missing() {
    let text = hexahedron("");
    let twice = text.replacen("        2        0", "        1        0", 1);
    assert!(refusal(&twice).contains("line 8 (NBLOCK): node 1 is there twice"), "{}", refusal(&twice));
    let element = element(7, 1, &numbered(8));
    let twice = text.replace(&element, &element.repeat(2));
    assert_eq!(refusal(&twice), "line 19 (EBLOCK): element 7 is there twice");
    let missing = archive("185", &CORNERS, &[1, 2, 3, 4, 5, 6, 7, 11], "");
    assert_eq!(refusal(&missing), "line 18 (EBLOCK): element 7 has node 11, which the file does not have");
    for text in ["NBLOCK,6,SOLID\n(3i9,6e21.13e3)\n        1\n", "NBLOCK,6\n", "EBLOCK,19,SOLID\n(19i9)\n"] {
        assert!(refusal(text).contains("is it cut short?"), "{text}");
    }
}

/// Truncated and corrupted files are read or refused, without panic.
#[test]
fn hostile_files() {
    let text = archive(
        "186",
        &middles(&CORNERS, &SOLID186),
        &numbered(20),
        "MP,EX,1,1\nD,1,ALL\nMPTEMP,R5.0,1,1,5\nMPDATA,R5.0,1,EX,1,1,1\nCMBLOCK,A,NODE,2\n(8i10)\n         1        -5\nETBLOCK,1\n(x)\n1 186\n-1",
    );
    let bytes = text.as_bytes();
    (0..bytes.len()).for_each(|end| drop(read(&bytes[..end])));
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    for _ in 0..20_000 {
        let mut other = bytes.to_vec();
        let place = random() % other.len();
        other[place] = random() as u8;
        drop(read(&other));
    }
    let huge = "1".repeat(100_000);
    for text in [
        format!("NBLOCK,6,SOLID,{huge},{huge}\n({huge}i9)\n{huge}"),
        format!("EBLOCK,19,SOLID\n(19i19)\n{}", "1000000000000000000".repeat(19)),
        format!("MPTEMP,{0},1,2\nMPDATA,EX,1,{0},1,2,3", u64::MAX),
        "\0\0\0".to_owned(),
    ] {
        assert!(read(text.as_bytes()).is_err());
    }
}
