//! Tests of all formats together.

mod binary;
mod hostile;
mod refusals;
mod samples;

use super::{FileMatrix, MatrixRow, read, read_named};
use samples::{MAPPING, SAMPLES};

/// Matrix of all samples.
fn expected(format: &'static str) -> FileMatrix {
    FileMatrix {
        format,
        rows: [(5, 1), (5, 2), (5, 3), (7, 1)]
            .map(|(node, component)| MatrixRow { node, component })
            .to_vec(),
        entries: vec![(0, 0, 4.0), (1, 0, -1.0), (3, 0, -2.5), (1, 1, 5.0), (2, 2, 6.0), (3, 3, 7.0)],
        clamped: Vec::new(),
        notes: Vec::new(),
    }
}

#[test]
fn all_formats_give_the_same_matrix() {
    for (text, mapping, format) in SAMPLES {
        let matrix = read(text.as_bytes(), mapping.map(str::as_bytes));
        assert_eq!(matrix, Ok(expected(format)), "{text}");
    }
}

#[test]
fn a_matrix_is_chosen_by_its_name() {
    let named = |name: &str, value: &str| format!("DMIG,{name},0,6,2,0\nDMIG,{name},5,1,,5,1,{value}\n");
    let text = named("KAAX", "4.") + &named("MAAX", "2.");
    let matrix = read_named(text.as_bytes(), None, Some("maax")).unwrap();
    assert_eq!(matrix.entries, [(0, 0, 2.0)]);
    let (dense, ..) = SAMPLES[9];
    let other = "       1       2       2       4PHI     1P,2E12.4\n       1       1       4\n  1.0000E+00  1.0000E+00\n  \
                 1.0000E+00  1.0000E+00\n       2       1       1\n  1.0000E+00\n";
    let both = other.to_owned() + dense;
    let matrix = read_named(both.as_bytes(), Some(MAPPING.as_bytes()), Some("K"));
    assert_eq!(matrix, Ok(expected("Nastran OUTPUT4")));
    let refusal = read(both.as_bytes(), Some(MAPPING.as_bytes())).unwrap_err();
    assert!(refusal.to_string().ends_with("several matrices: PHI, K; name the one to read"), "{refusal}");
}

#[test]
fn rows_that_are_no_displacements_are_left_out_with_a_note() {
    let clamped = "5,1,5,1,4.\n5,2,5,2,1.E+36\n5,2,5,1,3.\n5,3,5,3,1e36\n";
    let rotations = "5,4,5,4,0.\n5,4,5,1,0.\n";
    let internal = "-3,1,-3,1,2.\n-3,1,-4,1,2.\n1000000001,1,1000000001,1,1.\n-3,1,5,1,0.\n";
    let matrix = read([clamped, rotations, internal].concat().as_bytes(), None).unwrap();
    assert_eq!(matrix.rows, [MatrixRow { node: 5, component: 1 }]);
    assert_eq!(matrix.entries, [(0, 0, 4.0)]);
    assert_eq!(matrix.clamped, [2, 3].map(|component| MatrixRow { node: 5, component }));
    let notes = [
        "Rows left out: 2, clamped (1e36 on the diagonal).",
        "Rows left out: 1, rotations without any entry but zero.",
        "Rows left out: 3, of internal nodes, scalar points or other fields, which act on no displacement.",
    ];
    assert_eq!(matrix.notes, notes);
}

#[test]
fn mirrored_entries_may_differ_by_rounding() {
    let text =
        "%%MatrixMarket matrix coordinate real general\n2 2 4\n1 1 2\n2 2 2\n1 2 1.00000000002\n2 1 1\n";
    let matrix = read(text.as_bytes(), Some(b"1 5 UX\n2 5 UY")).unwrap();
    assert_eq!(matrix.entries[1], (1, 0, 1.00000000001));
}

#[test]
fn a_mapping_that_is_not_needed_is_noted() {
    let (text, ..) = SAMPLES[0];
    let matrix = read(text.as_bytes(), Some(b"no mapping")).unwrap();
    assert_eq!(matrix.notes, ["Mapping not read: the matrix names its nodes itself."]);
}
