//! Mesh of a model, before anything is computed of it.

use std::collections::HashMap;

use rubmap::package;

use super::app::TestApp;
use super::fields::{SECTORS, impeller};
use super::model;
use super::npz::Npz;
use super::vtk::{Vtk, raw};

/// A model has what it was sent: its nodes, its elements, its contact line.
#[tokio::test]
async fn a_mesh_is_the_one_of_the_package() {
    let app = TestApp::start_with(|config| config.upload_bytes = 64 << 20).await;
    let api = &app.api;
    let package = impeller();
    let mut file = std::io::Cursor::new(Vec::new());
    package::write(&package, &mut file).unwrap();
    let model = api.model(file.into_inner()).await;
    let mesh = format!("/v1/models/{model}/mesh");

    let sector = Vtk::new(raw(api, &format!("{mesh}?format=vtu&sector=0")).await);
    let sent: HashMap<u64, [f64; 3]> = package.nodes.iter().map(|node| (node.id, node.position)).collect();
    let (ids, points) = (sector.ids("node"), sector.vectors("Points"));
    assert_eq!(ids.len(), sent.len());
    for (id, point) in ids.iter().zip(&points) {
        assert!(point.iter().zip(sent[id]).all(|(a, b)| (a - b).abs() < 1e-9), "{id}");
    }
    assert!(!sector.text.contains("displacement") && !sector.has("stress"), "{:.900}", sector.text);
    let line: HashMap<u64, i32> = ids.iter().copied().zip(sector.counts("contact")).collect();
    for (place, contact) in package.manifest.contact.iter().enumerate() {
        assert_eq!(line[&contact.node], place as i32 + 1);
    }
    assert_eq!(line.values().filter(|place| **place > 0).count(), package.manifest.contact.len());

    let skin = Vtk::new(raw(api, &mesh.clone()).await);
    assert_eq!(skin.attribute("NumberOfCells"), SECTORS * sector.attribute("NumberOfCells"));
    let contact = |of: &Vtk| of.counts("contact").into_iter().filter(|place| *place > 0).count();
    let skin = Vtk::new(raw(api, &format!("{mesh}?format=vtp")).await);
    assert_eq!(contact(&skin), SECTORS * package.manifest.contact.len());
    let arrays = Npz::read(&raw(api, &format!("{mesh}?format=npz&sector=0")).await);
    assert_eq!(arrays.array("position").reals(), sector.reals("Points"));
    assert_eq!(arrays.array("contact").whole().iter().filter(|place| **place > 0).count(), contact(&sector));

    api.get(&format!("{mesh}?format=svg")).await.problem(400, "invalid-parameter");
    api.get(&format!("{mesh}?sector={SECTORS}")).await.problem(400, "invalid-parameter");
    api.get("/v1/models/nothing/mesh").await.problem(404, "model-not-found");
    let tagged = api.request("GET", &mesh).send().await.unwrap();
    let again = api.request("GET", &mesh).header("if-none-match", &tagged.headers()["etag"]);
    assert_eq!(again.send().await.unwrap().status(), 304);

    let bare = api.model(model::package(1.0)).await;
    let points = Vtk::new(raw(api, &format!("/v1/models/{bare}/mesh?format=vtp")).await);
    assert!(points.text.contains("no mesh"), "{:.600}", points.text);
    assert_eq!((points.attribute("NumberOfPoints"), points.attribute("NumberOfVerts")), (16, 16));
    app.stop().await;
}
