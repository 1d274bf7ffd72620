//! Elements of a package: read as written, checked, and absent where a package has none.

use std::path::Path;

use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{AnnulusParameters, Material, annulus};
use rubmap::package::calculix::{self, CalculixModel, Normals};
use rubmap::package::raw::RawPackage;
use rubmap::package::{self, Limits, read_mesh, read_raw, write};
use rubmap::solid::element::ElementKind;
use rubmap::solid::material::FatigueStrength;
use serde_json::json;

use crate::bad::{case, check_on};
use crate::sample::Files;

/// Package of a disk of four elements a sector: nodes 1 to 18, the bore 1, 4, 7, … clamped.
pub(crate) fn disk(element_order: ElementOrder) -> RawPackage {
    let material = Material {
        yield_strength: Some(880.0),
        ultimate_strength: Some(950.0),
        fatigue_strength: Some(FatigueStrength { amplitude: 500.0, source: "test".into() }),
        ..Material::default()
    };
    let p =
        AnnulusParameters { elements: [2, 2, 1], element_order, material, ..AnnulusParameters::default() };
    annulus(&p).unwrap()
}

pub(crate) fn linear() -> Files {
    Files::of(&disk(ElementOrder::Linear))
}

const ELEMENTS: Option<&str> = Some("elements.csv");
const JSON: Option<&str> = Some("sector.json");

#[test]
fn elements_are_read_as_they_were_written() {
    for order in [ElementOrder::Linear, ElementOrder::Quadratic] {
        let package = disk(order);
        let file = tempfile::NamedTempFile::new().unwrap();
        write(&package, &file).unwrap();
        let read = read_raw(file.path(), &Limits::default()).unwrap();
        assert_eq!((&read.elements, &read.manifest.mesh), (&package.elements, &package.manifest.mesh));
        let mesh = read_mesh(file.path(), &Limits::default()).unwrap().unwrap();
        assert_eq!(Some(&mesh), package::read(file.path(), &Limits::default()).unwrap().mesh.as_ref());
        assert_eq!(mesh.nodes.len(), package.nodes.len());
        // Pairs of clamped nodes, which sector.json does not have.
        let ids = |&(low, high): &(u32, u32)| [low, high].map(|place| mesh.node_ids[place as usize]);
        let pairs: Vec<[u64; 2]> = mesh.cyclic.iter().map(ids).collect();
        assert!(package.manifest.cyclic.iter().all(|pair| pairs.contains(pair)));
        let clamped = match order {
            ElementOrder::Linear => vec![[1, 7], [10, 16]],
            ElementOrder::Quadratic => vec![[1, 17], [22, 28], [31, 47]],
        };
        assert!(clamped.iter().all(|pair| pairs.contains(pair)), "{pairs:?}");
        assert_eq!(pairs.len(), package.manifest.cyclic.len() + clamped.len());
    }
}

#[test]
fn a_package_without_elements_is_as_it_was() {
    let whole = linear();
    let mut without = whole.clone();
    without.0.remove("elements.csv");
    without.json(|json| drop(json.as_object_mut().unwrap().remove("mesh")));
    let [whole, without] = [whole, without].map(|files| files.import().unwrap());
    assert!(whole.mesh.is_some() && without.mesh.is_none());
    assert_ne!(whole.digest, without.digest);
    assert_eq!(whole.sector.own_dofs(), without.sector.own_dofs());
}

#[test]
fn layout_does_not_matter_and_content_does() {
    let plain = linear();
    let mut laid_out = plain.clone();
    let text = plain.text("elements.csv").replace(',', " , ").replace('\n', "\r\n\r\n");
    laid_out.put("elements.csv", format!("\u{feff}id,type,set,n1,n2,n3\r\n{text}"));
    assert_eq!(laid_out.import().unwrap().mesh, plain.import().unwrap().mesh);
    let mut stronger = plain.clone();
    stronger.json(|json| json["mesh"]["sets"]["WHEEL"]["yield_strength"] = json!(881.0));
    assert_ne!(stronger.import().unwrap().digest, plain.import().unwrap().digest);
}

