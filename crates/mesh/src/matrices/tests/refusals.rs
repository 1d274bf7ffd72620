//! Refusals, each with its words.

use super::samples::{MAPPING, SAMPLES};
use crate::matrices::read;

fn refusal(text: &str, mapping: Option<&str>) -> String {
    read(text.as_bytes(), mapping.map(str::as_bytes)).unwrap_err().to_string()
}

/// Asserts that `text` is refused in words that contain `part`.
fn refused(text: &str, mapping: Option<&str>, part: &str) {
    let refusal = refusal(text, mapping);
    assert!(refusal.contains(part), "{text}\n{refusal}");
}

#[test]
fn rows_by_number_need_a_mapping() {
    for (text, mapping, _) in SAMPLES {
        if mapping.is_some() {
            refused(text, None, "whose rows name no nodes");
            refused(text, Some("1 5 UX\n"), "mapping");
        }
    }
    refused("1,1,4.\n", None, "write it in FORMAT=MATRIX INPUT or LABELS");
    refused("1 1 4.\n", None, "from CalculiX (.sti, .mas) give it with its .dof file");
    refused(
        "1,1,4.\n2,2,1.",
        Some("1 5 1\n3 5 2\n"),
        "line 2 (Abaqus matrix): there is no row of the mapping \"2\"",
    );
    refused("1,1,4.\n", Some("1 5 1\n3 5 2\n"), "expected an entry of row 3, which the mapping has");
}

#[test]
fn couplings_to_what_is_no_displacement() {
    refused(
        "5,1,5,1,1\n5,4,5,4,1\n",
        None,
        "line 2 (Abaqus matrix): the rotation node 5 component 4 cannot be carried over",
    );
    let coupled =
        "line 1 (Abaqus matrix): the coupling of node 5 component 1 with internal node -3 component 1 cannot";
    refused("5,1,-3,1,1\n5,1,5,1,1\n", None, coupled);
    let scalar = "DMIG,K,0,6,2,0\nDMIG,K,5,1,,5,1,1.,,+\n+,101,0,2.\n";
    refused(
        scalar,
        None,
        "line 3 (Nastran DMIG): the coupling of scalar point 101 with node 5 component 1 cannot",
    );
    refused("-3,1,-3,1,1\n", None, "expected rows of nodes in x, y or z");
    refused("1,1,1.\n-2,1,1.\n", Some("1 5 1\n"), "the coupling of internal node -2 with node 5 component 1");
}

#[test]
fn matrices_that_are_not_symmetric() {
    let twice = "line 2 (Abaqus matrix): the entry of row node 5 component 1 and column node 5 component 1 is there twice";
    refused("5,1,5,1,1\n5,1,5,1,1\n", None, twice);
    let unlike = "the matrix is not symmetric: row node 5 component 2, column node 5 component 1 has 2e0, but row node 5 component 1, \
                  column node 5 component 2 has 3e0";
    refused("5,1,5,2,3\n5,2,5,1,2\n", None, unlike);
    let header = "*MATRIX, TYPE=UNSYMMETRIC\n";
    refused(
        &format!("{header}5,1,5,1,3\n5,2,5,1,2\n"),
        None,
        "line 3 (Abaqus matrix): the matrix is not symmetric",
    );
    refused("DMIG,K,0,1,2,0\nDMIG,K,5,1,,5,2,1.\n", None, "not symmetric");
}

#[test]
fn numbers_and_lines() {
    refused(
        "5,1,5,1,1\n5,1,5,1\n",
        None,
        "line 2 (Abaqus matrix): expected node, component, node, component and value",
    );
    refused("5,1,5,1,1\n5,2,5,2,nan\n", None, "\"nan\" is not an entry");
    refused("5,1,5,1,1\n5,2,5,2,1e999\n", None, "\"1e999\" is not an entry");
    refused("5,1,5,1,1\n*MATRIX\n", None, "a second matrix in the file cannot be carried over");
    refused(
        "*MATRIX, TYPE=STIFFNESS\n1., 2., 3., 4.\n",
        None,
        "a matrix of type STIFFNESS cannot be carried over",
    );
}

