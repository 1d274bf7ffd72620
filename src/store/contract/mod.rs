//! Contract of the store, tested on every database that the program was built for.

pub(super) mod alone;
mod together;

use std::sync::Arc;

use serde_json::json;

use super::Store;
use super::jobs::{Begun, Insertion, JobId, NewJob, kept};
use super::labels::Labels;
use super::limits::Limits;
use super::results::PackedSpeed;
use crate::analysis::end_state::EndState;
use crate::analysis::kinds::kind::ResolvedJob;
use crate::analysis::kinds::sweep::SWEEP;
use crate::analysis::request::{Component, Sensor};
use crate::analysis::result::{ContactForces, Point, SensorSpectrum, SpeedResult, SpeedSpectra, WearMap};
use crate::analysis::run::ModelFacts;
use crate::kinds::JobKind;

/// Id of a model, made of one letter.
pub(super) fn model_id(letter: char) -> String {
    letter.to_string().repeat(64)
}

fn facts(name: &str) -> ModelFacts {
    let facts = json!({
        "name": name, "sectors": 10, "contact_nodes": 3, "own_dofs": 100, "speeds_rad_s": [0.0],
        "units": {"length": "m", "force": "N", "time": "s", "mass": "kg"}, "gyroscopic": false,
    });
    serde_json::from_value(facts).unwrap()
}

pub(super) fn labels(name: &str, tags: &[&str]) -> Labels {
    let tags = tags.iter().map(|&tag| tag.to_owned()).collect();
    Labels { name: Some(name.to_owned()), tags, notes: None }
}

/// Uploads a model for `owner`. Returns whether it is new to the owner.
pub(super) async fn upload(store: &Store, owner: &str, letter: char, labels: &Labels) -> bool {
    let upload = store.new_upload().await.unwrap().into_temp_path();
    std::fs::write(&upload, "package").unwrap();
    let facts = facts(&format!("Package {letter}"));
    let whose = (owner, Limits::default());
    store.insert_model(whose, &model_id(letter), &facts, labels, &upload).await.unwrap().unwrap().1
}

fn sweep(letter: char, speeds: u32) -> Arc<dyn ResolvedJob> {
    sweep_on(letter, speeds, false)
}

/// Sweep over the model of this letter, on one kind of processor or on any.
pub(super) fn sweep_on(letter: char, speeds: u32, one_kind: bool) -> Arc<dyn ResolvedJob> {
    let values: Vec<u32> = (1..=speeds).collect();
    let request = json!({
        "model": model_id(letter), "modes_per_speed": 20, "scene": {},
        "speeds": {"values": values, "unit": "hz"}, "reproducible": one_kind,
    });
    let text = json!({"schema": 1, "rounds": 0, "request": request});
    kept::read(JobKind(&SWEEP), &text.to_string()).unwrap()
}

/// Queues a sweep over the model of this letter.
pub(super) async fn queue(store: &Store, owner: &str, letter: char, speeds: u32, labels: &Labels) -> JobId {
    queue_request(store, owner, &*sweep(letter, speeds), labels).await
}

pub(super) async fn queue_request(
    store: &Store,
    owner: &str,
    request: &dyn ResolvedJob,
    labels: &Labels,
) -> JobId {
    let id = JobId::new();
    let facts = facts("m");
    let new = NewJob { id, owner, request, posted: None, labels, facts: Some(&facts) };
    let inserted = store.insert_job(new, Limits::default(), None).await.unwrap();
    assert_eq!(inserted, Insertion::Accepted);
    id
}

fn point(index: u32, status: &str) -> Point {
    let point = json!({
        "index": index, "speed_rad_s": 1.0, "status": status, "steps_per_revolution": 1,
        "smallest_stable_steps_per_revolution": 1, "steps": 1, "contact_share": 0.0, "responses": [],
        "wall_time_s": 0.1, "version": "0",
    });
    serde_json::from_value(point).unwrap()
}

/// Result of a finished speed with everything that a speed may have.
pub(super) fn result(index: u32) -> SpeedResult {
    let spectrum = SensorSpectrum {
        sensor: Sensor::at_contact(0, 1, Component::Radial),
        amplitude: vec![0.1 + 0.2, -0.0],
        nodal_diameters: vec![vec![f64::from(index), 1e-300]],
    };
    SpeedResult {
        point: point(index, "completed"),
        spectra: Some(SpeedSpectra { engine_orders: vec![0.0, 0.5], sensors: vec![spectrum] }),
        wear: Some(WearMap { depths: vec![vec![0.0, 1.5]] }),
        contact: Some(ContactForces { peak_force: vec![vec![2.5]], ..ContactForces::default() }),
        end_state: Some(EndState(vec![f64::from(index)])),
    }
}

/// Starts a job on one kind of processor. Returns whether the job wants work.
pub(super) async fn begin(store: &Store, job: JobId) -> bool {
    store.begin_job(job, "V3").await.unwrap() == Begun::Yes
}

/// Stores a finished speed. Returns the number of finished speeds.
pub(super) async fn keep(store: &Store, job: JobId, result: &SpeedResult) -> Option<u32> {
    store.insert_speed(job, &PackedSpeed::of(result).unwrap()).await.unwrap()
}
