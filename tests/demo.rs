//! Commands that show something, at the smallest size that is still real: the binary itself, from package to drawings.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use rubmap::analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use rubmap::analysis::run::{Histories, WorkPrecision};
use rubmap::impeller::{Preset, generate};
use rubmap::package::raw::RawPackage;
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
    // A large response is no fault of the program.
    let troubled = |line: &str| {
        line.contains("ERROR") || (line.contains("WARN") && !line.contains("leaves linear theory"))
    };
    assert!(!stderr.lines().any(troubled), "{stderr}");
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
    for drawing in ["level.svg", "interaction-map.svg", "interaction-map-frequency.svg", "campbell.svg"] {
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

/// Request for a study of two sizes, steps and schemes, with a touch of contact.
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

/// Writes a package as a user would bring it: small, with `change` made to it.
fn package_in(folder: &Path, change: impl FnOnce(&mut RawPackage)) -> PathBuf {
    let mut package = generate(&Preset::Small.parameters()).unwrap();
    change(&mut package);
    let path = folder.join("mine.zip");
    rubmap::package::write(&package, std::fs::File::create(&path).unwrap()).unwrap();
    path
}

/// Command of the demo with a package of the user's own.
fn own(package: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.args(["demo", "--workers", "2", "--package"]).arg(package).arg("--out").arg(out).args(more);
    command
}

fn refusal(mut command: Command) -> String {
    let output = command.output().unwrap();
    let words = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert!(!output.status.success(), "{words}");
    words
}

#[test]
fn the_demo_of_a_package_of_ones_own_chooses_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let package = package_in(folder.path(), |_| {});
    let words = quiet_success(own(&package, &out, &["--speeds", "4", "--revolutions", "5"])).stdout;
    let words = String::from_utf8(words).unwrap();
    let map: InteractionMap = read(&out.join("interaction-map.json"));
    assert!(map.amplitude.len() == 4 && map.amplitude.iter().all(Option::is_some));
    assert!(map.points.iter().all(|point| point.contact_share > 0.0), "the tips touch");
    let highest = Preset::Small.parameters().top_speed_rad_s;
    let (slowest, fastest) = (map.speeds_rad_s[0], map.speeds_rad_s[3]);
    assert!(
        (fastest / highest - 1.0).abs() < 1e-3 && (slowest / highest * 3.0 - 1.0).abs() < 1e-3,
        "{map:?}"
    );
    for drawing in ["level.svg", "interaction-map.svg", "interaction-map-frequency.svg", "campbell.svg"] {
        assert!(is_svg(&out.join(drawing)), "{drawing}");
    }
    for part in
        ["chosen    speeds", "% of the radius at which the tips lie", "4 of 4 speeds computed", "--request"]
    {
        assert!(words.contains(part), "{part}: {words}");
    }

    // The request that it left is what the user edits.
    let file = out.join("sweep-request.json");
    let mut request: serde_json::Value = read(&file);
    assert!(request.get("model").is_none());
    request["speeds"]["count"] = 2.into();
    request["scene"]["casing"]["lobes"]["count"] = 3.into();
    std::fs::write(&file, request.to_string()).unwrap();
    quiet_success(own(&package, &out, &["--request", file.to_str().unwrap()]));
    let map: InteractionMap = read(&out.join("interaction-map.json"));
    assert_eq!(map.speeds_rad_s.len(), 2);
    let campbell: Campbell = read(&out.join("campbell.json"));
    assert_eq!(campbell.settings.lobes, 3);
    assert_eq!(read::<serde_json::Value>(&file), request, "a user's file is not written over");
}

