//! Decks of small meshes.

use std::fmt::Write as _;

use rubmap::solid::mesh::SectorMesh;

/// Deck of the mesh, its nodes in the set NALL and its elements in EALL, of the first set's material.
pub(crate) fn deck(mesh: &SectorMesh) -> String {
    let mut deck = String::from("*NODE, NSET=NALL\n");
    for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.nodes) {
        writeln!(deck, "{id}, {x:.14e}, {y:.14e}, {z:.14e}").unwrap();
    }
    writeln!(deck, "*ELEMENT, TYPE={}, ELSET=EALL", mesh.elements[0].kind.name()).unwrap();
    for element in &mesh.elements {
        let numbers: Vec<String> = std::iter::once(element.id)
            .chain(element.nodes.iter().map(|&node| mesh.node_ids[node as usize]))
            .map(|number| number.to_string())
            .collect();
        let lines: Vec<String> = numbers.chunks(11).map(|line| line.join(", ")).collect();
        writeln!(deck, "{}", lines.join(",\n")).unwrap();
    }
    let material = &mesh.sets[0].material;
    writeln!(
        deck,
        "*MATERIAL, NAME=M\n*ELASTIC\n{:e}, {:e}\n*DENSITY\n{:e}\n*SOLID SECTION, ELSET=EALL, MATERIAL=M",
        material.youngs_modulus, material.poissons_ratio, material.density
    )
    .unwrap();
    deck
}
