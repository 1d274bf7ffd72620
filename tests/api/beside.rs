//! Files beside a reduction (its basis, stress in its coordinates) and the states that only they can read: left out, lost, damaged, and
//! on a disk without room.

use std::path::{Path, PathBuf};
use std::process::Command;

use reqwest::StatusCode;
use rubmap::impeller::generate;
use serde_json::{Value, json};
use sqlx::{ConnectOptions, Connection};

use super::app::{Api, TestApp, modal_analysis_of, sweep_of};
use super::archive::{download, repeat};
use super::generation::coarse;
use super::keeping::{rubmap, said};
use super::kill::points;
use super::model::files_in;
use super::program::Program;
use super::small_disk::SmallDisk;

/// Package of the generator's small impeller with a coarse mesh, of four sectors.
fn impeller() -> Vec<u8> {
    let mut given = serde_json::to_value(rubmap::impeller::ImpellerParameters::default()).unwrap();
    let wanted = coarse();
    for field in ["contact_nodes", "mesh"] {
        given[field] = wanted[field].clone();
    }
    given["sectors"] = 4.into();
    let mut bytes = std::io::Cursor::new(Vec::new());
    rubmap::package::write(&generate(&serde_json::from_value(given).unwrap()).unwrap(), &mut bytes).unwrap();
    bytes.into_inner()
}

/// Request for two speeds with stress, and states of the second.
fn recording(model: &str) -> Value {
    let mut request = sweep_of(model);
    request["speeds"] = json!({"values": [1200.0, 1300.0], "unit": "rad_s"});
    request["record"] = json!({"histories": {"speeds": [1], "quantities": ["state"]}, "stress": {}});
    request
}

/// Request for an analysis that leaves the basis out, insists on it, or says nothing of it.
fn analysis(model: &str, fields: Option<bool>) -> Value {
    let mut request = modal_analysis_of(model);
    if let Some(fields) = fields {
        request["fields"] = fields.into();
    }
    request
}

async fn finished(api: &Api, path: &str, request: &Value) -> String {
    let answer = api.post(path, request).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    id
}

async fn bytes(api: &Api, path: &str) -> (StatusCode, Vec<u8>) {
    let answer = api.request("GET", path).send().await.unwrap();
    (answer.status(), answer.bytes().await.unwrap().to_vec())
}

/// Paths of the files beside the only reduction whose names have `part` after the layout.
fn beside(data: &Path, part: &str) -> Vec<PathBuf> {
    let root = data.join("bases");
    let folders = if root.exists() { files_in(&root) } else { Vec::new() };
    let [folder] = &folders[..] else { return Vec::new() };
    let folder = root.join(folder);
    files_in(&folder)
        .into_iter()
        .filter(|name| name.splitn(3, '-').nth(2).is_some_and(|name| name.starts_with(part)))
        .map(|name| folder.join(name))
        .collect()
}

fn size(files: &[PathBuf]) -> f64 {
    files.iter().map(|file| file.metadata().unwrap().len() as f64).sum()
}

/// Stress of all speeds of a sweep.
async fn stress(api: &Api, id: &str) -> Vec<Value> {
    let points = points(api, id).await;
    points.values().map(|point| point["stress"].clone()).collect()
}

#[tokio::test]
async fn a_basis_may_be_left_out_and_asked_for_later() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(impeller()).await;
    let plan = async |request: &Value| {
        let plan = api.post("/v1/modal-analyses/plan", request).await;
        assert_eq!(plan.status, 200, "{}", plan.body);
        plan.body
    };
    assert!(plan(&analysis(&model, None)).await["basis_bytes_at_most"].as_u64() > Some(0));
    let without = plan(&analysis(&model, Some(false))).await;
    assert_eq!(
        (&without["basis_bytes_at_most"], &without["settings"]["fields"]),
        (&Value::Null, &json!(false))
    );

    // Results that are made of the basis cannot do without it.
    let mut asked = recording(&model);
    asked["fields"] = false.into();
    let states = asked["record"]["histories"].clone();
    for record in [json!({"stress": {}}), json!({"histories": states})] {
        asked["record"] = record;
        let pointers = api.post("/v1/sweeps", &asked).await.pointers(422, "invalid-request");
        assert_eq!(pointers, ["/fields"]);
    }
    asked.as_object_mut().unwrap().remove("speeds");
    asked["speed"] = json!({"value": 1200.0, "unit": "rad_s"});
    asked["record"] = json!({"quantities": ["state"]});
    let pointers = api.post("/v1/case-studies", &asked).await.pointers(422, "invalid-request");
    assert_eq!(pointers, ["/fields"]);

    finished(api, "/v1/modal-analyses", &analysis(&model, Some(false))).await;
    assert!(beside(app.data(), "").is_empty());
    let modes = format!("/v1/models/{model}/modes?nodal_diameter=1&format=npz");
    // Frequencies need no basis.
    assert_eq!(api.get(&format!("/v1/models/{model}/modes")).await.status, 200);
    let refused = api.get(&modes).await;
    refused.problem(409, "not-reduced");
    assert!(refused.text("/detail").contains("\"fields\": true"), "{}", refused.body);
    // A request that does not insist on the basis does not reduce for it.
    finished(api, "/v1/modal-analyses", &analysis(&model, None)).await;
    assert!(beside(app.data(), "").is_empty());
    finished(api, "/v1/modal-analyses", &analysis(&model, Some(true))).await;
    assert_eq!(beside(app.data(), "harmonic-").len(), 3);
    assert_eq!(bytes(api, &modes).await.0, StatusCode::OK);
    app.stop().await;
}

