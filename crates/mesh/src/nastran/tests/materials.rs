//! Materials and properties.

use super::decks::{refusal, with};

#[test]
fn sections_are_those_of_the_properties_that_elements_have() {
    let mesh = with("PSOLID,1,7\nPSOLID,2,9\nMAT1,7,210.+9,,0.3,7850.\n").unwrap();
    assert_eq!(mesh.sections, [("1".to_owned(), "MAT1 7".to_owned())]);
    let material = &mesh.materials["MAT1 7"];
    assert_eq!((material.elastic[0].youngs_modulus, material.elastic[0].poissons_ratio), (210e9, 0.3));
    assert_eq!(material.density[0].density, 7850.0);
    assert_eq!(mesh.element_sets["1"], [1].into());
}

#[test]
fn the_third_constant_follows_from_two() {
    for constants in ["200.,80.,", "200.,,.25", ",80.,.25"] {
        let mesh = with(&format!("MAT1,7,{constants}")).unwrap();
        let row = mesh.materials["MAT1 7"].elastic[0];
        assert_eq!((row.youngs_modulus, row.poissons_ratio), (200.0, 0.25), "{constants}");
        assert_eq!(mesh.materials["MAT1 7"].density, []);
    }
    assert_eq!(refusal("MAT1,7,200."), "line 10 (MAT1): expected two of E, G and NU");
    assert_eq!(refusal("MAT1,7,200.,0."), "line 10 (MAT1): expected E, G and NU that go together");
    assert_eq!(refusal("MAT1,7,1.,,.3\nMAT1,7,1.,,.3"), "line 11 (MAT1): material 7 is there twice");
}

#[test]
fn other_materials_are_refused_where_a_solid_has_them() {
    assert!(with("MAT9,7,1.\nPSOLID,2,7").is_ok());
    for cards in ["MAT9,7,1.\nPSOLID,1,7", "MATT1,7,1\nPSOLID,1,7\nMAT1,7,1.,,.3"] {
        let message = refusal(cards);
        assert!(message.contains("(PSOLID): material 7, which has a MAT"), "{message}");
    }
    assert_eq!(refusal("PSOLID,1,7"), "line 10 (PSOLID): there is no material \"7\" in the file");
    assert!(refusal("PSOLID,1,7,,,,,PFLUID").starts_with("line 10 (PSOLID): a fluid cannot be carried over"));
    assert_eq!(refusal("PSOLID,1,7\nPSOLID,1,7"), "line 11 (PSOLID): property 1 is there twice");
}