#[test]
fn rows() {
    check_on(
        &linear(),
        &[
            case(
                |f| f.line("elements.csv", 2, "x2,QM6,WHEEL,2,3,6,5,11,12,15,14"),
                "elements.csv, line 2: \"x2\" is not an element number (an integer from 0)",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 2, "2,S8R,WHEEL,2,3,6,5,11,12,15,14"),
                "elements.csv, line 2: element 2 is of type \"S8R\"; known are C3D4, C3D5, C3D6, C3D8, C3D8I, C3D10, C3D13, C3D15, C3D20, C3D20R, QM6. Without its mesh the package is valid, and has no stress",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 2, "2,C3D20,WHEEL,2,3,6,5,11,12,15,14"),
                "elements.csv, line 2: element 2 has 8 nodes; a C3D20 has 20",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 2, "2"),
                "elements.csv, line 2: element 2 is of type \"\"; known are C3D4, C3D5, C3D6, C3D8, C3D8I, C3D10, C3D13, C3D15, C3D20, C3D20R, QM6. Without its mesh the package is valid, and has no stress",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 2, "2,QM6,BLADE,2,3,6,5,11,12,15,14"),
                "elements.csv, line 2: element 2 is of set \"BLADE\", which has no material; give it one at /mesh/sets of sector.json",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 2, "2,QM6,WHEEL,2,3,6,5,11,12,15,1.4"),
                "elements.csv, line 2: \"1.4\" is not a node id (an integer from 0)",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 2, "2,QM6,WHEEL,2,3,6,5,11,12,15,140"),
                "elements.csv, line 2: element 2 has node 140, which is not in the node table",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 2, "2,QM6,WHEEL,2,3,6,5,11,12,15,15"),
                "elements.csv, line 2: element 2 has node 15 twice; a collapsed element is another type (a wedge C3D6 or C3D15, a pyramid C3D5 or C3D13, a tetrahedron C3D4 or C3D10)",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.line("elements.csv", 3, "2,QM6,WHEEL,4,5,8,7,13,14,17,16"),
                "elements.csv, line 3: element 2 is already defined on line 2",
                (ELEMENTS, Some(3), None),
            ),
            case(
                |f| f.put("elements.csv", ""),
                "elements.csv, line 1: the table has no rows",
                (ELEMENTS, Some(1), None),
            ),
        ],
    );
}

#[test]
fn shapes() {
    check_on(
        &linear(),
        &[
            case(
                |f| f.line("elements.csv", 4, "4,QM6,WHEEL,14,15,18,17,5,6,9,8"),
                "elements.csv, line 4: element 4 (QM6) is flipped or degenerate: its Jacobian determinant at node 14 is -1.472e2, not positive; all of it is inside out: list the corners of each of its faces the other way round",
                (ELEMENTS, Some(4), None),
            ),
            case(
                |f| f.line("elements.csv", 4, "4,QM6,WHEEL,5,6,8,9,14,15,17,18"),
                "elements.csv, line 4: element 4 (QM6) is flipped or degenerate: its Jacobian determinant at node 8 is -2.265e2, not positive; list its nodes in CalculiX's order, and look at their positions",
                (ELEMENTS, Some(4), None),
            ),
        ],
    );
    let quadratic = Files::of(&disk(ElementOrder::Quadratic));
    check_on(
        &quadratic,
        &[
            // Edges along the thickness before those of the upper face, as some codes list them.
            case(
                |f| {
                    f.line(
                        "elements.csv",
                        1,
                        "1,C3D20,WHEEL,1,3,11,9,31,33,41,39,2,7,10,6,22,23,26,25,32,37,40,36",
                    )
                },
                "elements.csv, line 1: element 1 (C3D20) lists node 22 for the middle of the edge from node 31 to node 33, which is far from there; list the nodes on its edges in CalculiX's order",
                (ELEMENTS, Some(1), None),
            ),
            // Node 4 is pushed along its edge, to an eighth of it from node 3.
            case(
                |f| f.line("nodes.csv", 4, "4,67.86,-18.18,-1"),
                "elements.csv, line 2: element 2 (C3D20) is flipped or degenerate: its Jacobian determinant at node 3 is -5.985e1, not positive; its corners are in order: move the nodes on its edges nearer to the middle",
                (ELEMENTS, Some(2), None),
            ),
        ],
    );
}