#[test]
fn speeds_are_marched_until_they_repeat_unless_a_number_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let package = package_in(folder.path(), |_| {});
    let words = String::from_utf8(quiet_success(own(&package, &out, &["--speeds", "2"])).stdout).unwrap();
    assert!(words.contains("marches: ") && words.contains("at most"), "{words}");
    let request: serde_json::Value = read(&out.join("sweep-request.json"));
    assert_eq!(request["integration"]["revolutions"], "auto");
    let map: InteractionMap = read(&out.join("interaction-map.json"));
    assert!(map.points.iter().all(|point| point.march.is_some()), "{map:?}");
    let refused = refusal(own(&package, &out, &["--revolutions", "4"]));
    assert!(
        refused.contains("neither \"auto\" nor a number of revolutions between 5 and 10000"),
        "{refused}"
    );
}

#[test]
fn a_package_without_stiffness_at_speed_is_swept_where_its_lowest_frequency_is_met() {
    let folder = tempfile::tempdir().unwrap();
    let package = package_in(folder.path(), |package| {
        package.manifest.speeds_rad_s.truncate(1);
        package.manifest.stiffness.truncate(1);
        package.stiffness.truncate(1);
    });
    let out = folder.path().join("out");
    let output = quiet_success(own(&package, &out, &["--speeds", "3", "--revolutions", "5"]));
    assert!(String::from_utf8(output.stdout).unwrap().contains("at standstill only"));
    let map: InteractionMap = read(&out.join("interaction-map.json"));
    let campbell: Campbell = read(&out.join("campbell.json"));
    let lowest = campbell.frequencies_hz[0].iter().flatten().copied().reduce(f64::min).unwrap();
    let order = |speed_rad_s: f64| lowest * std::f64::consts::TAU / speed_rad_s;
    assert!((order(map.speeds_rad_s[2]) / 3.0 - 1.0).abs() < 0.05, "{}", order(map.speeds_rad_s[2]));
    assert!((order(map.speeds_rad_s[0]) / 9.0 - 1.0).abs() < 0.05, "{}", order(map.speeds_rad_s[0]));
}

#[test]
fn what_is_wrong_with_a_package_or_request_of_ones_own_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let good = package_in(folder.path(), |_| {});
    let missing = refusal(own(&folder.path().join("none.zip"), &out, &[]));
    assert!(missing.contains("none.zip: there is no such file"), "{missing}");
    let no_zip = folder.path().join("no.zip");
    std::fs::write(&no_zip, "no zip").unwrap();
    let refused = refusal(own(&no_zip, &out, &[]));
    assert!(refused.contains("The model package is not valid\n  "), "{refused}");
    let bad = folder.path().join("bad");
    std::fs::create_dir(&bad).unwrap();
    let bad = package_in(&bad, |package| package.manifest.sectors = 1);
    let refused = refusal(own(&bad, &out, &[]));
    assert!(refused.contains("The model package is not valid\n  sector.json, /cyclic/"), "{refused}");

    let request = folder.path().join("request.json");
    for (text, words) in [
        ("{", vec!["request.json is not JSON"]),
        ("[]", vec!["request.json is not the body of POST /v1/sweeps"]),
        (r#"{"model": "0123"}"#, vec!["leave `model` out of the request"]),
        (
            r#"{"speed": 1, "scene": {"friktion": {}}}"#,
            vec!["\n  /speed: ", "\n  /scene/friktion: ", "\n  /speeds: "],
        ),
        (
            r#"{"speeds": {"values": [9e9], "unit": "rpm"}, "scene": {"centrifugal_stiffening": true}}"#,
            vec!["\n  /speeds/values/0: "],
        ),
    ] {
        std::fs::write(&request, text).unwrap();
        let refused = refusal(own(&good, &out, &["--request", request.to_str().unwrap()]));
        for words in words {
            assert!(refused.contains(words), "{words}: {refused}");
        }
    }
    let together = refusal(own(&good, &out, &["--request", "r.json", "--speeds", "3"]));
    assert!(together.contains("cannot be used with"), "{together}");
    let mut alone = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    alone.args(["demo", "--request", "r.json"]);
    assert!(refusal(alone).contains("--package"));
}