#[tokio::test]
async fn what_is_lost_or_damaged_is_made_anew() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(impeller()).await;
    let request = recording(&model);
    let plan = app.api.post("/v1/sweeps/plan", &request).await.body;
    let receipt = app.api.post("/v1/sweeps", &request).await;
    let id = receipt.text("/id");
    assert_eq!(app.api.finish(&id).await["status"], "successful");
    let job = app.api.job(&id).await.body;
    for links in [&receipt.body["links"], &job["links"]] {
        let href = |rel: &str| {
            let link = links.as_array().unwrap().iter().find(|link| link["rel"] == rel).unwrap();
            link["href"].as_str().unwrap().to_owned()
        };
        assert_eq!(
            [href("stress"), href("fields")],
            ["stress", "fields"].map(|rel| format!("/v1/jobs/{id}/{rel}"))
        );
    }
    // Written was what was planned: no direction was dropped, and nodes that never move have stress, too.
    let near = |planned: &str, files: Vec<PathBuf>| {
        let (planned, found) = (plan[planned].as_f64().unwrap(), size(&files));
        assert!((found / planned - 1.0).abs() < 0.15, "{planned} {found} {files:?}");
    };
    near("basis_bytes_at_most", beside(data.path(), "harmonic-"));
    let of_stress = beside(data.path(), "stress-1-");
    assert_eq!(of_stress.len(), 4, "three nodal diameters and the static part");
    let is_static = |file: &PathBuf| file.to_string_lossy().ends_with("static");
    near("stress_bytes", of_stress.iter().filter(|file| !is_static(file)).cloned().collect());

    let expected = stress(&app.api, &id).await;
    let fields = format!("/v1/jobs/{id}/fields?stress=true&static=include&format=npz");
    let field = bytes(&app.api, &fields).await;
    assert_eq!(field.0, StatusCode::OK);
    app.stop().await;
    let whole: Vec<(PathBuf, Vec<u8>)> = beside(data.path(), "")
        .into_iter()
        .map(|file| (file.clone(), std::fs::read(file).unwrap()))
        .collect();
    assert_eq!(whole.len(), 7);

    // Each file is damaged in all of its rows, cut short, or gone; under a service that has read it, and before it starts.
    for (turn, (file, written)) in whole.iter().enumerate() {
        let mut spoilt = written.clone();
        // A row of stress that nobody follows is not read.
        spoilt.iter_mut().skip(88).step_by(64).for_each(|byte| *byte ^= 1);
        std::fs::write(file, &spoilt).unwrap();
        if turn % 3 == 1 {
            std::fs::write(file, &written[..written.len() / 2]).unwrap();
        } else if turn % 3 == 2 {
            std::fs::remove_file(file).unwrap();
        }
        let app = TestApp::start_on(data.path()).await;
        let api = &app.api;
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        if name.contains("-harmonic-") {
            let refused = api.get(&fields).await;
            refused.problem(409, "not-reduced");
            finished(api, "/v1/modal-analyses", &analysis(&model, Some(true))).await;
            assert_eq!(&std::fs::read(file).unwrap(), written, "{name}");
        }
        assert_eq!(bytes(api, &fields).await, field, "{name}");
        let again = finished(api, "/v1/sweeps", &request).await;
        assert_eq!(stress(api, &again).await, expected, "{name}");
        assert_eq!(&std::fs::read(file).unwrap(), written, "{name}");
        if name.contains("-harmonic-") {
            // Once more it is damaged while a service has the reduction in memory and knows of its basis.
            std::fs::write(file, &spoilt).unwrap();
            api.get(&fields).await.problem(409, "not-reduced");
            finished(api, "/v1/modal-analyses", &analysis(&model, Some(true))).await;
            assert_eq!(bytes(api, &fields).await, field, "{name}");
        }
        app.stop().await;
    }

    // All files go, under a sweep with stress.
    std::fs::remove_dir_all(data.path().join("bases")).unwrap();
    let app = TestApp::start_on(data.path()).await;
    let again = finished(&app.api, "/v1/sweeps", &request).await;
    assert_eq!(stress(&app.api, &again).await, expected);
    assert_eq!(bytes(&app.api, &fields).await, field);
    for job in [&id, &again] {
        app.api.delete(&format!("/v1/jobs/{job}")).await;
    }
    assert_eq!(app.api.delete(&format!("/v1/models/{model}")).await.status, 204);
    assert_eq!(files_in(&data.path().join("bases")), [""; 0]);
    app.stop().await;
}

