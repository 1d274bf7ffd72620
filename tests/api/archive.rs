//! Archives of jobs, and the program that computes such a job again.

use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use super::app::{Api, TestApp, long_sweep_of, modal_analysis_of, sweep_of};
use super::branches::branches_of;
use super::campaigns::campaign_of;
use super::case_studies::case_of;
use super::generation::coarse;
use super::model;
use super::run_ups::run_ups_of;
use super::studies::study_of;

type Entries = Vec<(String, Vec<u8>)>;

pub(crate) async fn download(api: &Api, id: &str) -> Vec<u8> {
    let response = api.request("GET", &format!("/v1/jobs/{id}/archive")).send().await.unwrap();
    assert_eq!(response.status(), 200);
    assert_eq!(response.headers()["content-type"], "application/zip");
    let disposition = response.headers()["content-disposition"].to_str().unwrap();
    assert_eq!(disposition, format!("attachment; filename=\"rubmap-{id}.zip\""));
    response.bytes().await.unwrap().to_vec()
}

/// Entries that another program finds in a zip.
fn entries(zip: &[u8]) -> Entries {
    let mut zip = ZipArchive::new(Cursor::new(zip)).unwrap();
    (0..zip.len())
        .map(|index| {
            let mut entry = zip.by_index(index).unwrap();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            (entry.name().unwrap().to_string(), bytes)
        })
        .collect()
}

fn zipped(entries: &Entries) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        zip.start_file(name.as_str(), SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn hex(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

fn json_of(entries: &Entries, name: &str) -> Value {
    let (_, bytes) = entries.iter().find(|(entry, _)| entry == name).unwrap_or_else(|| panic!("{name}"));
    serde_json::from_slice(bytes).unwrap()
}

/// Archive with an entry changed, and its manifest to fit.
fn changed(mut entries: Entries, name: &str, change: impl FnOnce(&mut Value)) -> Entries {
    let mut value = json_of(&entries, name);
    change(&mut value);
    let bytes = serde_json::to_vec(&value).unwrap();
    let mut manifest = json_of(&entries, "manifest.json");
    if name != "manifest.json" {
        let listed = manifest["entries"].as_array_mut().unwrap();
        let listed = listed.iter_mut().find(|entry| entry["name"] == name).unwrap();
        (listed["bytes"], listed["sha256"]) = (bytes.len().into(), hex(&bytes).into());
    } else {
        manifest = value;
    }
    for (entry, content) in &mut entries {
        if entry == name {
            content.clone_from(&bytes);
        }
        if entry == "manifest.json" {
            *content = serde_json::to_vec(&manifest).unwrap();
        }
    }
    entries
}

/// Runs `rubmap repeat` on an archive; returns whether it found all the same, and its output.
pub(crate) fn repeat(folder: &Path, archive: &[u8]) -> (bool, String) {
    let path = folder.join("archive.zip");
    std::fs::write(&path, archive).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    let output = command.arg("repeat").arg(&path).args(["--workers", "2"]).output().unwrap();
    let words = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8(words).unwrap())
}

#[tokio::test]
async fn an_archive_has_what_was_asked_and_found_and_says_so() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let api = &app.api;
    let package = model::package(1.0);
    let model = api.model(package.clone()).await;
    let id = api.sweep(&sweep_of(&model)).await;
    let job = api.finish(&id).await;
    let archive = download(api, &id).await;
    let found = entries(&archive);

    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    let speed = |index| ["spectra", "contact"].map(|what| format!("results/{what}/0000{index}.json"));
    let speeds: Vec<String> = (0..6).flat_map(speed).collect();
    let mut expected = vec!["request.json", "settings.json", "package.zip", "results/points.json"];
    expected.extend(speeds.iter().map(String::as_str));
    expected.extend(["results/critical-speeds/0.json", "results/critical-speeds/1.json"]);
    expected.extend(["results/wheel-critical-speeds/0.json", "manifest.json"]);
    assert_eq!(names, expected);
    assert_eq!(found[2].1, package, "byte by byte");

    // The service gives the same one by one.
    assert_eq!(json_of(&found, "settings.json"), job["request"]);
    let spectra = api.get(&format!("/v1/jobs/{id}/spectra/3")).await.body;
    assert_eq!(json_of(&found, "results/spectra/00003.json"), spectra["spectra"]);
    assert_eq!(json_of(&found, "results/points.json")[3], spectra["point"]);
    let table = api.get(&format!("/v1/jobs/{id}/critical-speeds?sensor=1")).await.body;
    assert_eq!(json_of(&found, "results/critical-speeds/1.json"), table);

    let manifest = json_of(&found, "manifest.json");
    let digests: BTreeMap<String, (Value, Value)> = manifest["entries"]
        .as_array()
        .unwrap()
        .iter()
        .map(|entry| {
            (entry["name"].as_str().unwrap().to_owned(), (entry["bytes"].clone(), entry["sha256"].clone()))
        })
        .collect();
    assert_eq!(digests.len(), found.len() - 1);
    for (name, bytes) in found.iter().filter(|(name, _)| name != "manifest.json") {
        assert_eq!(digests[name], (bytes.len().into(), hex(bytes).into()), "{name}");
    }
    assert_eq!((&manifest["job"]["id"], &manifest["job"]["model"]), (&json!(id), &json!(model)));
    assert_eq!(manifest["computed"]["vectors"], rubmap::analysis::run::vectors());
    assert_eq!(manifest["computed"]["revision"], rubmap::analysis::run::REVISION);

    // The archive has the same bytes when it is made again, and by the next service.
    assert_eq!(download(api, &id).await, archive);
    let asked = api.request("GET", &format!("/v1/jobs/{id}/archive")).header("accept-encoding", "gzip");
    assert!(
        !asked.send().await.unwrap().headers().contains_key("content-encoding"),
        "it is compressed already"
    );
    app.stop().await;
    let app = TestApp::start_on(data.path()).await;
    assert_eq!(download(&app.api, &id).await, archive);
    app.stop().await;
}

