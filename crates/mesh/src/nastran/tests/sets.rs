//! Sets of nodes.

use super::decks::{CUBE, TETRAHEDRON, deck, with};

#[test]
fn sets_of_the_bulk_data() {
    let mesh = with("SET1,5,3,1,THRU,4\nSET1,6,1,99\nSET1,7,ALL").unwrap();
    assert_eq!(mesh.node_sets, [("5".to_owned(), vec![3, 1, 2, 4])].into());
    assert_eq!(mesh.notes, [""; 0]);
}

#[test]
fn sets_of_case_control() {
    let sets = "SET 1 = 1, 2,$ two\n  5 THRU 7\nSET 2=8\nSET 3 = ALL\nSET 4 = 0.5,1.5\nSET 5 = 1 THRU 8 EXCEPT 3\n\
                SET 6 = 100 THRU 200\nDISPLACEMENT(PLOT) = 1\nSET 2 = 7";
    let mesh = deck(&format!("{sets}\nBEGIN BULK\n{CUBE}{TETRAHEDRON}SET1,2,6\nENDDATA")).unwrap();
    assert_eq!(mesh.node_sets, [("1".to_owned(), vec![1, 2, 5, 6, 7]), ("2".to_owned(), vec![8])].into());
    let notes = ["sets with EXCEPT or BY are not read", "of several sets of one number the first is taken"];
    assert_eq!(mesh.notes, notes);
}
