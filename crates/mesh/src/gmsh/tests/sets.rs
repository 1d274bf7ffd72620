//! Physical groups as sets.

use super::super::read;
use super::files::{cube, tetrahedron};

#[test]
fn groups_of_surfaces_and_volumes_are_sets_by_name() {
    for bytes in tetrahedron().all() {
        let mesh = read(&bytes).unwrap();
        assert_eq!(mesh.node_sets["rim face"], [3, 2, 1]);
        assert_eq!(mesh.node_sets["blade"], [1, 2, 3, 4]);
        assert_eq!(mesh.node_sets.len(), 2);
        assert_eq!(mesh.element_sets.len(), 1);
        assert_eq!(mesh.element_sets["blade"], [2].into());
        assert_eq!(mesh.left_out, [("3-node triangle".to_owned(), 1)].into());
        assert_eq!(mesh.sections, []);
    }
}

#[test]
fn groups_without_names_go_by_number() {
    let mesh =
        read(cube("1 15 2 4 1 8\n2 2 2 1 1 1 2 3\n3 4 2 1 1 1 2 4 5\n4 4 2 0 1 2 3 4 7").as_bytes()).unwrap();
    let names: Vec<&String> = mesh.node_sets.keys().collect();
    assert_eq!(names, ["4", "surface 1", "volume 1"]);
    assert_eq!(mesh.node_sets["4"], [8]);
    assert_eq!(mesh.element_sets["volume 1"], [3].into());
    assert_eq!(mesh.notes.len(), 1);
    // The element in no group is there all the same.
    assert_eq!(mesh.elements.keys().copied().collect::<Vec<_>>(), [3, 4]);
}

#[test]
fn groups_of_one_name_are_one_set() {
    let names = "$PhysicalNames\n2\n2 1 \"hub\"\n1 9 \"hub\"\n$EndPhysicalNames\n$Nodes";
    let text = cube("1 1 2 9 1 7 8\n2 2 2 1 1 1 2 8\n3 4 2 5 1 1 2 4 5").replace("$Nodes", names);
    assert_eq!(read(text.as_bytes()).unwrap().node_sets["hub"], [7, 8, 1, 2]);
}

#[test]
fn an_element_of_several_groups_is_one_element() {
    // By a number of its own in each group, as Gmsh writes it, and by the same number.
    for again in ["3", "1"] {
        let text = cube(&format!("1 4 2 7 1 1 2 4 5\n2 4 2 7 1 2 3 4 7\n{again} 4 2 8 1 1 2 4 5"));
        let mesh = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.elements.keys().copied().collect::<Vec<_>>(), [1, 2]);
        assert_eq!(mesh.element_sets["7"], [1, 2].into());
        assert_eq!(mesh.element_sets["8"], [1].into());
    }
    // Two of one group stay two.
    let text = cube("1 4 2 7 1 1 2 4 5\n2 4 2 8 1 2 3 4 7\n3 4 2 7 1 1 2 4 5");
    assert_eq!(read(text.as_bytes()).unwrap().elements.len(), 3);
}

#[test]
fn other_sections_are_skipped() {
    let plain = tetrahedron().ascii_2();
    let text = String::from_utf8(plain.clone()).unwrap();
    let more = "$Periodic\n1\n2 $3\n$EndPeriodic\n$Own\n\n$EndOwn\n$Nodes";
    let more = read(text.replace("$Nodes", more).as_bytes()).unwrap();
    let plain = read(&plain).unwrap();
    assert_eq!(more.nodes, plain.nodes);
    assert_eq!(more.elements[&2].line, plain.elements[&2].line + 7);
    let parts = text.replace("$Nodes", "$PartitionedEntities\n$EndPartitionedEntities\n$Nodes");
    assert_eq!(read(parts.as_bytes()).unwrap().notes.len(), 1);
}