#[tokio::test]
async fn jobs_without_their_end_or_their_model_have_no_archive() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let archive = async |id: &str| api.get(&format!("/v1/jobs/{id}/archive")).await;
    let finished = api.sweep(&sweep_of(&model)).await;
    api.finish(&finished).await;
    let long = api.sweep(&long_sweep_of(&model, 100)).await;
    archive(&long).await.problem(409, "result-not-ready");
    api.delete(&format!("/v1/jobs/{long}")).await;
    archive(&long).await.problem(409, "result-unavailable");
    assert_eq!(api.delete(&format!("/v1/models/{model}")).await.status, 204);
    let gone = archive(&finished).await;
    gone.problem(409, "result-unavailable");
    assert!(gone.text("/detail").contains("model is deleted"), "{}", gone.body);
    archive("0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10").await.problem(404, "job-not-found");
    app.stop().await;
}

/// Archives made while others compute, with rounds of a refinement, wear, and settings of every kind of job, repeat to the bit.
#[tokio::test]
async fn every_kind_of_job_repeats_to_the_bit() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut refined = sweep_of(&model);
    (refined["speeds"]["count"], refined["refine"], refined["control_speeds"]) =
        (9.into(), true.into(), 2.into());
    refined["name"] = "not computed".into();
    let mut coated = sweep_of(&model);
    coated["scene"]["abradable"] = json!({"modulus": 2e4, "yield_stress": 20.0, "hardening": 500.0, "thickness": 2.0, "rods_around": 16});
    let (mut branches, mut run_ups) = (branches_of(&model), run_ups_of(&model));
    (branches["most_points"], branches["doubled"]) = (2.into(), false.into());
    (run_ups["speed"]["to"], run_ups["speed"]["hold_s"]) = (400.into(), 0.into());
    let mut compared = campaign_of(&model);
    compared["compared_model"] = api.model(model::package(1.1)).await.into();
    let mut alone = campaign_of(&model);
    alone["compared_model"] = serde_json::Value::Null;
    let mut chosen = modal_analysis_of(&model);
    chosen.as_object_mut().unwrap().remove("modes_per_speed");
    chosen["budget"] = json!({"seconds": 60.0});
    let asked = [
        ("/v1/modal-analyses", chosen),
        ("/v1/campaigns", alone),
        ("/v1/sweeps", refined),
        ("/v1/sweeps", coated),
        ("/v1/modal-analyses", modal_analysis_of(&model)),
        ("/v1/studies", study_of(&model)),
        ("/v1/case-studies", case_of(&model)),
        ("/v1/branches", branches),
        ("/v1/run-ups", run_ups),
        ("/v1/campaigns", compared),
        ("/v1/models", coarse()),
    ];
    for kind in rubmap::kinds::all() {
        assert!(asked.iter().any(|(path, _)| *path == kind.route), "{} is not repeated here", kind.name);
    }
    let mut ids = Vec::new();
    for (path, request) in &asked {
        let answer = api.post(path, request).await;
        assert_eq!(answer.status, 202, "{}", answer.body);
        ids.push(answer.text("/id"));
    }
    let folder = tempfile::tempdir().unwrap();
    for (id, (path, _)) in ids.iter().zip(&asked) {
        let job = api.finish(id).await;
        assert_eq!(job["status"], "successful", "{job}");
        let archive = download(api, id).await;
        let (identical, words) = repeat(folder.path(), &archive);
        assert!(identical && words.contains("identical: all "), "{path}: {words}");
        // What was posted starts the same job again, and its plan is that of the job.
        assert_eq!(job["posted_to"], *path);
        let plan = api.post(&format!("{path}/plan"), &job["posted"]).await;
        assert_eq!(plan.status, 200, "{path}: {}", plan.body);
    }
    let found = entries(&download(api, &ids[0]).await);
    let modes = &json_of(&found, "request.json")["modes_per_speed"];
    assert_eq!(
        modes,
        &json_of(&found, "choice.json")["modes_per_speed"],
        "what was chosen is not chosen again"
    );
    let found = entries(&download(api, &ids[2]).await);
    assert!(json_of(&found, "settings.json")["speeds"].as_array().unwrap().len() > 1, "speeds were added");
    assert!(json_of(&found, "request.json")["speeds"].as_array().unwrap().len() == 1, "and are added again");
    let coated = entries(&download(api, &ids[3]).await);
    assert!(coated.iter().any(|(name, _)| name == "results/wear/00000.json"));
    app.stop().await;
}