#[test]
fn kinds_of_matrices() {
    refused("DMIG,K,0,6,3,0\n", None, "a matrix of complex numbers cannot be carried over");
    refused(
        "DMIG,K,0,6,2,0\nDMIG,K,5,1,,5,1,1.,2.\n",
        None,
        "line 2 (Nastran DMIG): a matrix of complex numbers",
    );
    refused("DMIG,P,0,9,2,0\n", None, "a matrix of form 9");
    refused("DMIG,K,5,1,,5,1,1.\n", None, "expected a header DMIG K 0");
    refused(
        "DMIG,K,0,6,2,0\nDMIG,M,0,6,2,0\n",
        None,
        "the file has several matrices: K, M; name the one to read",
    );
    let complex =
        "       1       1       6       4K       1P,2E12.4\n       2       1       1\n  1.0000E+00\n";
    refused(complex, Some("1 5 1"), "a matrix of complex numbers");
    let wide = "       2       1       2       2K       1P,2E12.4\n       3       1       1\n  1.0000E+00\n";
    refused(wide, Some("1 5 1"), "a matrix of 1 rows and 2 columns");
    refused(
        "%%MatrixMarket matrix array real general\n1 1\n1\n",
        Some("1 5 1"),
        "a \"matrix array real general\"",
    );
    refused("%%MatrixMarket matrix coordinate real general\n1 1 2\n1 1 1\n", Some("1 5 1"), "1 more entries");
    refused(
        "%%MatrixMarket matrix coordinate real general\n1 1 0\n1 1 1\n",
        Some("1 5 1"),
        "the end after 0 entries",
    );
    refused(
        "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 2 1\n",
        Some("1 5 1"),
        "\"2\" is not a row",
    );
    let (boeing, ..) = SAMPLES[15];
    refused(
        &boeing.replace("RSA", "CSA"),
        Some(MAPPING),
        "line 3 (Harwell-Boeing matrix): a matrix of type CSA",
    );
    refused(&boeing.replace("   1   4   5   6", "   1   4   3   6"), Some(MAPPING), "\"3\" is not a pointer");
    refused(&boeing.replace("(2D12.4)", "(2A12)  "), Some(MAPPING), "is not a format such as (10I8)");
}

#[test]
fn files_of_other_kinds() {
    refused(
        "*NODE\n1, 0, 0, 0\n",
        None,
        "this is a CalculiX or Abaqus deck; it belongs in the place of the mesh",
    );
    refused("BEGIN BULK\nGRID,1,,0.,0.,0.\n", None, "this is Nastran bulk data without a DMIG entry");
    refused("*USER ELEMENT,NODES=4,LINEAR\n", None, "this is the matrix of a substructure");
    refused("\0\0\0\u{18}\u{4}", None, "this is a binary file of a big-endian program");
    refused("", None, "this is no matrix file of a known format");
    refused("hello", None, "this is no matrix file of a known format");
}

/// Files of matrices in the place of a mesh are named as what they are.
#[test]
fn matrices_are_no_meshes() {
    let none = |name: &str| Err(format!("there is no {name}"));
    for (text, _, format) in super::SAMPLES {
        let message = crate::read(text.as_bytes(), &none).unwrap_err().to_string();
        // Punch with nodes in it is bulk data, whose DMIG is refused with the same advice.
        if text.contains("GRID") {
            assert!(message.contains("(DMIG): a matrix cannot be carried over: take it out"), "{message}");
            assert!(message.ends_with("give it to `rubmap import matrices` beside the mesh"), "{message}");
            continue;
        }
        let found = if text.starts_with("%%") { "a Matrix Market file" } else { "a matrix file" };
        let expected = format!("this is {found}; give it to `rubmap import matrices` beside the mesh");
        assert!(message.starts_with(&expected), "{format}: {message}");
    }
    let message = crate::read(b"no file of any kind", &none).unwrap_err().to_string();
    assert!(message.starts_with("this is no mesh file of a known format"), "{message}");
}