#[test]
fn the_whole() {
    check_on(
        &linear(),
        &[
            case(
                |f| f.replace("elements.csv", "4,QM6,WHEEL,5,6,9,8,14,15,18,17\n", ""),
                "dofs.csv, line 28: node 9 has degrees of freedom but belongs to no element of elements.csv; add its elements, or leave the mesh out of sector.json",
                (Some("dofs.csv"), Some(28), None),
            ),
            // A brick of its own, clamped all over.
            case(
                |f| {
                    let mut nodes = f.text("nodes.csv");
                    for (id, [x, y, z]) in (19..).zip(rubmap::solid::natural::CORNERS) {
                        nodes += &format!("{id},{},{y},{z}\n", x + 50.0);
                    }
                    f.put("nodes.csv", nodes);
                    let elements = f.text("elements.csv");
                    f.put("elements.csv", elements + "9,C3D8,WHEEL,19,20,21,22,23,24,25,26\n");
                },
                "elements.csv, line 5: element 9 shares no node with the rest of the mesh; merge nodes that lie in one place, or leave out what does not belong to the wheel",
                (ELEMENTS, Some(5), None),
            ),
            // Under a new number, its nodes in another order that is as good.
            case(
                |f| {
                    f.line(
                        "elements.csv",
                        4,
                        "4,QM6,WHEEL,5,6,9,8,14,15,18,17\n5,QM6,WHEEL,3,6,5,2,12,15,14,11",
                    )
                },
                "elements.csv, line 5: element 5 has the nodes of element 2 on line 2; list it once",
                (ELEMENTS, Some(5), None),
            ),
            // A wedge inside element 2, and one that fills what is left of it.
            case(
                |f| f.line("elements.csv", 4, "4,QM6,WHEEL,5,6,9,8,14,15,18,17\n5,C3D6,WHEEL,2,3,6,11,12,15"),
                "elements.csv, line 5: elements 2 and 5 lie on the same side of a face; remove what fills the same space twice",
                (ELEMENTS, Some(5), None),
            ),
            // Half of element 1, which has the face between it and element 2.
            case(
                |f| f.line("elements.csv", 4, "4,QM6,WHEEL,5,6,9,8,14,15,18,17\n5,C3D6,WHEEL,2,5,1,11,14,10"),
                "elements.csv, line 5: element 5 has a face that lies between elements 1 and 2 already; remove what fills the same space twice",
                (ELEMENTS, Some(5), None),
            ),
            // The face between nodes 2, 3, 12, 11 is cut into triangles, that of the high face is not.
            case(
                |f| {
                    f.line("elements.csv", 2, "2,C3D6,WHEEL,2,3,6,11,12,15\n5,C3D6,WHEEL,2,6,5,11,15,14");
                    f.line("elements.csv", 5, "4,C3D6,WHEEL,5,6,9,14,15,18\n6,C3D4,WHEEL,5,9,8,14\n7,C3D4,WHEEL,9,8,14,18\n8,C3D4,WHEEL,8,14,18,17");
                },
                "elements.csv, line 2: element 2 has a face on the low cyclic face that no element repeats on the other; mesh both faces alike",
                (ELEMENTS, Some(2), None),
            ),
            case(
                |f| f.json(|json| json["mesh"]["sets"]["HUB"] = json["mesh"]["sets"]["WHEEL"].clone()),
                "sector.json, /mesh/sets/HUB: no element of elements.csv is of this set; remove it, or look at the sets of the elements",
                (JSON, None, Some("/mesh/sets/HUB")),
            ),
            case(
                |f| drop(f.0.remove("elements.csv")),
                "sector.json, /mesh/elements: the archive holds no file elements.csv; add it under exactly this name",
                (ELEMENTS, None, Some("/mesh/elements")),
            ),
            case(
                |f| f.json(|json| drop(json.as_object_mut().unwrap().remove("mesh"))),
                "elements.csv: sector.json does not name this file; remove it from the archive or name it",
                (ELEMENTS, None, None),
            ),
        ],
    );
}

