//! Modes, deflection shapes and instants of the whole wheel as files: VTK's files by a strict XML reader, closed wheels, volumes.

use std::collections::HashMap;

use reqwest::StatusCode;
use rubmap::impeller::{ImpellerParameters, MeshDensities, generate};
use rubmap::package;
use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::model;
use super::npz::Npz;
use super::vtk::{Vtk, raw};

pub(super) const SECTORS: usize = 5;

/// Package of a small impeller with a mesh.
pub(super) fn impeller() -> package::raw::RawPackage {
    let mesh = MeshDensities {
        between_contact_nodes: 1,
        blade_height: 2,
        blade_thickness: 1,
        half_passage: 1,
        disk: 1,
    };
    generate(&ImpellerParameters { sectors: SECTORS, contact_nodes: 4, mesh, ..Default::default() }).unwrap()
}

/// Number of nodes of the high face, clamped ones too: a sector read back has as many more of its own.
fn high_nodes(package: &package::raw::RawPackage) -> usize {
    let (sin, cos) = (std::f64::consts::TAU / SECTORS as f64).sin_cos();
    let back = |[x, y, z]: [f64; 3]| [x * cos + y * sin, y * cos - x * sin, z];
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    let is_high = |at: [f64; 3]| package.nodes.iter().any(|node| near(node.position, back(at)));
    package.nodes.iter().filter(|node| is_high(node.position)).count()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

const GAUSS: [f64; 2] = [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];

/// Volume of a hexahedron in VTK's order: the integral of the determinant of its trilinear map, exact with two points an axis.
fn volume(corners: [[f64; 3]; 8]) -> f64 {
    let signs = |k: usize| {
        let (x, y) = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)][k % 4];
        [x, y, if k < 4 { -1.0 } else { 1.0 }]
    };
    let mut volume = 0.0;
    for xi in GAUSS {
        for eta in GAUSS {
            for zeta in GAUSS {
                let mut map = [[0.0; 3]; 3];
                for (k, corner) in corners.iter().enumerate() {
                    let [a, b, c] = signs(k);
                    let (x, y, z) = (1.0 + a * xi, 1.0 + b * eta, 1.0 + c * zeta);
                    for (axis, value) in corner.iter().enumerate() {
                        map[0][axis] += 0.125 * a * y * z * value;
                        map[1][axis] += 0.125 * x * b * z * value;
                        map[2][axis] += 0.125 * x * y * c * value;
                    }
                }
                volume += dot(cross(map[0], map[1]), map[2]);
            }
        }
    }
    volume
}

/// Share of a face in the volume within a closed surface: ∮ x·n dA/3 over a bilinear face.
fn flux(corners: [[f64; 3]; 4]) -> f64 {
    let mut flux = 0.0;
    for xi in GAUSS {
        for eta in GAUSS {
            let (mut at, mut along, mut across) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            for (k, corner) in corners.iter().enumerate() {
                let (a, b) = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)][k];
                for (axis, value) in corner.iter().enumerate() {
                    at[axis] += 0.25 * (1.0 + a * xi) * (1.0 + b * eta) * value;
                    along[axis] += 0.25 * a * (1.0 + b * eta) * value;
                    across[axis] += 0.25 * (1.0 + a * xi) * b * value;
                }
            }
            flux += dot(at, cross(along, across)) / 3.0;
        }
    }
    flux
}

const FACES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

