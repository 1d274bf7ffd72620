//! Lines, continuations, control and included files.

use super::super::read;
use super::decks::{CUBE, TETRAHEDRON, deck, with};
use crate::error::MeshFileError;

#[test]
fn control_comments_and_what_follows_the_end_are_skipped() {
    let text = format!(
        "SOL 103\nCEND\nTITLE = GRID,1,2\nbegin bulk\n$ comment\n{CUBE}\n\r\n{TETRAHEDRON}enddata\nRBE2,1,1,123,2\n"
    );
    let mesh = deck(&text).unwrap();
    assert_eq!((mesh.nodes.len(), mesh.elements.len()), (8, 1));
    assert_eq!(mesh.elements[&1].line, 16);
    assert_eq!(mesh.notes, [""; 0]);
    let cut = text.replace("enddata", "$");
    assert_eq!(
        deck(&cut).unwrap_err().to_string(),
        "line 18 (RBE2): a rigid element cannot be carried over: a model is of solid elements only: \
         model it by these, or take it out of the file"
    );
    let cut = deck(text.split("enddata").next().unwrap()).unwrap_err();
    assert_eq!(cut.to_string(), "line 16: the file ends here, before ENDDATA: is it cut short?");
    let cut = deck("SOL 103\nCEND\n").unwrap_err();
    assert_eq!(cut.to_string(), "line 2: the file ends here, before BEGIN BULK: is it cut short?");
}

#[test]
fn tabs_lower_case_and_comments_on_a_line() {
    let mesh = with("grid\t9\t\t1.5\t2.5+1\t-1.D0\t$ behind, with commas\nGRID          10\n").unwrap();
    assert_eq!(mesh.nodes[&9], [1.5, 25.0, -1.0]);
    assert_eq!(mesh.nodes[&10], [0.0; 3]);
}

#[test]
fn long_and_short_lines_in_one_card() {
    let grid = "GRID*                  9                            1.25             2.5\n*                    3.5\n";
    assert_eq!(with(grid).unwrap().nodes[&9], [1.25, 2.5, 3.5]);
    // A long line alone, then a short one: fields 5 to 8 are empty.
    let element =
        "CPENTA*                2               1               1               2\n        4       5\n";
    assert!(with(element).unwrap_err().to_string().contains("expected 6 nodes at corners"));
}

#[test]
fn marks_of_continuation_are_held_against_each_other() {
    let card = |mark: &str| {
        let first =
            format!("{:<72}+A", "CHEXA          2       1       1       2       3       4       5       6");
        format!("{first}\n{mark:8}       7       8\n")
    };
    for good in ["+A", "+", ""] {
        assert_eq!(with(&card(good)).unwrap().elements.len(), 2, "{good}");
    }
    // Blanks within a mark, and numbers as marks between commas.
    let blanks = card("+      1").replace("+A", "+      1");
    for good in [blanks.as_str(), "CHEXA,2,1,1,2,3,4,5,6,+1\n+1,7,8", "CHEXA,2,1,1,2,3,4,5,6,\n,7,8,,,,,,,"] {
        assert_eq!(with(good).unwrap().elements.len(), 2, "{good}");
    }
    let error = with(&card("+B")).unwrap_err();
    assert_eq!(error.to_string(), "line 11 (CHEXA): expected the continuation +A behind its card");
    assert_eq!(deck("+A,1").unwrap_err().to_string(), "line 1: expected a card before its continuation");
    let many = with("CTETRA,2,1,1,2,3,4,5,6,7").unwrap_err();
    assert_eq!(
        many.to_string(),
        "line 10 (CTETRA): expected no more than 8 fields between commas, and a line of continuation"
    );
}

#[test]
fn included_files_stand_in_their_place() {
    let include = |name: &str| match name {
        "grids/cube.bdf" => Ok(CUBE.as_bytes().to_vec()),
        "bad" => Ok(b"\nGRID,x\n".to_vec()),
        "itself" => Ok(b"INCLUDE itself".to_vec()),
        "twice" => Ok(b"INCLUDE 'empty'\n".repeat(2000)),
        "empty" => Ok(Vec::new()),
        _ => Err("it is not in the upload".to_owned()),
    };
    let deck = |text: &str| read(text.as_bytes(), &include);
    let refusal = |text: &str| deck(text).unwrap_err().to_string();
    for name in ["'grids/cube.bdf'", "\"grids/cube.bdf\" $ nodes", "grids/cube.bdf", "'grids/\n   cube.bdf'"]
    {
        let mesh = deck(&format!("include {name}\n{TETRAHEDRON}")).unwrap();
        assert_eq!(mesh.nodes.len(), 8, "{name}");
    }
    assert_eq!(refusal("INCLUDE bad"), "line 2 (GRID in bad): \"x\" is not a node number");
    assert_eq!(
        refusal("\nINCLUDE none"),
        "line 2 (INCLUDE): the included file \"none\" cannot be read: it is not in the upload"
    );
    assert_eq!(
        refusal("INCLUDE itself"),
        "line 1 (INCLUDE in itself): files include each other more than 8 deep"
    );
    assert!(refusal("INCLUDE twice").contains("it is one of more than 1000 included files"));
    for nameless in ["INCLUDE ", "INCLUDE ''", "INCLUDE 'open\n"] {
        assert_eq!(refusal(nameless), "line 1 (INCLUDE): expected the name of a file, such as 'mesh.bdf'");
    }
}

#[test]
fn cards_that_are_skipped_left_out_or_unknown() {
    let cards = "PARAM,POST,-1\nEIGRL,1,,,10\nFORCE,1,1,0,1.,1.,0.,0.\nPSHELL,5,1,.1\nCQUAD4,9,5,1,2,3,4\nCQUAD4,10,5,1,2,3,4\n\
                 CBAR,11,1,1,2\nCONROD,12,1,1,2\nFLUTTER,1\nFLUTTER,2\n";
    let mesh = with(cards).unwrap();
    let left_out = [("CBAR", 1), ("CONROD", 1), ("CQUAD4", 2)];
    assert_eq!(mesh.left_out, left_out.map(|(name, count)| (name.to_owned(), count)).into());
    assert_eq!(mesh.notes, ["cards FLUTTER are not read"]);
    let without: Result<_, MeshFileError> = deck(&format!("{CUBE}CTRIA3,1,1,1,2,3"));
    assert_eq!(
        without.unwrap_err().to_string(),
        "the file has no solid element (left out: 1 of type CTRIA3)"
    );
}