#[tokio::test]
async fn what_was_changed_or_is_no_archive_is_said() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    api.finish(&id).await;
    let archive = download(api, &id).await;
    let found = entries(&archive);
    app.stop().await;
    let folder = tempfile::tempdir().unwrap();
    let refused = |archive: &[u8], words: &[&str]| {
        let (identical, said) = repeat(folder.path(), archive);
        assert!(!identical, "{said}");
        for words in words {
            assert!(said.contains(words), "{words}: {said}");
        }
    };

    // Changed are a bit of the stored bytes of a result, and a byte of a result that was zipped anew.
    let name = "results/campbell/0.json";
    let start =
        archive.windows(name.len()).position(|window| window == name.as_bytes()).unwrap() + name.len();
    for place in [start + 40, start + 400] {
        let mut flipped = archive.clone();
        flipped[place] ^= 4;
        refused(&flipped, &["is not as it was written", name]);
    }
    let mut swapped = found.clone();
    swapped[3].1[100] ^= 1;
    assert_eq!(swapped[3].0, name);
    refused(&zipped(&swapped), &["is not as it was written", name, "SHA-256"]);
    let mut more = found.clone();
    more.push(("results/more.json".to_owned(), b"1".to_vec()));
    refused(&zipped(&more), &["\"results/more.json\" is not in manifest.json"]);
    let fewer = found.iter().filter(|(entry, _)| entry != name).cloned().collect();
    refused(&zipped(&fewer), &[name, "cannot be read"]);

    // The manifest fits: only computing the result again shows the change.
    let forged = changed(found.clone(), name, |campbell| {
        let frequency = &mut campbell["frequencies_hz"][1][0][0];
        *frequency = f64::from_bits(frequency.as_f64().unwrap().to_bits() + 1).into();
    });
    refused(
        &zipped(&forged),
        &["different: 1 of 2 results", "/frequencies_hz/1/0/0 was", "this should not be"],
    );
    let elsewhere = |field: &'static str, value: Value| {
        changed(forged.clone(), "manifest.json", move |manifest| manifest["computed"][field] = value)
    };
    refused(&zipped(&elsewhere("vectors", "V9".into())), &["different", "vectors of V9"]);
    refused(&zipped(&elsewhere("revision", 1_000_000.into())), &["different", "revision 1000000"]);
    let other_model = changed(found.clone(), "request.json", |request| request["model"] = "m".into());
    refused(&zipped(&other_model), &["another model than its package"]);

    refused(&archive[..archive.len() / 2], &["is not whole"]);
    refused(b"nothing", &["no zip archive"]);
    refused(&model::package(1.0), &["no archive of a job", "there is no manifest.json"]);
    let later = changed(found.clone(), "manifest.json", |manifest| manifest["format"] = 2.into());
    refused(&zipped(&later), &["archive of form 2"]);
    let empty = changed(found.clone(), "manifest.json", |manifest| *manifest = json!({}));
    refused(&zipped(&empty), &["manifest.json", "missing field `format`"]);

    // Bombs have more than the manifest says, or a manifest that says too much.
    let mut bomb = found.clone();
    bomb[3].1 = vec![b'0'; 200 << 20];
    refused(&zipped(&bomb), &[name, "is longer than"]);
    let vast =
        changed(found, "manifest.json", |manifest| manifest["entries"][3]["bytes"] = (1u64 << 50).into());
    refused(&zipped(&vast), &["would expand to"]);
}