#[tokio::test]
async fn a_wheel_is_closed_and_its_modes_are_where_they_belong() {
    let app = TestApp::start_with(|config| config.upload_bytes = 64 << 20).await;
    let api = &app.api;
    let package = impeller();
    let mut file = std::io::Cursor::new(Vec::new());
    package::write(&package, &mut file).unwrap();
    let model = api.model(file.into_inner()).await;
    let modes = format!("/v1/models/{model}/modes");
    api.get(&modes).await.problem(409, "not-reduced");
    let analysis =
        json!({"model": model, "modes_per_speed": 4, "speeds": {"values": [0.0], "unit": "rad_s"}});
    let job = api.post("/v1/modal-analyses", &analysis).await.text("/id");
    assert_eq!(api.finish(&job).await["status"], "successful");

    let list = api.get(&format!("{modes}?speed_rad_s=1000")).await.body;
    assert_eq!(list["nodal_diameters"].as_array().unwrap().len(), SECTORS / 2 + 1, "{list}");
    for listed in list["nodal_diameters"].as_array().unwrap() {
        assert_eq!(listed["frequencies_hz"].as_array().unwrap().len(), 4, "as many as are kept: {listed}");
    }
    let in_rpm = api.get(&format!("{modes}?speed_rad_s=1000&units=rpm")).await.body;
    assert!((in_rpm["speed_rpm"].as_f64().unwrap() - 9549.2966).abs() < 1e-3, "{in_rpm}");
    let highest = api.get(&format!("/v1/models/{model}")).await.body["speeds_rad_s"]
        .as_array()
        .unwrap()
        .last()
        .cloned();
    let beyond = format!("{modes}?speed_rad_s={}", highest.unwrap().as_f64().unwrap() * 1.01);
    let refused = api.get(&beyond).await;
    assert_eq!(refused.problem(422, "invalid-request")[0]["parameter"], "speed_rad_s");
    assert!(refused.body["detail"].as_str().unwrap().contains("not extrapolated"), "{}", refused.body);
    api.get(&format!("{modes}?modes_per_speed=9")).await.problem(409, "not-reduced");
    let tagged = api.request("GET", &modes).send().await.unwrap();
    let tag = tagged.headers()["etag"].clone();
    let again = api.request("GET", &modes).header("if-none-match", &tag).send().await.unwrap();
    assert_eq!(again.status(), StatusCode::NOT_MODIFIED);
    for (query, parameter) in [
        ("format=vtu", "nodal_diameter"),
        ("format=vtu&nodal_diameter=3", "nodal_diameter"),
        ("format=vtu&nodal_diameter=1&mode=5", "mode"),
        ("format=vtu&nodal_diameter=1&frames=3", "frames"),
        ("format=vtu&nodal_diameter=1&view=front", "view"),
        ("mode=1", "mode"),
        ("nodal_diameter=1", "nodal_diameter"),
        ("stress=true", "stress"),
        ("format=vtu&nodal_diameter=1&sector=5", "sector"),
        ("format=vtu&nodal_diameter=0&motion=travelling", "motion"),
    ] {
        let problem = api.get(&format!("{modes}?{query}")).await;
        let items = problem.problem(400, "invalid-parameter");
        assert_eq!(items[0]["parameter"], parameter, "{query}");
    }
    for form in ["csv", "plotly"] {
        api.get(&format!("{modes}?format={form}")).await.problem(400, "invalid-parameter");
    }

    let mode = format!("{modes}?speed_rad_s=1000&nodal_diameter=2&mode=1&motion=travelling&stress=true");
    let wheel = Vtk::new(raw(api, &format!("{mode}&format=vtu")).await);
    assert!(wheel.text.contains("9549 rpm (1000.0 rad/s)"), "{:.500}", wheel.text);
    assert!(wheel.text.contains("largest displacement 1, stress for it"));
    let without =
        Vtk::new(raw(api, &format!("{mode}&format=vtu").replace("stress=true", "stress=false")).await);
    assert!(!without.text.contains("stress") && !without.has("excluded"), "{:.500}", without.text);
    let (nodes, high) = (package.nodes.len(), high_nodes(&package));
    assert_eq!(wheel.attribute("NumberOfPoints"), SECTORS * (nodes - high));
    let (points, cells) = (wheel.vectors("Points"), wheel.cells());
    assert_eq!((points.len(), cells.len()), (SECTORS * (nodes - high), wheel.attribute("NumberOfCells")));
    assert!(wheel.bytes("types", "UInt8").iter().all(|kind| *kind == 12), "hexahedra");

    // Every face is shared by two cells or on the skin.
    let mut faces: HashMap<Vec<usize>, usize> = HashMap::new();
    let mut total = 0.0;
    for cell in &cells {
        let corners: [[f64; 3]; 8] = std::array::from_fn(|k| points[cell[k]]);
        let volume = volume(corners);
        assert!(volume > 0.0);
        total += volume;
        for face in FACES {
            let mut face = face.map(|k| cell[k]).to_vec();
            face.sort_unstable();
            *faces.entry(face).or_default() += 1;
        }
    }
    assert!(faces.values().all(|uses| *uses <= 2));
    let skin = Vtk::new(raw(api, &format!("{mode}&format=vtp")).await);
    let (corners, polygons) = (skin.vectors("Points"), skin.cells());
    assert_eq!(polygons.len(), skin.attribute("NumberOfPolys"));
    assert_eq!(polygons.len(), faces.values().filter(|uses| **uses == 1).count());
    let within: f64 = polygons.iter().map(|face| flux(std::array::from_fn(|k| corners[face[k]]))).sum();
    assert!((within / total - 1.0).abs() < 1e-10, "{within} {total}");

    // A travelling wave of two nodal diameters: the amplitude is alike in all sectors, the largest is 1.
    let amplitude = wheel.reals("displacement_amplitude");
    let own = nodes - high;
    for (point, value) in amplitude.iter().enumerate() {
        assert!((value - amplitude[point % own]).abs() < 1e-12);
    }
    assert!((amplitude.iter().copied().fold(0.0, f64::max) - 1.0).abs() < 1e-12);
    let (stress, von_mises) = (wheel.reals("stress"), wheel.reals("von_mises"));
    assert_eq!((stress.len(), von_mises.len()), (6 * points.len(), points.len()));
    assert!(von_mises.iter().all(|value| value.is_finite()) && von_mises.iter().any(|value| *value > 0.0));

    // One sector has its own nodes as the wheel has them, and the high face as the next sector has it.
    let sector = Vtk::new(raw(api, &format!("{mode}&format=vtu&sector=4")).await);
    assert_eq!(sector.attribute("NumberOfPoints"), nodes);
    let (there, here) = (wheel.vectors("displacement"), sector.vectors("displacement"));
    let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * 100.0);
    let mut met = 0;
    for (place, at) in sector.vectors("Points").into_iter().enumerate() {
        let same = points.iter().position(|point| close(*point, at)).unwrap();
        assert!(there[same].iter().zip(here[place]).all(|(a, b)| (a - b).abs() < 1e-10));
        met += usize::from(same < own);
    }
    assert_eq!(met, high, "the last sector meets the first");

    let arrays = Npz::read(&raw(api, &format!("{mode}&format=npz")).await);
    assert_eq!(arrays.array("displacement").shape, [1, points.len(), 3]);
    assert_eq!(arrays.array("displacement").reals(), wheel.reals("displacement"));
    assert_eq!(arrays.array("connectivity").whole().len(), 8 * cells.len());
    let series = raw(api, &format!("{mode}&format=pvd&frames=3&sector=0")).await;
    let series = zip::ZipArchive::new(std::io::Cursor::new(series)).unwrap();
    let names: Vec<String> = series.file_names().map(|name| name.unwrap().into_owned()).collect();
    assert_eq!(names.len(), 4);
    assert!(
        names.iter().any(|name| name == "series.pvd") && names.iter().any(|name| name == "series_0002.vtu"),
        "{names:?}"
    );
    let svg = String::from_utf8(raw(api, &format!("{mode}&format=svg")).await).unwrap();
    assert!(roxmltree::Document::parse(&svg).is_ok());

    // The default is the finest reduction: a finer one gives another answer.
    let finer = json!({"model": model, "modes_per_speed": 5, "speeds": {"values": [0.0], "unit": "rad_s"}});
    let job = api.post("/v1/modal-analyses", &finer).await.text("/id");
    assert_eq!(api.finish(&job).await["status"], "successful");
    let changed = api.request("GET", &modes).header("if-none-match", &tag).send().await.unwrap();
    assert_eq!(changed.status(), StatusCode::OK);
    assert_eq!(changed.json::<Value>().await.unwrap()["modes_per_speed"], 5);
    app.stop().await;
}

