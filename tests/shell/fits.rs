//! `rubmap fit`, as a user has it: cut and called again, and with targets that no wheel has.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

/// Fit of two parameters of a coarse wheel.
fn request(frequencies: [f64; 3]) -> Value {
    let target = |(family, frequency): (usize, f64)| json!({"nodal_diameter": 1, "family": family, "speed": 12_000.0, "frequency": frequency});
    let targets: Vec<Value> = (1..).zip(frequencies).map(target).collect();
    let mesh = json!({"between_contact_nodes": 1, "blade_height": 2, "blade_thickness": 1, "half_passage": 1, "disk": 1});
    json!({
        "wheel": {"sectors": 6, "contact_nodes": 4, "mesh": mesh},
        "vary": {"rim_thickness": [5.0, 9.0], "root_thickness": [1.2, 2.4]},
        "unit": "hz_and_rpm",
        "targets": targets,
        "starts": 2,
        "candidates": 3,
        "iterations": 6,
    })
}

fn command(folder: &Path, request: &Value, out: &str, workers: &str) -> Command {
    let file = folder.join("request.json");
    std::fs::write(&file, request.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.arg("fit").arg(&file).arg("--out").arg(folder.join(out)).args(["--workers", workers]);
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Files of a fit that ended.
fn files(folder: &Path, out: &str) -> [String; 2] {
    ["parameters.json", "fit.json"].map(|name| std::fs::read_to_string(folder.join(out).join(name)).unwrap())
}

#[test]
fn a_fit_that_was_cut_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let request = request([2800.0, 4000.0, 5000.0]);
    let whole: Output = command(folder, &request, "whole", "2").output().unwrap();
    assert!(folder.join("whole/fit.json").exists(), "{}", text(&whole.stderr));

    // A kill leaves the lines that were written, and perhaps a part of one.
    let state = std::fs::read(folder.join("whole/evaluations.jsonl")).unwrap();
    std::fs::create_dir(folder.join("cut")).unwrap();
    std::fs::write(folder.join("cut/evaluations.jsonl"), &state[..state.len() / 2]).unwrap();

    let again = command(folder, &request, "cut", "1").output().unwrap();
    assert!(text(&again.stderr).contains("evaluations were there already"), "{}", text(&again.stderr));
    assert_eq!(std::fs::read(folder.join("cut/evaluations.jsonl")).unwrap().len(), state.len());
    assert_eq!((again.status.code(), files(folder, "cut")), (whole.status.code(), files(folder, "whole")));
}

#[test]
fn targets_that_are_missed_end_with_code_1_and_their_rows() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Three times the frequency of any wheel within the bounds.
    let missed = request([2800.0, 4000.0, 15_000.0]);
    let ended = command(folder, &missed, "out", "2").output().unwrap();
    assert_eq!(ended.status.code(), Some(1), "{}", text(&ended.stderr));
    let table = text(&ended.stdout);
    assert!(table.contains("missed by more than 2 %") && table.contains("targets are not met"), "{table}");

    // Its state is not that of another fit.
    let other = command(folder, &request([2900.0, 4000.0, 5000.0]), "out", "2").output().unwrap();
    assert_eq!(other.status.code(), Some(1));
    assert!(text(&other.stderr).contains("of another fit"), "{}", text(&other.stderr));
}
