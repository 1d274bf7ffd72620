//! Kills of the real program in the middle of its work.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;
use std::time::Duration;

use rubmap::app::{App, StartError};
use rubmap::impeller::{ImpellerParameters, generate};
use rubmap::package;
use rubmap::store::Store;
use serde_json::{Value, json};

use super::app::{Api, config, long_sweep_of, modal_analysis_of};
use super::chains::{finished, first_of};
use super::model::{self, files_in};
use super::program::Program;

/// Points by index; each carries its wall time, which no second computation would repeat.
pub(crate) async fn points(api: &Api, id: &str) -> BTreeMap<u64, Value> {
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let points = map["points"].as_array().unwrap();
    points.iter().map(|point| (point["index"].as_u64().unwrap(), point.clone())).collect()
}

#[tokio::test]
async fn a_killed_service_resumes_without_computing_anything_again() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let id = program.api.sweep(&long_sweep_of(&model, 16)).await;
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(3)).await;
    let before = points(&program.api, &id).await;
    program.kill();
    assert!((3..16).contains(&before.len()), "{} speeds were finished", before.len());

    let program = Program::serve(data.path());
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let after = points(&program.api, &id).await;
    assert_eq!(after.len(), 16, "no speed is lost");
    for (index, point) in &before {
        assert_eq!(&after[index], point, "speed {index} was computed again");
    }
    assert_eq!(program.api.get(&format!("/v1/jobs/{id}/critical-speeds")).await.status, 200);
}

#[tokio::test]
async fn a_killed_chain_goes_on_where_it_was() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut request = long_sweep_of(&model, 12);
    request["sweep"] = "down".into();
    let down: Vec<u64> = (0..12).rev().collect();
    let id = program.api.sweep(&request).await;
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(3)).await;
    let before = points(&program.api, &id).await;
    program.kill();
    assert!((3..12).contains(&before.len()), "{} speeds were finished", before.len());
    assert_eq!(before.keys().copied().collect::<Vec<_>>(), first_of(&down, before.len()));

    let program = Program::serve(data.path());
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() > Some(before.len() as u64)).await;
    let more = finished(&program.api, &id).await;
    assert_eq!(more, first_of(&down, more.len()), "goes on in order");
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let after = points(&program.api, &id).await;
    assert_eq!(after.len(), 12, "no speed is lost");
    for (index, point) in &before {
        assert_eq!(&after[index], point, "speed {index} was computed again");
    }
    program.kill();

    // The results are the same as undisturbed, but for the times.
    let undisturbed = tempfile::tempdir().unwrap();
    let program = Program::serve(undisturbed.path());
    assert_eq!(program.api.model(model::package(1.0)).await, model);
    let id = program.api.sweep(&request).await;
    program.api.finish(&id).await;
    let timeless = |points: BTreeMap<u64, Value>| -> Vec<Value> {
        let clear = |mut point: Value| {
            point["wall_time_s"] = Value::Null;
            point
        };
        points.into_values().map(clear).collect()
    };
    assert_eq!(timeless(points(&program.api, &id).await), timeless(after));
}

/// Modes per speed of the reductions below: so many that one can be caught in the middle.
const MODES: u32 = 40;

/// Request for a modal analysis that needs a reduction of some seconds.
fn analysis_of(model: &str) -> Value {
    let mut request = modal_analysis_of(model);
    request["modes_per_speed"] = MODES.into();
    request
}

/// Reads the stored reduction, to the bit, without the time it took.
async fn reduction(data: &Path, model: &str) -> Vec<u8> {
    let store = Store::open(data).await.unwrap();
    let reduced = store.reduction(model, MODES).await.unwrap().unwrap();
    store.close().await;
    postcard::to_stdvec(&reduced.wheel).unwrap()
}

#[tokio::test]
async fn a_killed_reduction_continues_from_its_checkpoints() {
    let mut zip = Cursor::new(Vec::new());
    package::write(&generate(&ImpellerParameters::default()).unwrap(), &mut zip).unwrap();
    let zip = zip.into_inner();

    let undisturbed = tempfile::tempdir().unwrap();
    let program = Program::serve(undisturbed.path());
    let model = program.api.model(zip.clone()).await;
    let id = program.api.post("/v1/modal-analyses", &analysis_of(&model)).await.text("/id");
    assert_eq!(program.api.finish(&id).await["status"], "successful");
    program.kill();

    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    assert_eq!(program.api.model(zip).await, model);
    let id = program.api.post("/v1/modal-analyses", &analysis_of(&model)).await.text("/id");
    let folder = data.path().join("checkpoints").join(format!("{model}-{MODES}"));
    let finished_parts = || {
        let names = if folder.exists() { files_in(&folder) } else { Vec::new() };
        names.into_iter().filter(|name| !name.starts_with("unfinished-")).collect::<Vec<_>>()
    };
    // Everything at rest is done then; what comes later is done in groups, whole or not at all.
    let mut looks = 0;
    while !finished_parts().iter().any(|name| name.ends_with("-speed-0")) {
        looks += 1;
        // It looks seldom: an answer may take longer than what is left of the reduction.
        if looks % 500 == 0 {
            let status = program.api.job(&id).await.text("/status");
            assert!(
                ["accepted", "running"].contains(&status.as_str()),
                "{status} before its first checkpoint"
            );
        }
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    program.kill();
    let before: Vec<String> = finished_parts().into_iter().filter(|name| name.contains("-speed-0")).collect();
    assert!(before.len() > 1, "the reduction was finished before it could be killed");

    let program = Program::serve(data.path());
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    for file in &before {
        // The name is <version>-<layout>-<part>.
        let part = file.splitn(3, '-').nth(2).unwrap();
        assert!(program.said("continuing from a checkpoint", part), "{part} was not used");
        assert!(!program.said("kept a checkpoint", part), "{part} was computed again");
    }
    assert!(!folder.exists(), "checkpoints are of no use any more");
    program.kill();
    assert_eq!(reduction(data.path(), &model).await, reduction(undisturbed.path(), &model).await);
}

#[tokio::test]
async fn a_killed_generation_is_done_again() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let id = program.api.post("/v1/models", &json!({})).await.text("/id");
    program.api.follow(&id, |job| job["status"] == "running").await;
    program.kill();

    let program = Program::serve(data.path());
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let model = job["model"].as_str().unwrap();
    assert_eq!(program.api.get(&format!("/v1/models/{model}")).await.status, 200);
    assert_eq!(files_in(&data.path().join("models")), [format!("{model}.zip")]);
}

#[tokio::test]
async fn a_data_folder_has_one_service() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let refused = App::build(config(data.path())).await.unwrap_err();
    assert!(matches!(refused, StartError::InUse(_)), "{refused}");
    assert!(refused.to_string().contains("in use by another rubmap"));
    // A killed process leaves no lock behind.
    program.kill();
    drop(App::build(config(data.path())).await.unwrap());
}

#[tokio::test]
async fn sigterm_ends_the_service_and_not_its_jobs() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let id = program.api.sweep(&long_sweep_of(&model, 100)).await;
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    program.terminate();

    let program = Program::serve(data.path());
    assert_eq!(program.api.job(&id).await.text("/status"), "running");
}