/// Runs a sweep of the impeller at two speeds, with stress, and the state of the second.
async fn sweep_with_states(api: &Api) -> Value {
    let mut file = std::io::Cursor::new(Vec::new());
    package::write(&impeller(), &mut file).unwrap();
    let model = api.model(file.into_inner()).await;
    let mut request = sweep_of(&model);
    request["speeds"] = json!({"values": [1200.0, 1300.0], "unit": "rad_s"});
    request["record"] = json!({"histories": {"speeds": [1], "quantities": ["state"]}, "stress": {}});
    request
}

/// A sweep records the state of a speed; its report shows it.
#[tokio::test]
async fn a_report_shows_the_wheel_where_it_moves_most() {
    let app = TestApp::start_with(|config| config.upload_bytes = 64 << 20).await;
    let api = &app.api;
    let request = sweep_with_states(api).await;
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let page = String::from_utf8(raw(api, &format!("/v1/jobs/{id}/report")).await).unwrap();
    assert!(
        page.contains(", 12414 rpm (1300.0 rad/s)") && page.contains("Stress and margin"),
        "{page:.2000}"
    );
    let picture =
        raw(api, &format!("/v1/jobs/{id}/fields?speed=1&stress=true&format=png&view=meridional")).await;
    assert!(picture.starts_with(b"\x89PNG"));
    api.get(&format!("/v1/jobs/{id}/fields?speed=0")).await.problem(404, "history-not-recorded");
    app.stop().await;
}

