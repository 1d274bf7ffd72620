//! Refusals of elements and of cards that change the model.

use super::decks::{CUBE, deck, refusal};

#[test]
fn numbers_that_are_there_twice_or_not() {
    assert_eq!(refusal("GRID,8"), "line 10 (GRID): node 8 is there twice");
    assert_eq!(refusal("CTETRA,1,1,2,3,4,7"), "line 10 (CTETRA): element 1 is there twice");
    assert_eq!(
        refusal("CPYRAM,2,1,1,2,3,4,9"),
        "line 10 (CPYRAM): element 2 has node 9, which the file does not have"
    );
    assert_eq!(deck(CUBE).unwrap_err().to_string(), "the file has no solid element");
}

#[test]
fn elements_with_other_numbers_of_nodes() {
    assert_eq!(refusal("CTETRA,2,1,1,2,3"), "line 10 (CTETRA): expected 4 nodes at corners");
    assert_eq!(refusal("CTETRA,2,1,1,2,3,x"), "line 10 (CTETRA): \"x\" is not a node number");
    assert_eq!(refusal("CTETRA,,1,1,2,3,4"), "line 10 (CTETRA): expected an element number");
    assert_eq!(
        refusal("CTETRA,2,1,1,2,3,4,5,6\n,7,8,1,2,3"),
        "line 10 (CTETRA): expected no more than 10 nodes"
    );
    for middles in ["5,6\n,7,8,1", "5,0\n,7,8,1,2"] {
        assert!(refusal(&format!("CTETRA,2,1,1,2,3,4,{middles}")).starts_with(
            "line 10 (CTETRA): an element with nodes on some of its edges only cannot be carried over"
        ));
    }
    assert!(refusal("CHEXA,2,1,1,2,3,4,5,6\n,7,8,1").contains("nodes on some of its edges only"));
    assert!(refusal("CHEXA,2,1,1,2,3,4,5,6\n,7,1").contains("element 2 repeats nodes"));
}

#[test]
fn cards_that_change_the_model() {
    for (cards, what) in [
        ("RBE2,1,1,123,2", "a rigid element"),
        ("RBE3,1,,1,123,1.,123,2", "a rigid element"),
        ("RBAR,1,1,2", "a rigid element"),
        ("MPC,1,1,1,1.,2,1,1.", "a multi-point constraint"),
        ("CELAS2,1,1.,1,1", "a spring"),
        ("CBUSH,1,1,1,2", "a spring"),
        ("CDAMP1,1,1,1,1", "a damper"),
        ("CONM2,1,1,,1.", "a point mass"),
        ("CONM1,1,1", "a point mass"),
        ("CWELD,1", "a connector"),
        ("CINTC,1,1,1,2", "a connector"),
        ("BGSET,1", "contact or glue"),
        ("DMIG,K", "a matrix"),
        ("PCOMPS,1", "a property of layers or of large strains"),
        ("=,*(1),=", "a card that repeats the one before it"),
        ("BEGIN SUPER=1", "a second BEGIN, as superelements have it,"),
    ] {
        let found = refusal(cards);
        assert!(found.starts_with("line 10 (") && found.contains(&format!("): {what} cannot be")), "{found}");
    }
}

#[test]
fn coordinates_that_are_no_numbers() {
    assert_eq!(refusal("GRID,9,,1.x"), "line 10 (GRID): \"1.x\" is not a coordinate");
    assert_eq!(refusal("GRID,-9"), "line 10 (GRID): \"-9\" is not a node number");
    assert_eq!(refusal("GRID,9,,1e999"), "line 10 (GRID): \"1e999\" is not a coordinate");
}
