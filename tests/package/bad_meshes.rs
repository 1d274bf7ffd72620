//! Bad meshes as users have them: each is refused with its card, line, element or node, and what to do.

use std::fmt::Write;

use nalgebra::{Rotation3, Unit, Vector3};
use rubmap::from_mesh::{self, MeshSettings};
use rubmap::mesh;
use rubmap::package::raw::Axis;
use rubmap::package::to_sector;
use rubmap::solid::mesh::SectorMesh;

use crate::from_mesh::{
    ansys, deck, gmsh, impeller, made, nastran, read_mesh, refused, sector_mesh, settings, vtu,
};

/// Refusal of a file with settings.
fn refusal_with(text: &str, settings: &MeshSettings) -> String {
    mesh::read(text.as_bytes(), &|_| Err("there is none".to_owned()))
        .map_err(|error| error.to_string())
        .and_then(|file| from_mesh::sector(&file, settings).map_err(|error| error.to_string()))
        .and_then(|sector| sector.package().map_err(|error| error.to_string()))
        .and_then(|package| to_sector(package).map_err(|error| error.to_string()))
        .map(drop)
        .expect_err("a refusal")
}

fn refusal(text: &str) -> String {
    refusal_with(text, &settings())
}

fn good() -> SectorMesh {
    sector_mesh(&impeller(7))
}

#[test]
fn degenerate_and_repeated_elements() {
    let mut flat = good();
    let nodes = flat.elements[5].nodes.clone();
    flat.elements[5].nodes[4..8].copy_from_slice(&nodes[..4]);
    let message = refusal(&deck(&flat));
    assert!(message.contains("(*ELEMENT): element 6 repeats nodes in a way that makes no"), "{message}");

    let mut thin = good();
    let last = thin.elements.len() - 1;
    let nodes = thin.elements[last].nodes.clone();
    // Nodes of the far side, and those between both sides, on the near one.
    for (far, near) in [
        (4, 0),
        (5, 1),
        (6, 2),
        (7, 3),
        (12, 8),
        (13, 9),
        (14, 10),
        (15, 11),
        (16, 0),
        (17, 1),
        (18, 2),
        (19, 3),
    ] {
        thin.nodes[nodes[far] as usize] = thin.nodes[nodes[near] as usize];
    }
    let message = refusal(&deck(&thin));
    assert!(
        message.contains(" (C3D20, line ") && message.contains("collapsed or turned inside out"),
        "{message}"
    );

    let mut twice = good();
    let copy = rubmap::solid::mesh::Element { id: 5000, ..twice.elements[4].clone() };
    twice.elements.push(copy);
    let message = refusal(&deck(&twice));
    assert!(message.starts_with("element 5000 (C3D20, line "), "{message}");
    assert!(message.contains("it has the nodes of element 5;"), "{message}");
}

/// High face displaced as a whole: along the axis, and beyond the turn by 2π/N; the distance is that after this turn, not after the opposite one.
#[test]
fn faces_almost_alike() {
    let message = refused(|mesh| {
        let highs: Vec<u32> = mesh.cyclic.iter().map(|pair| pair.1).collect();
        highs.iter().for_each(|&node| mesh.nodes[node as usize][2] += 0.01);
    });
    assert!(
        message.contains("By 2π/7, ") && message.contains("come within 1.000e-2 of each other"),
        "{message}"
    );
    let angle = 1e-3;
    let mut farthest: f64 = 0.0;
    let message = refused(|mesh| {
        let turn = Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::z()), angle);
        for (_, high) in mesh.cyclic.clone() {
            let at = Vector3::from(mesh.nodes[high as usize]);
            farthest = farthest.max(angle * at.xy().norm());
            mesh.nodes[high as usize] = (turn * at).into();
        }
    });
    let distance: f64 = message
        .split_once("come within ")
        .and_then(|(_, rest)| rest.split_once(" of each other"))
        .map(|(number, _)| number.parse().unwrap())
        .unwrap_or_else(|| panic!("{message}"));
    assert!(distance > 0.5 * farthest && distance <= farthest, "{distance} {farthest}: {message}");
}

/// Numbers of sectors that the mesh does not have: parts and multiples of the true one.
#[test]
fn another_number_of_sectors() {
    let text = deck(&sector_mesh(&impeller(10)));
    for sectors in [2, 5, 20] {
        let settings = MeshSettings { sectors: Some(sectors), ..settings() };
        let message = from_mesh::sector(&read_mesh(&text), &settings).unwrap_err().to_string();
        let expected = format!("no face of the skin turned by 2π/{sectors} meets another");
        assert!(message.starts_with(&expected), "{message}");
    }
}