#[test]
fn materials() {
    fn set(f: &mut Files, field: &str, value: serde_json::Value) {
        f.json(|json| json["mesh"]["sets"]["WHEEL"][field] = value);
    }
    check_on(
        &linear(),
        &[
            case(
                |f| set(f, "youngs_modulus", json!(0.0)),
                "sector.json, /mesh/sets/WHEEL/youngs_modulus: the value is 0; it must be positive",
                (JSON, None, Some("/mesh/sets/WHEEL/youngs_modulus")),
            ),
            case(
                |f| set(f, "poissons_ratio", json!(0.5)),
                "sector.json, /mesh/sets/WHEEL/poissons_ratio: Poisson's ratio is 0.5; it lies between -1 and 0.5, both excluded",
                (JSON, None, Some("/mesh/sets/WHEEL/poissons_ratio")),
            ),
            case(
                |f| set(f, "ultimate_strength", json!(-950.0)),
                "sector.json, /mesh/sets/WHEEL/ultimate_strength: the value is -950; it must be positive",
                (JSON, None, Some("/mesh/sets/WHEEL/ultimate_strength")),
            ),
            case(
                |f| set(f, "fatigue_strength", json!({"amplitude": 0.0, "source": "test"})),
                "sector.json, /mesh/sets/WHEEL/fatigue_strength/amplitude: the value is 0; it must be positive",
                (JSON, None, Some("/mesh/sets/WHEEL/fatigue_strength/amplitude")),
            ),
            case(
                |f| set(f, "ultimate_strength", json!(879.5)),
                "sector.json, /mesh/sets/WHEEL/ultimate_strength: the ultimate strength 879.5 is below the yield strength 880.0; the first is the larger one",
                (JSON, None, Some("/mesh/sets/WHEEL/ultimate_strength")),
            ),
            case(
                |f| set(f, "fatigue_strength", json!({"amplitude": 951.0, "source": "test"})),
                "sector.json, /mesh/sets/WHEEL/fatigue_strength/amplitude: the fatigue strength 951.0 is above the ultimate strength 950.0; it is an amplitude, half of the range",
                (JSON, None, Some("/mesh/sets/WHEEL/fatigue_strength/amplitude")),
            ),
            case(
                |f| {
                    let again = "\"sets\": {\"WHEEL\": {\"youngs_modulus\": 1, \"poissons_ratio\": 0.3, \"density\": 1},";
                    f.replace("sector.json", "\"sets\": {", again);
                },
                "sector.json, /mesh/sets: the set \"WHEEL\" has two materials; give it one (line 86, column 5)",
                (JSON, Some(86), Some("/mesh/sets")),
            ),
            case(
                |f| set(f, "fatigue_strength", json!({"amplitude": 500.0, "source": " "})),
                "sector.json, /mesh/sets/WHEEL/fatigue_strength/source: say where the fatigue strength comes from: standard or test, number of cycles, surface, temperature",
                (JSON, None, Some("/mesh/sets/WHEEL/fatigue_strength/source")),
            ),
            case(
                |f| {
                    f.json(|json| {
                        drop(
                            json["mesh"]["sets"]["WHEEL"]["fatigue_strength"]
                                .as_object_mut()
                                .unwrap()
                                .remove("source"),
                        )
                    })
                },
                "sector.json, /mesh/sets/WHEEL/fatigue_strength/source: missing field `source` (line 1, column 341)",
                (JSON, Some(1), Some("/mesh/sets/WHEEL/fatigue_strength/source")),
            ),
        ],
    );
}

/// Model by hand around the disk: a deck with its elements in several cards and sets, with strengths beside it.
fn deck(folder: &Path, change: impl FnOnce(String) -> String) -> CalculixModel {
    let package = disk(ElementOrder::Linear);
    let mut deck = "*NODE\n".to_owned();
    for node in &package.nodes {
        let [x, y, z] = node.position;
        deck += &format!("{}, {x:e}, {y:e}, {z:e}\n", node.id);
    }
    deck += "*ELEMENT, TYPE=C3D8, ELSET=inner\n1, 1,2,5,4,\n10,11,14,13\n3,4,5,8,7,13,14,17,16\n\
             *Element, ELSET = Outer, type = C3D8\n2, 2,3,6,5, 11,12,15,14\n4, 5,6,9,8, 14,15,18,17\n\
             *ELSET, ELSET=EVEN, GENERATE\n2, 4, 2\n*ELSET, ELSET=ALL\n1, 3, EVEN\n\
             *NSET, NSET=LOW\n2, 3, 11, 12\n*NSET, NSET=HIGH\n8, 9, 17, 18\n*NSET, NSET=TIP\n6, 15\n\
             *MATERIAL, NAME=Ti\n*ELASTIC, TYPE=ISO\n1.14E5, .32\n*DENSITY\n4.43D-9\n\
             *MATERIAL, NAME=STEEL\n*DENSITY\n7.85E-9\n*ELASTIC\n2.1E5, .3, 293.\n\
             *SOLID SECTION, ELSET=ALL, MATERIAL=Ti\n*SOLID SECTION, MATERIAL=Steel, ELSET=EVEN\n";
    std::fs::write(folder.join("deck.inp"), change(deck)).unwrap();
    let dofs: Vec<String> =
        package.dofs.iter().map(|dof| format!("{}.{}", dof.node, dof.component)).collect();
    std::fs::write(folder.join("rest.dof"), dofs.join("\n")).unwrap();
    // CalculiX writes both matrices in one pattern: here only their diagonals, which the mesh does not look at.
    for (name, matrix) in [("rest.sti", &package.stiffness[0]), ("rest.mas", &package.mass)] {
        let diagonal = matrix.entries.iter().filter(|(row, column, _)| row == column);
        let text: String = diagonal.map(|(row, _, value)| format!("{0} {0} {value:e}\n", row + 1)).collect();
        std::fs::write(folder.join(name), text).unwrap();
    }
    let normals = folder.join("normals.csv");
    std::fs::write(&normals, "6, 1, 0, 0\n15, 1, 0, 0\n").unwrap();
    CalculixModel {
        sectors: Some(12),
        low_set: Some("LOW".into()),
        high_set: Some("HIGH".into()),
        contact_as_listed: true,
        normals: Normals::Table(normals),
        ..crate::calculix::model(folder, "deck.inp", "rest")
    }
}

