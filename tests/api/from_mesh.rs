//! Models from meshes: bare, in a package, looked at before, and refused; the same content is the same model.

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
    post_to(api, "/v1/models", mesh, settings, labels).await
}

/// Posts a bare mesh to a path.
async fn post_to(api: &Api, path: &str, mesh: &str, settings: Option<Value>, labels: &str) -> Answer {
    let settings = settings.map_or(String::new(), |settings| {
        let text: String = settings.to_string().bytes().map(|byte| format!("%{byte:02x}")).collect();
        format!("settings={text}&")
    });
    let request = api
        .request("POST", &format!("{path}?{settings}{labels}"))
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

#[tokio::test]
async fn a_mesh_is_looked_at_and_patches_of_it_are_chosen() {
    let app = TestApp::start().await;
    let api = &app.api;
    // Neither a material nor a top speed.
    let look = post_to(api, "/v1/meshes/look", &deck(false), None, "").await;
    assert_eq!(look.status, 200, "{}", look.body);
    let places = |path: &str| look.body[path].as_array().unwrap().clone();
    let ids = places("node_ids");
    assert_eq!(places("positions").len(), 3 * ids.len());
    let triangles: u64 = places("patches").iter().map(|patch| patch["triangles"].as_u64().unwrap()).sum();
    assert_eq!(places("triangles").len() as u64, 3 * triangles);
    assert_eq!(
        (&look.body["sectors"], &look.body["axis"]),
        (&json!(10), &json!([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
    );
    let refusals = places("refusals");
    assert_eq!((refusals.len(), &refusals[0]["step"]), (1, &json!("materials")));
    assert!(look.body["price"]["seconds"].as_f64().unwrap() > 0.0);
    let named = |role: &str| {
        let patch = places("patches").into_iter().find(|patch| patch["role"] == role).unwrap();
        patch["at"].clone()
    };
    assert!(named("low").as_array().unwrap().is_empty() && named("high").as_array().unwrap().is_empty());

    // The patches that were found, named: the same model.
    let automatic = json!({"top_speed_rad_s": 4000.0, "name": "wheel"});
    let mut chosen = automatic.clone();
    (chosen["clamp_at"], chosen["contact_at"]) = (named("clamp"), named("contact"));
    let first = post(api, &deck(true), Some(automatic), "").await;
    let again = post(api, &deck(true), Some(chosen.clone()), "").await;
    assert_eq!((first.status.as_u16(), again.status.as_u16()), (201, 200), "{}", again.body);
    assert_eq!(again.text("/id"), first.text("/id"));

    let mut both = chosen;
    both["clamp_set"] = json!("BORE");
    for (mesh, settings, status, problem, says) in [
        (
            deck(true),
            Some(both),
            422,
            "invalid-package",
            "`clamp_set` and `clamp_at` both say where the clamp is",
        ),
        (deck(true), Some(json!({"clamp": 1})), 400, "invalid-parameter", "unknown field `clamp`"),
        (deck(true).replace("C3D8I", "C3D9"), None, 422, "invalid-package", "C3D9"),
        ("\0\0\0".to_owned(), None, 422, "invalid-package", "no mesh file of a known format"),
    ] {
        let answer = post_to(api, "/v1/meshes/look", &mesh, settings, "").await;
        let detail = answer.body["detail"].as_str().unwrap_or_default().to_owned();
        assert!(detail.contains(says), "{detail}");
        answer.problem(status, problem);
    }
    api.post("/v1/meshes/look", &json!({})).await.problem(415, "unsupported-media-type");
    assert_eq!(api.get("/v1/models").await.body["models"].as_array().unwrap().len(), 1);
    app.stop().await;
}

#[tokio::test]
async fn a_look_tells_of_a_mesh_that_is_too_large_for_the_service() {
    let app = TestApp::start_with(|config| config.memory_bytes = Some(20 << 20)).await;
    let look = post_to(&app.api, "/v1/meshes/look", &deck(true), None, "").await;
    let refusal = &look.body["refusals"][0];
    assert_eq!(refusal["step"], "memory", "{}", look.body);
    assert!(refusal["detail"].as_str().unwrap().starts_with("assembling this mesh needs "), "{refusal}");
    app.stop().await;
}
