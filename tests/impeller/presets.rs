//! Presets and requests: sizes, the paper's numbers, and what a user may write.

use std::f64::consts::{PI, TAU};

use rubmap::analysis::run::MeshFacts;
use rubmap::assembly::SectorDofs;
use rubmap::dynamics::sector::SectorModel;
use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{
    ImpellerError, ImpellerParameters, ImpellerRequest, PaperCasing, Preset, generate, impeller_sector,
};
use rubmap::package::{Limits, read, read_mesh, write};
use rubmap::solid::frame::AxisFrame;
use rubmap::solid::mesh::SectorMesh;
use serde_json::{Value, json};
use utoipa::PartialSchema;

fn request(value: Value) -> ImpellerRequest {
    serde_json::from_value(value).unwrap()
}

#[test]
fn presets_have_the_sizes_they_promise() {
    for (preset, own) in
        [(Preset::Small, 2_000..4_000), (Preset::Medium, 18_000..22_000), (Preset::Paper, 115_000..125_000)]
    {
        let parameters = preset.parameters();
        let sector = impeller_sector(&parameters).unwrap();
        let dofs = SectorDofs::new(&sector.made_of(&parameters.material));
        println!(
            "{preset:?}: {} own DOF, {} rows, {} elements",
            dofs.own,
            dofs.list.len(),
            sector.mesh.elements.len()
        );
        assert!(own.contains(&dofs.own), "{preset:?}: {}", dofs.own);
        assert_eq!((sector.sectors, sector.contact.len()), (10, 10));
        let full = preset != Preset::Small;
        assert_eq!(parameters.splitter.is_some(), full);
        assert_eq!(parameters.element_order == ElementOrder::Quadratic, full);
    }
    assert_eq!(Preset::Small.parameters(), ImpellerParameters::default());
}

/// Thickness at the tip is found in the mesh, to the facets of a coarse one. Splitter, other blades and both ends of the blade do not disturb it.
#[test]
fn thickness_at_the_tip_is_found_in_the_mesh() {
    for (changes, tip) in [
        (json!({"preset": "small"}), 0.6),
        (json!({"preset": "medium", "tip_thickness": 0.9}), 0.9),
        (json!({"preset": "small", "contact_nodes": 4, "tip_thickness": 1.2, "sectors": 7}), 1.2),
    ] {
        let parameters = request(changes).resolve().unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        write(&generate(&parameters).unwrap(), &file).unwrap();
        let limits = Limits::default();
        let mesh = read_mesh(file.path(), &limits).unwrap().unwrap();
        let sector = read(file.path(), &limits).unwrap().sector;
        let found = MeshFacts::of(&mesh, &sector).tip_thickness.unwrap();
        println!("{tip}: {found}");
        assert!((0.95 * tip..1.1 * tip).contains(&found), "{tip}: {found}");
        for side in [1.0, -1.0] {
            let mut package = generate(&parameters).unwrap();
            for contact in &mut package.manifest.contact {
                contact.node = edge_node(&mesh, &sector, contact.node, side * tip);
            }
            let file = tempfile::NamedTempFile::new().unwrap();
            write(&package, &file).unwrap();
            let on_edge = read(file.path(), &limits).unwrap().sector;
            let found = MeshFacts::of(&mesh, &on_edge).tip_thickness.expect("a thickness from an edge");
            println!("{tip} from the edge {side}: {found}");
            assert!((0.9 * tip..1.15 * tip).contains(&found), "{tip} from the edge {side}: {found}");
        }
    }
}

/// Id of the node half a thickness beside contact node `id`: on the tip's edge towards larger θ where `thickness` is positive, else on the
/// other one.
fn edge_node(mesh: &SectorMesh, sector: &SectorModel, id: u64, thickness: f64) -> u64 {
    let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1).unwrap();
    let contact = sector.contact.iter().find(|contact| contact.id == id).unwrap();
    let [r, theta, z] = contact.position;
    let beside = |position: [f64; 3]| {
        let [its_r, its_theta, its_z] = frame.coordinates(position);
        // Edges of the tip are as far from the axis as its middle, within what the blade leans.
        let turn = (its_theta - theta + PI).rem_euclid(TAU) - PI;
        let away = r * turn * thickness.signum();
        let off = (its_r - r).hypot(its_z - z);
        (away > 0.3 * thickness.abs()).then_some(off + (away - 0.5 * thickness.abs()).abs())
    };
    let found = mesh.nodes.iter().zip(&mesh.node_ids).filter_map(|(node, id)| Some((beside(*node)?, *id)));
    found.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1
}

/// Casing of the paper: 3 %, 2.2 % and 4.25 % of the height at the trailing edge, so that 1.25 % and 2.1 % (2.05) are pushed in.
#[test]
fn casing_of_the_paper() {
    let parameters = ImpellerParameters { outlet_blade_height: 8.0, ..Preset::Paper.parameters() };
    let casing = PaperCasing::of(&parameters);
    assert_eq!(casing.leading_clearance, 0.24);
    assert!((casing.trailing_clearance - 0.176).abs() < 1e-15);
    assert_eq!(casing.restriction, 0.34);
}

