//! Requests from files and from the input.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;

use super::shell::Shell;

/// Plan of a request that comes in the input.
fn planned(shell: &Shell, text: &str) -> Value {
    let mut command = shell.command("plan - --json");
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{text}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn yaml_and_json_ask_for_the_same() {
    let (shell, _program) = Shell::with_service();
    let model = shell.done("upload springs.zip");
    let json = format!(
        r#"{{"model": "{model}", "scene": {{"damping": {{"modal_ratio": 2e-2}}, "contact": {{}},
        "casing": {{"clearance": {{"leading": 0.3, "trailing": 0.25}}}}}},
        "speeds": {{"values": [300, 512.5], "unit": "rpm"}}, "integration": {{"steps_per_revolution": "auto"}}}}"#
    );
    let yaml = format!(
        "# what the rig runs\nmodel: {model}\nscene:\n  damping: {{modal_ratio: 2e-2}}\n  contact: {{}}\n  casing:\n    \
         clearance: &clearance {{leading: 0.3, trailing: 0.25}}\nspeeds:\n  values:\n    - 300\n    - 512.5\n  unit: rpm\n\
         integration:\n  steps_per_revolution: auto\n"
    );
    let settings = planned(&shell, &json)["settings"].clone();
    assert_eq!(settings["speeds"]["values"].as_array().map(Vec::len), Some(2), "{settings}");
    assert_eq!(planned(&shell, &yaml)["settings"], settings);
    // The request comes in a file, and is changed on the way.
    shell.write("request.yaml", &yaml.replace("- 512.5", "- 600"));
    let changed = shell.json("plan request.yaml --json --set /speeds/values/1=512.5");
    assert_eq!(changed["settings"], settings);
    assert_ne!(shell.json("plan request.yaml --json")["settings"], settings);
}

/// Request that `init` prints: the service plans it as it is.
#[test]
fn a_starter_is_a_request() {
    let (shell, _program) = Shell::with_service();
    shell.done("upload springs.zip --name wheel");
    let at_rest = "--set /scene/centrifugal_stiffening=false";
    for (kind, about, of_springs) in [("sweep", "operation", at_rest), ("modal-analysis", "families", "")] {
        let starter = shell.done(&format!("init {kind}"));
        assert!(starter.starts_with("# ") && starter.contains(about), "{starter}");
        shell.write("starter.yaml", &starter);
        let small = "--set /modes_per_speed=3";
        let plan =
            shell.json(&format!("plan starter.yaml --kind {kind} --model wheel --json {small} {of_springs}"));
        assert!(plan["speeds"].as_u64().is_some_and(|speeds| speeds > 30), "{plan}");
    }
    assert_eq!(shell.run("init no-such-kind").code, 2);
}
