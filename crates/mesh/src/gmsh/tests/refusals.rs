//! Refusals, each with its place.

use super::super::read;
use super::files::{cube, tetrahedron};

fn refusal(bytes: &[u8]) -> String {
    read(bytes).unwrap_err().to_string()
}

#[test]
fn headers_of_other_versions_and_machines() {
    let text = cube("1 4 0 1 2 4 5");
    let other = |from: &str, to: &str| refusal(text.replacen(from, to, 1).as_bytes());
    assert_eq!(
        other("2.2 0 8", "4 0 8"),
        "line 2 ($MeshFormat): version 4 of the MSH format cannot be carried over: save the mesh as version 4.1 \
         (Mesh.MshFileVersion=4.1) or 2.2"
    );
    assert_eq!(other("2.2 0", "2.2 3"), "line 2 ($MeshFormat): \"3\" is not 0 for ASCII or 1 for binary");
    assert_eq!(other("$MeshFormat", "$NOD"), "line 1: expected $MeshFormat at the beginning");
    let binary = tetrahedron().binary_4();
    let place = binary.windows(4).position(|bytes| bytes == [1, 0, 0, 0]).unwrap();
    let mut turned = binary.clone();
    turned[place..place + 4].reverse();
    assert_eq!(
        refusal(&turned),
        "$MeshFormat: a binary file of a big-endian machine cannot be carried over: save the mesh as ASCII (Mesh.Binary=0)"
    );
    turned[place] = 9;
    assert_eq!(refusal(&turned), "$MeshFormat: expected the binary number 1 that marks the order of bytes");
    let mut short = binary;
    short[place - 2] = b'4';
    assert!(refusal(&short).contains("numbers of 4 bytes"));
}

#[test]
fn elements_that_no_model_has() {
    for (of, what) in [
        (12, "a 27-node hexahedron"),
        (13, "an 18-node wedge"),
        (14, "a 14-node pyramid"),
        (29, "a 20-node tetrahedron"),
    ] {
        let found = refusal(cube(&format!("1 {of} 0 1 2 3 4")).as_bytes());
        assert!(
            found
                .starts_with(&format!("line 17 ($Elements): {what} cannot be carried over: mesh with Mesh."))
        );
    }
    assert!(refusal(cube("1 500 0 1").as_bytes()).contains("an element of Gmsh's type 500"));
    assert_eq!(
        refusal(cube("1 2 0 1 2 3\n2 16 0 1 2 3 4 5 6 7 8\n3 15 0 1").as_bytes()),
        "the file has no solid element (left out: 1 of type 3-node triangle, 1 of type 8-node quadrangle, 1 of type point)"
    );
    let parametric = cube("1 4 0 1 2 4 5").replace("$Nodes", "$ParametricNodes");
    assert!(refusal(parametric.as_bytes()).contains("Mesh.SaveParametric=0"));
}

#[test]
fn numbers_that_are_there_twice_or_not() {
    let text = cube("1 4 2 7 1 1 2 4 5");
    let element = |elements: &str| refusal(cube(elements).as_bytes());
    assert_eq!(element("1 4 0 1 2 4 5\n1 4 0 2 3 4 7"), "line 18 ($Elements): element 1 is there twice");
    assert_eq!(element("1 4 0 1 2 4 5\n1 4 0 1 2 4 5"), "line 18 ($Elements): element 1 is there twice");
    assert_eq!(element("1 4 1 7 1 2 4 5\n1 4 1 7 1 2 4 5"), "line 18 ($Elements): element 1 is there twice");
    for of in ["4 0 1 2 4", "3 0 1 2 4"] {
        assert_eq!(
            element(&format!("1 {of} 9")),
            "line 17 ($Elements): element 1 has node 9, which the file does not have"
        );
    }
    let twice = text.replace("\n8 0 1 1", "\n7 0 1 1");
    assert_eq!(refusal(twice.as_bytes()), "line 13 ($Nodes): node 7 is there twice");
    let first = text.replace("$Nodes\n", "$Elements\n1\n1 4 0 1 2 4 5\n$EndElements\n$Nodes\n");
    assert_eq!(refusal(first.as_bytes()), "line 4 ($Elements): expected $Nodes before $Elements");
}

#[test]
fn rows_of_other_lengths_and_words() {
    let element = |elements: &str| refusal(cube(elements).as_bytes());
    assert_eq!(element("1 4 0 1 2 4"), "line 17 ($Elements): expected a node number");
    assert_eq!(
        element("1 4 0 1 2 4 5 6 7"),
        "line 17 ($Elements): expected the end of the line before \"6 7\""
    );
    assert_eq!(element("1 4 0 1 2 4 x"), "line 17 ($Elements): \"x\" is not a node number");
    assert_eq!(element("1 4 0 1 2 4 -5"), "line 17 ($Elements): \"-5\" is not a node number");
    let text = cube("1 4 0 1 2 4 5");
    let one_more = text.replace("$Elements\n1\n", "$Elements\n2\n");
    assert_eq!(
        refusal(one_more.as_bytes()),
        "line 18 ($Elements): \"$EndElements\" is not an element number"
    );
    let one_less = text.replace("$Nodes\n8\n", "$Nodes\n7\n");
    assert_eq!(refusal(one_less.as_bytes()), "line 13 ($Nodes): expected $EndNodes");
    let infinite = text.replace("8 0 1 1", "8 0 1 1e999");
    assert_eq!(refusal(infinite.as_bytes()), "line 13 ($Nodes): \"1e999\" is not a coordinate");
}

#[test]
fn counts_beyond_the_file() {
    let text = cube("1 4 0 1 2 4 5");
    let claim = text.replace("$Nodes\n8\n", "$Nodes\n900000000000000\n");
    assert_eq!(
        refusal(claim.as_bytes()),
        "line 5 ($Nodes): the file ends here, before the end of 900000000000000 nodes: is it cut short?"
    );
    let end = text.find("$Elements").unwrap();
    assert_eq!(
        refusal(&text.as_bytes()[..end]),
        "line 14: the file ends here, before $Elements: is it cut short?"
    );
    let end = text.find("4 5\n$End").unwrap();
    assert_eq!(
        refusal(&text.as_bytes()[..end]),
        "line 17 ($Elements): the file ends here, before a node number: is it cut short?"
    );
    assert!(refusal(format!("{text}$Own\n1\n").as_bytes()).contains("before $EndOwn"));
}

#[test]
fn entities_in_too_many_groups() {
    let text = String::from_utf8(tetrahedron().ascii_4()).unwrap();
    let start = text.find("$Entities").unwrap();
    let end = text.find("$EndEntities").unwrap();
    let with = |count: usize| {
        let groups = " 7".repeat(count);
        let entities = format!("$Entities\n0 0 1 1\n1 0 0 0 1 1 1 0 0\n1 0 0 0 1 1 1 {count}{groups} 0\n");
        format!("{}{entities}{}", &text[..start], &text[end..])
    };
    let read = |count: usize| read(with(count).as_bytes()).map_err(|error| error.to_string());
    assert!(read(1).is_ok());
    assert!(read(1001).unwrap_err().contains("an entity in more than 1000 physical groups cannot be"));
    // Elements of many groups have a bound in all, before they are read.
    let text = with(1000).replace("3 1 4 1\n", "3 1 4 20021\n") + &"\n".repeat(2_000_000);
    assert!(refusal(text.as_bytes()).contains("physical groups share more than 100000000 numbers"));
}