#[test]
fn requests_take_a_preset_and_change_what_they_name() {
    assert_eq!(request(json!({})).resolve().unwrap(), ImpellerParameters::default());
    assert_eq!(request(json!({"preset": "paper"})).resolve().unwrap(), Preset::Paper.parameters());
    let given = request(json!({
        "preset": "paper",
        "sectors": 13,
        "wrap_deg": 30,
        "mesh": {"disk": 4},
        "material": {"density": 4.5e-9},
        "splitter": {"leading_edge": 0.5},
    }));
    let mut expected = Preset::Paper.parameters();
    expected.sectors = 13;
    expected.wrap_deg = 30.0;
    expected.mesh.disk = 4;
    expected.material.density = 4.5e-9;
    expected.splitter.as_mut().unwrap().leading_edge = 0.5;
    assert_eq!(given.resolve().unwrap(), expected);
    // A splitter can be taken away and be put where the preset has none.
    assert_eq!(request(json!({"preset": "medium", "splitter": null})).resolve().unwrap().splitter, None);
    assert!(request(json!({"splitter": {}})).resolve().unwrap().splitter.is_some());
    // The request is stored as the user wrote it.
    assert_eq!(serde_json::to_value(&given).unwrap()["mesh"], json!({"disk": 4}));
    assert_eq!(request(serde_json::to_value(&given).unwrap()), given);
    // Printed parameters are a request for themselves.
    let printed = serde_json::to_value(Preset::Medium.parameters()).unwrap();
    assert_eq!(request(printed).resolve().unwrap(), Preset::Medium.parameters());
}

#[test]
fn wrong_requests_name_the_field() {
    for (body, named) in [
        (json!({"sector": 10}), "sector"),
        (json!({"mesh": {"discs": 3}}), "mesh.discs"),
        (json!({"mesh": {"disk": "three"}}), "mesh.disk"),
        (json!({"mesh": {"disk": -1}}), "mesh.disk"),
        (json!({"mesh": [2, 8, 2, 3, 3]}), "mesh"),
        (json!({"preset": "medium", "splitter": [0.3]}), "splitter"),
        (json!({"splitter": [0.3]}), "splitter"),
        (json!({"sectors": null}), "sectors"),
        (json!({"element_order": "cubic"}), "element_order"),
        (json!({"sectors": 2}), "sectors"),
        (json!({"material": {"density": 0}}), "material.density"),
    ] {
        let field = match request(body.clone()).resolve() {
            Err(ImpellerError::Field { field, .. }) => field,
            Err(ImpellerError::Parameter { field, .. }) => field.to_owned(),
            other => panic!("{body}: {other:?}"),
        };
        assert_eq!(field, named, "{body}");
    }
    let unknown = serde_json::from_value::<ImpellerRequest>(json!({"preset": "large"}));
    assert!(unknown.unwrap_err().to_string().contains("`small`, `medium`, `paper`"));
}

/// Schema of the contract: it knows every field a request may have, and no other.
#[test]
fn schema_has_every_field() {
    let schema = serde_json::to_value(ImpellerRequest::schema()).unwrap();
    let mut fields: Vec<String> = schema["properties"].as_object().unwrap().keys().cloned().collect();
    let parameters = serde_json::to_value(ImpellerParameters::default()).unwrap();
    let mut expected: Vec<String> = parameters.as_object().unwrap().keys().cloned().collect();
    expected.push("preset".to_owned());
    fields.sort();
    expected.sort();
    assert_eq!(fields, expected);
    assert_eq!(schema["additionalProperties"], json!(false));
    assert_eq!(schema.get("required"), None);
}

/// Preset in SI units: it is the same wheel, not one of 130 metres.
#[test]
fn presets_are_told_in_the_units_asked_for() {
    let of = |given| request(given).resolve();
    let si = json!({"length": "m", "force": "N", "time": "s", "mass": "kg"});
    let found = of(json!({"units": si, "outlet_radius": 0.14})).unwrap();
    assert_eq!((found.outlet_radius, found.sectors, found.wrap_deg), (0.14, 10, 25.0));
    for (value, expected) in [
        (found.axial_length, 0.062),
        (found.tip_thickness, 0.6e-3),
        (found.material.youngs_modulus, 114e9),
        (found.material.density, 4430.0),
    ] {
        assert!((value / expected - 1.0).abs() < 1e-12, "{value} for {expected}");
    }
    let inch = json!({"length": "in", "force": "lbf", "time": "s", "mass": "slinch"});
    assert!((of(json!({"units": inch})).unwrap().bore_radius * 25.4 / 16.0 - 1.0).abs() < 1e-12);
    let furlong = json!({"length": "furlong", "force": "N", "time": "s", "mass": "kg"});
    let refused = of(json!({"units": furlong})).unwrap_err().to_string();
    assert!(refused.contains("units.length"), "{refused}");
}