#[test]
fn a_deck_has_elements_materials_and_strengths() {
    let folder = tempfile::tempdir().unwrap();
    let strengths = folder.path().join("strengths.json");
    std::fs::write(
        &strengths,
        r#"{"ti": {"yield_strength": 880}, "Even": {"ultimate_strength": 600, "fatigue_strength": {"amplitude": 250, "source": "FKM"}}}"#,
    )
    .unwrap();
    let model = CalculixModel { strengths: Some(strengths.clone()), ..deck(folder.path(), |deck| deck) };
    let (package, summary) = calculix::import(&model).unwrap();
    assert_eq!(summary.no_mesh, None);
    let expected = disk(ElementOrder::Linear);
    let found = package.elements.as_ref().unwrap();
    assert_eq!(found.iter().map(|e| &*e.set).collect::<Vec<_>>(), ["ALL", "EVEN", "ALL", "EVEN"]);
    for (found, expected) in found.iter().zip(expected.elements.as_ref().unwrap()) {
        assert_eq!((found.id, found.kind, &found.nodes), (expected.id, ElementKind::C3D8, &expected.nodes));
    }
    let sets = &package.manifest.mesh.as_ref().unwrap().sets;
    let [all, even] = ["ALL", "EVEN"].map(|name| &sets[name]);
    assert_eq!((all.youngs_modulus, all.density, all.yield_strength), (1.14e5, 4.43e-9, Some(880.0)));
    assert_eq!((even.poissons_ratio, even.yield_strength, even.ultimate_strength), (0.3, None, Some(600.0)));
    assert_eq!(even.fatigue_strength.as_ref().unwrap().source, "FKM");

    std::fs::write(&strengths, r#"{"CAST": {"yield_strength": 880}}"#).unwrap();
    let refused = calculix::import(&model).unwrap_err().to_string();
    let said = "strengths are given of CAST, which is no material or element set of a *SOLID SECTION; there are: ALL, TI, EVEN, STEEL";
    assert_eq!(refused, said);
    std::fs::write(&strengths, r#"{"TI": {"yield": 880}}"#).unwrap();
    let refused = calculix::import(&model).unwrap_err().to_string();
    assert!(refused.contains("strengths.json: TI.yield: unknown field `yield`"), "{refused}");
}

#[test]
fn a_deck_that_has_no_usable_mesh_says_why() {
    type Change = fn(String) -> String;
    let cases: [(Change, &str); 8] = [
        (
            |deck| deck.replace("*Element, ELSET = Outer, type = C3D8", "*ELEMENT, TYPE=C3D8R"),
            "elements of type C3D8R are not known",
        ),
        (
            |deck| deck.replace("TYPE=ISO", "TYPE=ORTHO"),
            "the elasticity of material TI is of type ORTHO; only isotropic materials have stress here",
        ),
        (
            |deck| deck.replace(".3, 293.", ".3, 293.\n2.E5, .3, 400."),
            "material STEEL depends on temperature; give it constants of one temperature",
        ),
        (|deck| deck.replace("*DENSITY\n7.85E-9\n", ""), "material STEEL has no *DENSITY"),
        (|deck| deck.replace("NAME=STEEL", "NAME=IRON"), "the deck has no *MATERIAL, NAME=STEEL"),
        (
            |deck| deck.replace("*ELSET, ELSET=ALL\n1, 3, EVEN\n", "*ELSET, ELSET=ALL\n1\n"),
            "element 3 is in no *SOLID SECTION",
        ),
        (|deck| deck.replace("3,4,5,8,7,13,14,17,16", "1,4,5,8,7,13,14,17,16"), "element 1 is defined twice"),
        (
            |deck| deck.replace("3,4,5,8,7,13,14,17,16", "3,4,7,8,5,13,16,17,14"),
            "elements.csv, line 3: element 3 (C3D8) is flipped or degenerate: its Jacobian determinant at node 4 is -6.794e1, not positive; all of it is inside out: list the corners of each of its faces the other way round",
        ),
    ];
    let mut wrong = String::new();
    for (change, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        let (package, summary) = calculix::import(&deck(folder.path(), change)).unwrap();
        assert!(package.elements.is_none() && package.manifest.mesh.is_none());
        let found = summary.no_mesh.unwrap().to_string();
        if found != expected {
            wrong += &format!("\n  expected {expected}\n  found    {found}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
