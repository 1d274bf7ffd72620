//! Models from meshes: bare, in a package, and refused; the same content is the same model.

use std::fmt::Write as _;

use rubmap::impeller::{Preset, impeller_sector};
use serde_json::{Value, json};

use super::app::{Answer, Api, TestApp};
use super::model::zip;

/// Deck of the generator's small impeller, without axis, sectors, sets and supports.
fn deck(material: bool) -> String {
    let parameters = Preset::Small.parameters();
    let mesh = impeller_sector(&parameters).unwrap().made_of(&parameters.material).mesh;
    let mut deck = "*NODE\n".to_owned();
    for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.nodes) {
        writeln!(deck, "{id}, {x:?}, {y:?}, {z:?}").unwrap();
    }
    deck += "*ELEMENT, TYPE=C3D8I, ELSET=WHEEL\n";
    for element in &mesh.elements {
        let nodes: Vec<String> = element.nodes.iter().map(|node| (node + 1).to_string()).collect();
        writeln!(deck, "{}, {}", element.id, nodes.join(", ")).unwrap();
    }
    if material {
        deck += "*MATERIAL, NAME=TI\n*ELASTIC\n114000., 0.32\n*DENSITY\n4.43e-9\n*SOLID SECTION, ELSET=WHEEL, MATERIAL=TI\n";
    }
    deck
}

/// Posts a bare mesh with these settings.
async fn post(api: &Api, mesh: &str, settings: Option<Value>, labels: &str) -> Answer {
    let settings = settings.map_or(String::new(), |settings| {
        let text: String = settings.to_string().bytes().map(|byte| format!("%{byte:02x}")).collect();
        format!("settings={text}&")
    });
    let request = api
        .request("POST", &format!("/v1/models?{settings}{labels}"))
        .header("content-type", "application/octet-stream")
        .body(mesh.to_owned());
    Answer::of(request.send().await.unwrap()).await
}

#[tokio::test]
async fn a_mesh_becomes_a_model_bare_and_in_a_package() {
    let app = TestApp::start().await;
    let api = &app.api;
    let speed = json!({"top_speed_rad_s": 4000.0, "name": "wheel"});
    let first = post(api, &deck(true), Some(speed.clone()), "tags=mesh").await;
    assert_eq!(first.status, 201, "{}", first.body);
    let found = first.body["found"].as_array().unwrap();
    assert!(found.iter().any(|line| line.as_str().unwrap().starts_with("sectors: 10 (found)")), "{found:?}");
    assert_eq!((&first.body["gyroscopic"], &first.body["tags"]), (&json!(true), &json!(["mesh"])));
    assert!(first.body["in_si"]["wheel"]["polar_inertia_kg_m2"].as_f64().unwrap() > 0.0);
    let detail = api.get(&format!("/v1/models/{}", first.text("/id"))).await.body;
    assert_eq!(detail["found"], first.body["found"]);

    // The same mesh in a package, in two files.
    let whole = deck(true);
    let (mesh, rest) = whole.split_at(whole.find("*MATERIAL").unwrap());
    let mut manifest = speed;
    manifest["mesh_file"] = json!("wheel.inp");
    let files = [
        ("sector.json", manifest.to_string()),
        ("wheel.inp", "*INCLUDE, INPUT=mesh.inp\n".to_owned() + rest),
        ("mesh.inp", mesh.to_owned()),
    ];
    let again = api.upload(zip(&files, 6)).await;
    assert_eq!((again.status.as_u16(), again.text("/id")), (200, first.text("/id")));
    app.stop().await;
}

#[tokio::test]
async fn meshes_that_make_no_model_are_refused_with_the_reason() {
    let app = TestApp::start().await;
    let api = &app.api;
    let speed = || Some(json!({"top_speed_rad_s": 4000.0}));
    for (mesh, settings, status, problem, says) in [
        (deck(true), None, 400, "invalid-parameter", "a bare mesh needs the settings of its model"),
        (deck(true), Some(json!({"top_speed": 1})), 400, "invalid-parameter", "unknown field `top_speed`"),
        (
            deck(true),
            Some(json!({"top_speed_rad_s": 0.0})),
            422,
            "invalid-package",
            "the top speed 0 rad/s must be positive",
        ),
        (
            deck(false),
            speed(),
            422,
            "invalid-package",
            "element 1 has no material; give one under `materials`",
        ),
        (
            deck(true).replace("*MATERIAL", "*EQUATION\n*MATERIAL"),
            speed(),
            422,
            "invalid-package",
            "a linear equation between displacements",
        ),
        (
            deck(true) + "*INCLUDE, INPUT=/etc/passwd\n",
            speed(),
            422,
            "invalid-package",
            "the included file \"/etc/passwd\" cannot be read",
        ),
        (
            "solid wheel\nfacet normal 0 0 1\n".to_owned(),
            speed(),
            422,
            "invalid-package",
            "this is an STL surface",
        ),
        ("\0\0\0".to_owned(), speed(), 422, "invalid-package", "no mesh file of a known format"),
    ] {
        let answer = post(api, &mesh, settings, "").await;
        let detail = answer.body["detail"].as_str().unwrap_or_default().to_owned();
        assert!(detail.contains(says), "{detail}");
        answer.problem(status, problem);
    }
    let manifest = json!({"mesh_file": "wheel.msh", "top_speed_rad_s": 1.0}).to_string();
    let lacking = api.upload(zip(&[("sector.json", manifest), ("wheel.inp", deck(true))], 6)).await;
    assert_eq!(lacking.problem(422, "invalid-package")[0]["pointer"], "/mesh_file");
    assert_eq!(api.get("/v1/models").await.body["models"], json!([]));
    app.stop().await;
}