#[tokio::test]
async fn states_are_kept_by_archives_and_backups_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let (data, copy) = (folder.path().join("data"), folder.path().join("copy"));
    let app = TestApp::start_on(&data).await;
    let model = app.api.model(impeller()).await;
    let id = finished(&app.api, "/v1/sweeps", &recording(&model)).await;
    let fields = format!("/v1/jobs/{id}/fields?stress=true&format=npz");
    let field = bytes(&app.api, &fields).await;
    assert_eq!(field.0, StatusCode::OK);
    let (identical, words) = repeat(folder.path(), &download(&app.api, &id).await);
    assert!(identical && words.contains("identical: all "), "{words}");
    let backup = rubmap(&["backup", "--to", copy.to_str().unwrap()], &data);
    assert!(backup.status.success(), "{}", said(&backup));
    app.stop().await;

    let app = TestApp::start_on(&copy).await;
    app.api.get(&fields).await.problem(409, "not-reduced");
    finished(&app.api, "/v1/modal-analyses", &analysis(&model, Some(true))).await;
    assert_eq!(bytes(&app.api, &fields).await, field);
    app.stop().await;

    let checked = rubmap(&["check"], &copy);
    assert!(checked.status.success(), "{}", said(&checked));
    let options = sqlx::sqlite::SqliteConnectOptions::new().filename(copy.join("rubmap.sqlite"));
    let mut database = options.connect().await.unwrap();
    // A stored number is changed.
    sqlx::query("update documents set body = replace(body, '\"coordinates\":\"', '\"coordinates\":\"AAAA') where name = 'states'")
        .execute(&mut database)
        .await
        .unwrap();
    database.close().await.unwrap();
    let checked = rubmap(&["check"], &copy);
    assert!(!checked.status.success());
    let words = said(&checked);
    assert!(words.contains(&id) && words.contains("states 1: the recorded state is damaged"), "{words}");
    let app = TestApp::start_on(&copy).await;
    app.api.get(&fields).await.problem(500, "internal-error");
    app.stop().await;
}

/// Stress waits for room on the disk, which has room for the database, and none for a basis.
#[tokio::test]
async fn stress_waits_for_room_on_the_disk() {
    let Some(disk) = SmallDisk::mount(64) else { return };
    let program = Program::serve(&disk.data());
    let api = &program.api;
    let model = api.model(impeller()).await;
    disk.fill_but(10);
    // A basis that nobody insists on is left out.
    let mut usual = analysis(&model, None);
    usual["modes_per_speed"] = 2.into();
    finished(api, "/v1/modal-analyses", &usual).await;
    let id = api.sweep(&recording(&model)).await;
    api.follow(&id, |job| job["phase"].as_str().is_some_and(|phase| phase.contains("room on the disk")))
        .await;
    assert!(beside(&disk.data(), "").is_empty());
    disk.make_room();
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    assert!(stress(api, &id).await.iter().all(|stress| stress["largest"]["von_mises"].as_f64() > Some(0.0)));
    assert_eq!(bytes(api, &format!("/v1/jobs/{id}/fields?format=npz")).await.0, StatusCode::OK);
    program.terminate();
}

/// Kills the service as soon as each of the files is there, and starts it again.
#[tokio::test]
async fn kills_leave_no_half_file_that_is_read() {
    let undisturbed = tempfile::tempdir().unwrap();
    let program = Program::serve(undisturbed.path());
    let model = program.api.model(impeller()).await;
    let id = finished(&program.api, "/v1/sweeps", &recording(&model)).await;
    let expected = stress(&program.api, &id).await;
    program.terminate();

    let data = tempfile::tempdir().unwrap();
    let mut program = Program::serve(data.path());
    program.api.model(impeller()).await;
    let id = program.api.sweep(&recording(&model)).await;
    for (part, files) in [("harmonic-", 1), ("harmonic-", 3), ("stress-1-", 1), ("stress-1-", 4)] {
        while beside(data.path(), part).len() < files {
            tokio::time::sleep(std::time::Duration::from_millis(1)).await;
        }
        program.kill();
        program = Program::run(Command::new(env!("CARGO_BIN_EXE_rubmap")), data.path());
    }
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    assert_eq!(stress(&program.api, &id).await, expected);
    for part in ["harmonic-", "stress-1-"] {
        let names = beside(data.path(), part).into_iter().zip(beside(undisturbed.path(), part));
        for (found, expected) in names {
            assert_eq!(
                std::fs::read(&found).unwrap(),
                std::fs::read(expected).unwrap(),
                "{}",
                found.display()
            );
        }
    }
    program.terminate();
}