/// Clamps of the corners of faces alone, as a set of the settings or as supports, leave their edges free.
#[test]
fn a_clamp_of_corner_nodes_only() {
    let parameters = impeller(7);
    let mesh = sector_mesh(&parameters);
    let corners: std::collections::BTreeSet<u32> =
        mesh.elements.iter().flat_map(|element| element.nodes[..8].iter().copied()).collect();
    let bore = |node: u32| {
        let [x, y, _] = mesh.nodes[node as usize];
        (x.hypot(y) - parameters.bore_radius).abs() < 1e-6
    };
    let set: String =
        corners.into_iter().filter(|node| bore(*node)).map(|node| format!("{}\n", node + 1)).collect();
    let text = format!("{}*NSET, NSET=BORE\n{set}", deck(&mesh));
    let expected = "the clamp holds the corners of a face of element ";
    let message = refusal(&format!("{text}*BOUNDARY\nBORE, 1, 3\n"));
    assert!(message.starts_with(expected), "{message}");
    let settings = MeshSettings { clamp_set: Some("BORE".into()), ..settings() };
    let message = from_mesh::sector(&read_mesh(&text), &settings).unwrap_err().to_string();
    assert!(message.starts_with(expected) && message.contains("with 7 sectors about the axis"), "{message}");
}

/// Nothing that holds the wheel: a set of nodes without elements, no bore, one node of a single blade.
#[test]
fn no_clamp() {
    let mesh = good();
    let text = deck(&mesh);
    let far = "*NODE\n90001, 1000, 0, 0\n*NSET, NSET=FAR\n90001\n";
    let of_set = MeshSettings { clamp_set: Some("FAR".into()), ..settings() };
    let message = refusal_with(&format!("{text}{far}"), &of_set);
    assert!(message.starts_with("no node of the clamp belongs to an element"), "{message}");

    let axis = Some(Axis { origin: mesh.nodes[0], direction: [0.0, 0.0, 1.0] });
    let alone = MeshSettings { sectors: Some(1), axis, ..settings() };
    let message = refusal_with(&text, &alone);
    assert!(message.starts_with("nothing says where the wheel is held"), "{message}");

    let message = refusal_with(&format!("{text}*BOUNDARY\n1, 1, 3\n"), &alone);
    assert!(message.ends_with("is anything clamped?"), "{message}");
}

/// Units that do not belong together: constants that no solid has are refused, a wheel of another size is warned of.
#[test]
fn mixed_units() {
    let with = |change: fn(&mut SectorMesh)| {
        let mut mesh = good();
        change(&mut mesh);
        deck(&mesh)
    };
    let of_the_file = MeshSettings { materials: Default::default(), ..settings() };
    for (text, constant) in [
        (with(|mesh| mesh.sets[0].material.youngs_modulus *= 1e6), "youngs_modulus"),
        (with(|mesh| mesh.sets[0].material.density *= 1e12), "density"),
    ] {
        let message = refusal_with(&text, &of_the_file);
        let expected = format!("sector.json, /mesh/sets/WHEEL/{constant}: the value is ");
        assert!(
            message.starts_with(&expected) && message.contains("correct the value or the units"),
            "{message}"
        );
    }
    let metres = with(|mesh| mesh.nodes.iter_mut().flatten().for_each(|x| *x *= 1e-3));
    let package = made(&metres).unwrap().package().unwrap();
    let warnings = rubmap::package::look_at(package).unwrap().warnings();
    assert!(
        warnings.iter().any(|warning| warning.contains("the radius of the contact nodes is 1.")),
        "{warnings:?}"
    );
}

/// A million elements: all on the same nodes, or the last one on a node that is not there.
#[test]
fn a_million_elements_that_lie() {
    let mut text = deck(&good());
    let mut lines = "*ELEMENT, TYPE=C3D4, ELSET=WHEEL\n".to_owned();
    (0..1_000_000).for_each(|k| writeln!(lines, "{}, 1, 2, 3, 80", 10_000 + k).unwrap());
    text.insert_str(text.find("*MATERIAL").unwrap(), &lines);
    let message = refusal(&text);
    assert!(message.starts_with("element 10001 (C3D4, line "), "{message}");
    assert!(message.contains("it has the nodes of element 10000"), "{message}");
    let message = refusal(&text.replace("1009999, 1, 2, 3, 80", "1009999, 1, 2, 3, 999999"));
    assert!(message.contains("element 1009999 has node 999999, which the file does not have"), "{message}");
}

/// Files of every format that end before their last element: refused, never another model.
#[test]
fn truncated_files_of_every_format() {
    let mesh = good();
    for (text, last) in [
        (gmsh(&mesh), "$EndElements"),
        (vtu(&mesh), "</VTKFile>"),
        (ansys(&mesh), "       -1\n"),
        (nastran(&mesh), "ENDDATA"),
    ] {
        let end = text.rfind(last).unwrap();
        for part in 1..60 {
            let message = refusal(&text[..end * part / 60]);
            assert!(message.starts_with("line ") || message.contains("is it cut short?"), "{message}");
        }
    }
    // A deck has no end: cut between two elements it is a part of the sector.
    let text = deck(&mesh);
    let elements = text.find("*ELEMENT").unwrap();
    let end = text.find("*MATERIAL").unwrap();
    for part in 1..60 {
        let cut = end * part / 60;
        let message = refusal(&text[..cut]);
        let no_elements = message == "the file has no solid element" && cut < elements + 100;
        assert!(
            message.starts_with("line ") || no_elements || message.contains("with 7 sectors"),
            "{message}"
        );
    }
}