/// A field with its static part has the largest stress of the sweep, at the same node, blade and instant: the sweep follows stress in
/// the coordinates of the reduction, the field is made of displacement.
#[tokio::test]
async fn a_field_with_its_static_part_has_the_largest_stress_of_the_sweep() {
    let app = TestApp::start_with(|config| config.upload_bytes = 64 << 20).await;
    let api = &app.api;
    let mut request = sweep_with_states(api).await;
    request["scene"]["centrifugal_stiffening"] = json!(true);
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let stress = api.get(&format!("/v1/jobs/{id}/stress")).await.body["speeds"][1]["stress"].clone();
    let largest = &stress["largest"];
    let fields = format!("/v1/jobs/{id}/fields?speed=1&format=npz&stress=true");
    let time = async |instant: u32| {
        Npz::read(&raw(api, &format!("{fields}&instant={instant}")).await).array("time").reals()[0]
    };
    let (first, second) = (time(0).await, time(1).await);
    let revolution = largest["revolution"].as_f64().unwrap();
    let instant = ((revolution - first) / (second - first)).round();
    let at = format!("{fields}&instant={instant}");
    let total = Npz::read(&raw(api, &format!("{at}&static=include")).await);
    let alone = Npz::read(&raw(api, &at).await);
    assert!((total.array("time").reals()[0] - revolution).abs() < 1e-9);
    let (nodes, sectors) = (total.array("node").ids(), total.array("sector").whole());
    let is_there = |k: &usize| {
        nodes[*k] == largest["node"].as_u64().unwrap()
            && sectors[*k] as u64 == largest["sector"].as_u64().unwrap()
    };
    let place = (0..nodes.len()).find(is_there).unwrap();
    let expected = largest["von_mises"].as_f64().unwrap();
    let found = total.array("von_mises").reals()[place];
    // The sweep's rows are in single precision.
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");

    // What is added is the same in every sector, up to its turn, and is what the files have apart.
    for name in ["displacement", "stress"] {
        let [sum, vibration] = [&total, &alone].map(|file| file.array(name).reals());
        let fixed = total.array(&format!("static_{name}")).reals();
        let most = sum.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        assert!(fixed.iter().any(|x| x.abs() > 1e-3 * most), "{name}");
        for ((sum, vibration), fixed) in sum.iter().zip(&vibration).zip(&fixed) {
            assert!((sum - vibration - fixed).abs() < 1e-12 * most, "{name}: {sum} {vibration} {fixed}");
        }
    }
    // What the sweep claims is the largest of what is not excluded, and no more than the largest of all.
    let excluded = total.array("excluded").whole();
    let von_mises = total.array("von_mises").reals();
    let claimed = von_mises.iter().zip(&excluded).filter(|(_, excluded)| **excluded == 0);
    let most = claimed.fold(0.0f64, |most, (value, _)| most.max(*value));
    assert!((most / expected - 1.0).abs() < 1e-5, "{most} {expected}");
    assert!(excluded.contains(&1) && excluded[place] == 0);
    let vtu = Vtk::new(raw(api, &format!("{at}&static=include").replace("npz", "vtu")).await);
    let radius = stress["excluded_radius"].as_f64().unwrap();
    for words in [
        format!("no stress is claimed within {radius:.3} mm of a contact node"),
        "12414 rpm (1300.0 rad/s)".to_owned(),
        "displacement and stress of the vibration and of the centrifugal load together".to_owned(),
    ] {
        assert!(vtu.text.contains(&words), "{words}: {:.600}", vtu.text);
    }
    let flags: Vec<i64> = vtu.bytes("excluded", "UInt8").into_iter().map(i64::from).collect();
    assert_eq!(flags, excluded);
    let vibration = Vtk::new(raw(api, &at.replace("npz", "vtu")).await);
    assert!(
        vibration.text.contains("displacement and stress of the vibration alone"),
        "{:.600}",
        vibration.text
    );
    assert!(vtu.has("static_displacement") && vtu.has("static_stress"));
    assert_eq!(vtu.reals("von_mises"), total.array("von_mises").reals());
    let shape = api.get(&format!("/v1/jobs/{id}/fields?speed=1&engine_order=1&static=include")).await;
    assert_eq!(shape.problem(400, "invalid-parameter")[0]["parameter"], "static");
    app.stop().await;
}

