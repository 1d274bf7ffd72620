//! Contact lines by a shroud curve, where there is no one tip with sharp edges.

use rubmap::from_mesh::{self, FromMeshError, MeshSettings, Sector, TipSource};
use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{ImpellerParameters, Splitter, generate, impeller_sector};
use rubmap::mesh;
use rubmap::solid::element::ElementKind;

use crate::deck::deck;
use crate::meshes::block;

fn made(deck: &str, settings: &MeshSettings) -> Result<Sector, FromMeshError> {
    from_mesh::sector(&mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap(), settings)
}

fn with(curve: &[[f64; 2]]) -> MeshSettings {
    MeshSettings { shroud: Some(curve.to_vec()), ..MeshSettings::new(3000.0) }
}

/// Blade with a round tip along the axis, from r = 50 to 70 and z = 0 to 30: its edges are as smooth as its tip.
fn round() -> String {
    let blade = block(ElementKind::C3D8I, [6, 10, 6], |[across, along, up]| {
        let (across, up) = (across / 3.0 - 1.0, up / 6.0);
        let theta = across / 60.0;
        let r = 50.0 + 20.0 * up + 1.2 * up * (1.0 - across * across);
        [r * theta.cos(), r * theta.sin(), 3.0 * along]
    });
    deck(&blade)
}

#[test]
fn a_round_tip_is_found_by_the_shroud() {
    let deck = round();
    let settings = |curve: &[[f64; 2]]| MeshSettings { sectors: Some(1), ..with(curve) };
    assert!(made(&deck, &MeshSettings { shroud: None, ..settings(&[]) }).is_err());
    // The ridge lies at r = 71.2.
    let found = made(&deck, &settings(&[[71.5, -10.0], [71.7, 40.0]])).unwrap().found;
    let TipSource::Shroud([least, most]) = found.tip.0 else { panic!("{:?}", found.tip) };
    assert!((least - 0.34).abs() < 1e-3 && (most - 0.46).abs() < 1e-3, "{least} {most}");
    assert_eq!(found.contact.len(), 10);
    for point in &found.contact {
        let [r, theta, _] = point.position;
        assert!((r - 71.2).abs() < 1e-9 && theta.abs() < 1e-9, "{point:?}");
    }
    assert!(found.to_string().contains("along the shroud curve, 0.34"), "{found}");
    for (curve, begins) in [
        (&[[90.0, -10.0], [90.0, 40.0]][..], "the tip that is nearest to the curve `shroud` is 1"),
        (&[[0.0715, -0.01], [0.0717, 0.04]], "the tip that is nearest to the curve `shroud` is "),
        (&[[71.5, 0.0]], "the curve `shroud` has 1 points; 2 to 2000 are needed"),
        (&[[71.5, 0.0], [-71.5, 1.0]], "the curve `shroud` has r = -71.5, z = 1 at point 2"),
        (&[[71.5, 0.0], [71.5, 0.0]], "the curve `shroud` is a single point"),
    ] {
        let message = made(&deck, &settings(curve)).map(|_| ()).unwrap_err().to_string();
        assert!(message.starts_with(begins), "{message}");
    }
    let both = MeshSettings { contact_between: Some([1, 2]), ..settings(&[[71.5, -10.0], [71.7, 40.0]]) };
    let both = made(&deck, &both).map(|_| ()).unwrap_err().to_string();
    assert_eq!(both, "`contact_between` and `shroud` both say where the contact line is; leave one out");
}

/// The generator's wheel with splitters, and its contact nodes moved out by a clearance as the curve: the main blade's contact nodes again.
#[test]
fn the_main_blade_is_the_longer_one_along_the_shroud() {
    let parameters = ImpellerParameters {
        sectors: 7,
        contact_nodes: 5,
        element_order: ElementOrder::Quadratic,
        splitter: Some(Splitter::default()),
        top_speed_rad_s: 3000.0,
        ..ImpellerParameters::default()
    };
    let plain = impeller_sector(&parameters).unwrap().made_of(&parameters.material).mesh;
    let deck = deck(&plain);
    let tip =
        made(&deck, &MeshSettings { contact_nodes: 200, ..MeshSettings::new(3000.0) }).unwrap().found.contact;
    let moved = |clearance: f64| -> Vec<[f64; 2]> {
        tip.iter()
            .map(|p| [p.position[0] + clearance * p.normal[0], p.position[2] + clearance * p.normal[2]])
            .collect()
    };
    let settings = MeshSettings { contact_nodes: 5, ..with(&moved(0.3)) };
    let found = made(&deck, &settings).unwrap().found;
    let contact: Vec<u64> = found.contact.iter().map(|point| point.node).collect();
    let expected: Vec<u64> =
        generate(&parameters).unwrap().manifest.contact.iter().map(|contact| contact.node).collect();
    assert_eq!(contact, expected);
    let TipSource::Shroud([least, most]) = found.tip.0 else { panic!("{:?}", found.tip) };
    assert!(least > 0.29 && most < 0.31, "{least} {most}");
    let far = made(&deck, &with(&moved(20.0))).map(|_| ()).unwrap_err().to_string();
    assert!(far.contains("at most 0.1 of its length is taken for a clearance"), "{far}");
}
