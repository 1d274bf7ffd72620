//! Supports: permanent ones, SPC and SPC1.

use super::decks::{CUBE, TETRAHEDRON, deck, refusal, with};

fn held(cards: &str) -> Vec<u64> {
    with(cards).unwrap_or_else(|error| panic!("{cards}: {error}")).held.into_iter().collect()
}

#[test]
fn nodes_held_in_all_directions() {
    assert_eq!(held("SPC1,1,123,1,THRU,3\n"), [1, 2, 3]);
    assert_eq!(held("SPC1,1,123456,1,4,2"), [1, 2, 4]);
    assert_eq!(held("SPC1,1,123,1,2,3,4,5,6\n,7,8"), [1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(held("SPC,1,1,123,0.,4,123456,0."), [1, 4]);
    assert_eq!(
        held("SPC1,1,12,1,THRU,5\nSPC1,1,3,4,THRU,7\nSPC1,1,3,1,2,3\nSPC1,1,12,6,7"),
        [1, 2, 3, 4, 5, 6, 7]
    );
    assert_eq!(held("GRID,9,,,,,,123\nGRID,10,,,,,,456\nSPC1,1,456,1"), [9]);
    // Nodes of no solid element may be held in part, and a range may go beyond the nodes.
    assert_eq!(
        held(
            "GRID,4000,,,,,,12\nSPC1,1,12,900,THRU,5000\nSPC1,1,123,5,THRU,99\nSPC1,1,1,4000,THRU,1000000000000000000"
        ),
        [5, 6, 7, 8]
    );
    let defaults = with("GRDSET,,,,,,,123\nGRID,9\nGRID,10,,,,,,0\nSPC1,1,0,3").unwrap();
    assert!(defaults.held.contains(&9) && defaults.held.contains(&1) && !defaults.held.contains(&10));
}

#[test]
fn supports_in_single_directions_and_moved_ones_are_refused() {
    assert_eq!(
        refusal("SPC1,1,123,2\nSPC1,1,12,1,2"),
        "line 11 (SPC1): the support of node 1 in some directions only cannot be carried over: \
         hold all three displacements (123) of a node, or none"
    );
    assert!(refusal("SPC,1,4,3").starts_with("line 10 (SPC): the support of node 4"));
    assert!(refusal("SPC,1,4,123,.5").starts_with("line 10 (SPC): a displacement that is not zero"));
    assert_eq!(refusal("SPC1,1,123,99"), "line 10 (SPC1): there is no node \"99\" in the file");
    assert_eq!(
        refusal("SPC1,1,17,1"),
        "line 10 (SPC1): \"17\" is not components of displacement, such as 123"
    );
    for ranges in ["", "1,THRU", "THRU,2", "5,THRU,1", "1,x"] {
        assert!(refusal(&format!("SPC1,1,123,{ranges}")).contains("expected node numbers"), "{ranges}");
    }
}

#[test]
fn case_control_selects_supports() {
    let all = |control: &str| {
        let cards = "SPC1,1,123,1\nSPC1,2,123,2\nSPC1,3,123,3\nSPCADD,8,1,3";
        let mesh = deck(&format!("{control}\nBEGIN BULK\n{CUBE}{TETRAHEDRON}{cards}\nENDDATA")).unwrap();
        (mesh.held.into_iter().collect::<Vec<_>>(), mesh.notes.len())
    };
    assert_eq!(all("SPC = 2"), (vec![2], 0));
    assert_eq!(all("spc=8\nSPCFORCES = ALL"), (vec![1, 3], 0));
    assert_eq!(all("SUBCASE 1\n SPC = 2\nSUBCASE 2\n SPC = 3"), (vec![2, 3], 1));
    assert_eq!(all(""), (vec![1, 2, 3], 1));
}
