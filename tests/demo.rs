//! The README's first command, at the smallest size that is still real: the binary itself, from package to drawings.

use std::path::Path;
use std::process::{Command, Output};

use rubmap::analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use serde::de::DeserializeOwned;

fn demo(out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.args(["demo", "--speeds", "4", "--revolutions", "5", "--workers", "2", "--out"]).arg(out);
    let output = command.output().unwrap();
    let (stdout, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{stdout}{stderr}");
    assert!(!stderr.contains("WARN") && !stderr.contains("ERROR"), "{stderr}");
    output
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
        let text = std::fs::read_to_string(out.join(drawing)).unwrap();
        assert_eq!(roxmltree::Document::parse(&text).unwrap().root_element().tag_name().name(), "svg");
    }
    assert!(rubmap::package::read(&out.join("impeller.zip"), &rubmap::package::Limits::default()).is_ok());
    let words = String::from_utf8(first.stdout).unwrap();
    assert!(words.contains("4 of 4 speeds computed") && words.contains("Critical speeds"), "{words}");

    let again = String::from_utf8(demo(&out).stdout).unwrap();
    assert!(again.contains("known from an earlier run"), "{again}");
    let repeated: InteractionMap = read(&out.join("interaction-map.json"));
    assert_eq!(repeated.amplitude, map.amplitude, "to the bit");
}
