//! Gaps between parts of a mesh that were meant to be one, or may have been.

use std::fmt::Write as _;

use rubmap::from_mesh::{self, FromMeshError, MeshSettings, Sector};
use rubmap::mesh;
use rubmap::solid::element::ElementKind;

use crate::deck::deck;
use crate::meshes::block;

fn made(deck: &str) -> Result<Sector, FromMeshError> {
    let file = mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let settings =
        MeshSettings { sectors: Some(1), contact_set: Some("TIP".into()), ..MeshSettings::new(100.0) };
    from_mesh::sector(&file, &settings)
}

/// Two layers of cubes of width 1, of which the upper one has nodes of its own, `gap` higher, from x = `from` on.
fn layers(from: f64, gap: f64) -> String {
    let mut mesh = block(ElementKind::C3D8I, [4, 4, 2], |[x, y, z]| [x + 10.0, y, z]);
    let shared: Vec<usize> = (0..mesh.nodes.len())
        .filter(|&k| mesh.nodes[k][2] == 1.0 && mesh.nodes[k][0] >= 10.0 + from)
        .collect();
    let first = mesh.nodes.len();
    for &node in &shared {
        let [x, y, z] = mesh.nodes[node];
        mesh.nodes.push([x, y, z + gap]);
        mesh.node_ids.push(mesh.nodes.len() as u64);
    }
    for element in &mut mesh.elements[16..] {
        for node in &mut element.nodes {
            if let Some(k) = shared.iter().position(|&shared| shared as u32 == *node) {
                *node = (first + k) as u32;
            }
        }
    }
    let mut deck = deck(&mesh) + "*NSET, NSET=TIP\n";
    let on = |at: &&([f64; 3], u64)| at.0[0] == 14.0 && at.0[2] == 2.0;
    let nodes: Vec<([f64; 3], u64)> = mesh.nodes.iter().copied().zip(1..).collect();
    nodes.iter().filter(on).for_each(|(_, id)| writeln!(deck, "{id}").unwrap());
    deck += "*BOUNDARY\n";
    nodes.iter().filter(|(at, _)| at[0] == 10.0).for_each(|(_, id)| writeln!(deck, "{id}, 1, 3").unwrap());
    deck
}

#[test]
fn parts_that_nearly_touch_are_told() {
    let told = |gap: f64| {
        let found = made(&layers(2.0, gap)).unwrap().found;
        found.notes.into_iter().find(|note| note.starts_with("parts nearly touch"))
    };
    // The slit opens over one row of elements, in the middle of which it has half its width; both sides look at each other.
    let note = told(0.01).unwrap();
    assert!(note.contains("24 faces look at others") && note.contains("5.000e-3 apart"), "{note}");
    assert_eq!(told(0.2), None);
    let message = made(&layers(2.0, 1e-3)).map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("without sharing its nodes"), "{message}");
}

#[test]
fn two_bodies_are_refused_with_their_distance() {
    let message = made(&layers(0.0, 0.03)).map(|_| ()).unwrap_err().to_string();
    assert!(
        message.starts_with("the mesh is 2 bodies that share no node: one of 16 elements, one of 16"),
        "{message}"
    );
    assert!(message.contains("are 3.000e-2 apart; a model is one body"), "{message}");
}
