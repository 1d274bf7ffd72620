//! The commands that show something, at the smallest size that is still real: the binary itself, from package to drawings.

use std::path::Path;
use std::process::{Command, Output};

use rubmap::analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use rubmap::analysis::run::{Histories, WorkPrecision};
use serde::de::DeserializeOwned;

fn demo(out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.args(["demo", "--speeds", "4", "--revolutions", "5", "--workers", "2", "--out"]).arg(out);
    quiet_success(command)
}

fn study(request: &Path, out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.args(["study", "--workers", "2", "--request"]).arg(request).arg("--out").arg(out);
    command
}

fn quiet_success(mut command: Command) -> Output {
    let output = command.output().unwrap();
    let (stdout, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{stdout}{stderr}");
    assert!(!stderr.contains("WARN") && !stderr.contains("ERROR"), "{stderr}");
    output
}

fn is_svg(path: &Path) -> bool {
    let text = std::fs::read_to_string(path).unwrap();
    roxmltree::Document::parse(&text).unwrap().root_element().tag_name().name() == "svg"
}

fn read<T: DeserializeOwned>(path: &Path) -> T {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

#[test]
fn demo_leaves_results_and_drawings_and_runs_again() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("made/by the demo");
    let first = demo(&out);

    let map: InteractionMap = read(&out.join("interaction-map.json"));
    assert_eq!(map.amplitude.len(), 4);
    assert!(map.amplitude.iter().all(Option::is_some));
    assert!(map.points.iter().all(|point| point.contact_share > 0.0), "the demo shows contact");
    let critical: CriticalSpeeds = read(&out.join("critical-speeds.json"));
    assert!(!critical.driven_crossings.is_empty());
    let campbell: Campbell = read(&out.join("campbell.json"));
    assert!(!campbell.crossings.is_empty());
    for drawing in ["interaction-map.svg", "interaction-map-frequency.svg", "campbell.svg"] {
        assert!(is_svg(&out.join(drawing)), "{drawing}");
    }
    assert!(rubmap::package::read(&out.join("impeller.zip"), &rubmap::package::Limits::default()).is_ok());
    let words = String::from_utf8(first.stdout).unwrap();
    assert!(words.contains("4 of 4 speeds computed") && words.contains("Critical speeds"), "{words}");

    let again = String::from_utf8(demo(&out).stdout).unwrap();
    assert!(again.contains("known from an earlier run"), "{again}");
    let repeated: InteractionMap = read(&out.join("interaction-map.json"));
    assert_eq!(repeated.amplitude, map.amplitude, "to the bit");
}

/// Two sizes, steps and schemes, with a touch of contact.
fn small_study() -> serde_json::Value {
    serde_json::json!({
        "speeds": {"values": [24_000.0], "unit": "rpm"},
        "scene": {
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
            },
            "contact": {},
        },
        "grid": {
            "modes_per_speed": [1, 2], "steps_per_revolution": [900, 1800],
            "schemes": ["exact_modal", "massless_boundary"],
        },
        "integration": {"revolutions": 5, "ramp_revolutions": 1, "window_revolutions": 2},
        "history_revolutions": 2,
    })
}

#[test]
fn a_study_leaves_tables_and_drawings() {
    let folder = tempfile::tempdir().unwrap();
    let (request, out) = (folder.path().join("request.json"), folder.path().join("made/by the study"));
    std::fs::write(&request, small_study().to_string()).unwrap();
    let words = String::from_utf8(quiet_success(study(&request, &out)).stdout).unwrap();

    let found: WorkPrecision = read(&out.join("work-precision.json"));
    assert_eq!(found.speeds[0].runs.len(), 8);
    let compared = found.speeds[0].runs.iter().filter(|run| run.errors.is_some()).count();
    assert!(compared > 0, "{found:?}");
    let csv = std::fs::read_to_string(out.join("work-precision.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 8 + 1, "header, grid and reference: {csv}");
    let histories: Histories = read(&out.join("histories.json"));
    let samples = 2 * histories.samples_per_revolution as usize;
    assert_eq!(histories.lines.len(), 3);
    assert!(histories.lines.iter().flat_map(|line| &line.displacement).all(|line| line.len() == samples));
    for quantity in ["history", "amplitude", "engine-orders", "impulse"] {
        assert!(is_svg(&out.join(format!("work-precision-{quantity}.svg"))), "{quantity}");
    }
    assert!(is_svg(&out.join("histories.svg")));
    for part in ["Pareto front", "exact_modal", "Observed orders", found.speeds[0].message.as_str()] {
        assert!(words.contains(part), "{part}: {words}");
    }
}

#[test]
fn a_study_of_another_model_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let request = folder.path().join("request.json");
    let mut body = small_study();
    body["model"] = "0123".into();
    std::fs::write(&request, body.to_string()).unwrap();
    let output = study(&request, &folder.path().join("out")).output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && words.contains("leave `model` out of the request"), "{words}");
}