/// A wheel without a mesh gives fields at its nodes, of what was recorded of them.
#[tokio::test]
async fn a_recorded_run_gives_instants_and_deflection_shapes() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    let fields = request.as_object_mut().unwrap();
    fields.remove("speeds");
    fields.insert("speed".to_owned(), json!({"value": 540.0, "unit": "rad_s"}));
    let without = api.post("/v1/case-studies", &request).await.text("/id");
    assert_eq!(api.finish(&without).await["status"], "successful");
    api.get(&format!("/v1/jobs/{without}/fields")).await.problem(404, "history-not-recorded");

    request["record"] = json!({"revolutions": [8, 10], "quantities": ["displacement", "state"]});
    // The sensor is at a contact node, whose history the field must repeat.
    request["sensors"] = json!([{"node": 3, "component": "radial", "sector": 2}]);
    let answer = api.post("/v1/case-studies", &request).await;
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let path = format!("/v1/jobs/{id}/fields");
    let histories: Value = api.get(&format!("/v1/jobs/{id}/histories")).await.body;
    let history: Vec<f64> = histories["sensors"][0]["displacement"]
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect();
    for instant in [0, 17, history.len() - 1] {
        let vtu = Vtk::new(raw(api, &format!("{path}?instant={instant}&format=vtu")).await);
        assert!(vtu.text.contains("no mesh") && !vtu.has("von_mises"));
        assert_eq!((vtu.attribute("NumberOfPoints"), vtu.attribute("NumberOfCells")), (16, 16));
        let (points, moved, ids) = (vtu.vectors("Points"), vtu.vectors("displacement"), vtu.ids("node"));
        // Node 3 of the sector that is turned by half a turn.
        let at = (0..16).find(|&k| ids[k] == 3 && points[k][0] < 0.0 && points[k][1] < 0.0).unwrap();
        let radial = -(moved[at][0] + moved[at][1]) / 2f64.sqrt();
        let most = history.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        assert!((radial - history[instant]).abs() < 1e-9 * most, "{radial} {}", history[instant]);
    }
    for (query, parameter) in [
        (format!("instant={}", history.len()), "instant"),
        ("engine_order=100000".to_owned(), "engine_order"),
        ("engine_order=1&instant=1".to_owned(), "engine_order"),
        ("phase_deg=10".to_owned(), "phase_deg"),
        ("sector=4".to_owned(), "sector"),
        ("stress=true".to_owned(), "stress"),
        ("static=include".to_owned(), "static"),
    ] {
        let items = api.get(&format!("{path}?{query}")).await.problem(400, "invalid-parameter");
        assert_eq!(items[0]["parameter"], parameter, "{query}");
    }
    api.get(&format!("{path}?speed=3")).await.problem(404, "history-not-recorded");
    for form in ["json", "plotly"] {
        api.get(&format!("{path}?format={form}")).await.problem(400, "invalid-parameter");
    }
    // The mean of the history is the shape of engine order 0.
    let mean = Npz::read(&raw(api, &format!("{path}?engine_order=0&sector=2&format=npz")).await);
    let (u, ids) = (mean.array("displacement").reals(), mean.array("node").ids());
    let at = ids.iter().position(|id| *id == 3).unwrap();
    let radial = -(u[3 * at] + u[3 * at + 1]) / 2f64.sqrt();
    let expected = history.iter().sum::<f64>() / history.len() as f64;
    assert!((radial - expected).abs() < 1e-10, "{radial} {expected}");
    app.stop().await;
}
