//! Session of commands in pipes: results on the one stream, everything else on the other.

use super::shell::{Shell, left, read};

#[test]
fn from_a_package_to_its_critical_speeds() {
    let (shell, _program) = Shell::with_service();
    let uploaded = shell.run("upload springs.zip --name wheel --tag rig --tag cold");
    let model = uploaded.out.trim_end();
    assert!(uploaded.code == 0 && model.len() == 64, "{uploaded:?}");
    assert!(uploaded.err.contains("4 sectors, 2 contact nodes"), "{uploaded:?}");
    let again = shell.run("upload springs.zip --json");
    let body: serde_json::Value = serde_json::from_str(&again.out).unwrap();
    assert_eq!((&body["id"], &body["name"]), (&model.into(), &"wheel".into()));
    assert!(again.err.contains("had it already") && !again.err.contains("keeps"), "{again:?}");
    let renamed = shell.run("upload springs.zip --name rotor");
    assert!(renamed.err.contains("keeps the name \"wheel\""), "{renamed:?}");
    assert!(shell.done("ls --models --tag rig").contains(model));

    shell.write_sweep();
    let plan = shell.done("plan request.json --model wheel");
    for words in
        ["speeds      6, 2 side by side", "on          contact", "off         centrifugal", "to be computed"]
    {
        assert!(plan.contains(words), "{words}: {plan}");
    }
    let swept = shell.run("sweep request.json --model wheel --set /name=first --wait");
    let job = swept.out.trim_end();
    assert!(swept.code == 0 && job.len() == 36, "{swept:?}");
    let progress = |line: &str| line.contains("100 %") && line.contains("6 of 6 speeds");
    let mut after = swept.err.lines().skip_while(|line| !progress(line)).skip(1);
    assert!(after.next().is_some_and(|line| line.starts_with("Undecided: ")), "{swept:?}");
    assert!(!swept.err.contains('\u{1b}'), "no bars in a pipe: {swept:?}");
    assert!(shell.done("plan request.json --model wheel").contains("memory"), "its cost is known now");

    // A job is found by its id, the beginning of it, and its name.
    let watched = shell.json(&format!("watch {job} {} first --json", &job[..20]));
    let statuses: Vec<_> = watched["jobs"].as_array().unwrap().iter().map(|job| &job["status"]).collect();
    assert_eq!(statuses, ["successful"; 3]);
    let listed = shell.json("ls --json --kind sweep --status successful --model wheel --name FIRST");
    assert_eq!(listed["jobs"][0]["id"], job);
    assert_eq!(shell.done("ls --kind study"), "");

    let table = shell.run("get first critical-speeds --format csv");
    assert!(table.out.starts_with("index,speed_rpm"), "{table:?}");
    assert_eq!(
        table.out.lines().count() == 1,
        table.err.contains("its header only: no response"),
        "{table:?}"
    );
    let map = shell.json("get first interaction-map sensor=0");
    assert_eq!(map["amplitude"].as_array().unwrap().len(), 6);
    let saved = shell.run("get first interaction-map -o map.svg");
    assert!(saved.code == 0 && saved.out.is_empty() && saved.err.contains("map.svg: "), "{saved:?}");
    assert!(read(&shell.path("map.svg")).contains("<svg "), "the name says the form");
    shell.done("get first spectra/3 -o -");
    shell.done("get wheel section -o section.png");
    assert_eq!(shell.done("report first -o page.html"), "page.html");
    assert!(read(&shell.path("page.html")).contains("<html"));
    for file in ["first report -o again.HTML", "first archive -o first.zip", "first forces -o forces.CSV"] {
        shell.done(&format!("get {file}"));
    }
    assert!(read(&shell.path("forces.CSV")).starts_with("index,"));
    // No form ends like these; nothing is written.
    for (words, endings) in [
        ("interaction-map -o map.pdf", ".json, .csv, .npz, .svg, .png"),
        ("interaction-map -o map.html", ".json, .csv"),
        ("report -o page.pdf", "report comes as html"),
    ] {
        let refused = shell.run(&format!("get first {words}"));
        let file = words.split_whitespace().last().unwrap();
        assert!(refused.code == 1 && refused.err.contains(endings), "{refused:?}");
        assert!(refused.err.contains(file) && !shell.path(file).exists(), "{refused:?}");
    }
    shell.done("get first interaction-map -o map.pdf --format svg");
    shell.done("get first interaction-map -o map.txt format=json");

    // What is shown is what the service says.
    let shown = shell.done("show first");
    let speeds = shell.json("get first critical-speeds/wheel");
    for speed in speeds["critical_speeds"].as_array().unwrap() {
        let rpm = speed["speed_rad_s"].as_f64().unwrap() * 60.0 / std::f64::consts::TAU;
        assert!(shown.contains(&format!("\n{rpm:>12.0}  ")), "{shown}");
    }
    assert_eq!(shell.done("open first"), format!("{}/#/jobs/{job}", shell.server));

    let cancelled = shell.run("cancel first");
    assert!(cancelled.code == 0 && cancelled.err.contains("has ended: successful"), "{cancelled:?}");
    assert!(shell.done("get first interaction-map").starts_with('{'), "what has ended stays");
    assert_eq!(shell.json("rm first --json")["deleted"][0], job);
    assert_eq!(shell.done("ls"), "");
    shell.done("rm --models wheel");
    assert_eq!(shell.done("ls --models"), "");
}

#[test]
fn every_kind_of_job_can_be_asked_for() {
    let (shell, _program) = Shell::with_service();
    shell.write("modal.yaml", "modes_per_speed: 3\nspeeds: {values: [0, 300], unit: rad_s}\n");
    let scene = "scene: {damping: {modal_ratio: 0.02}}\nintegration: {revolutions: 4, ramp_revolutions: 1, window_revolutions: 2}\nmodes_per_speed: 3\n";
    shell.write("case.yaml", &format!("speed: {{value: 300, unit: rad_s}}\n{scene}"));
    shell.write(
        "study.yaml",
        &format!(
            "speeds: {{values: [300], unit: rad_s}}\ngrid: {{modes_per_speed: [1], steps_per_revolution: [360]}}\n{}",
            scene.replace("modes_per_speed: 3\n", "")
        ),
    );
    for (kind, file, result) in [
        ("modal-analysis", "modal.yaml", "campbell"),
        ("case-study", "case.yaml", "histories"),
        ("study", "study.yaml", "work-precision"),
    ] {
        let words = format!("submit --kind {kind} {file} --model springs.zip --wait --json");
        let job = shell.json(&words);
        assert_eq!(job["status"], "successful", "{job}");
        shell.done(&format!("get {} {result}", job["id"].as_str().unwrap()));
    }
    assert!(
        shell
            .done("plan --kind modal-analysis modal.yaml --model springs.zip")
            .contains("nodal diameters each")
    );
    let along = "{parameter: speed, from: 200, to: 400}";
    shell.write("branches.yaml", &format!("speed: {{value: 300, unit: rad_s}}\nalong: {along}\n{scene}"));
    let plan = shell.done("plan --kind branches branches.yaml --model springs.zip");
    assert!(plan.contains("points      at least 51, at most 801") && plan.contains("memory"), "{plan}");
    shell.write("wheel.yaml", "preset: small\nsectors: 8\n");
    assert!(shell.done("plan --kind model-generation wheel.yaml").contains("unknowns"));
}

/// One hexahedron without a material.
const BRICK: &str = "*NODE\n1, 1, -1, 0\n2, 3, -3, 0\n3, 3, 3, 0\n4, 1, 1, 0\n5, 1, -1, 2\n6, 3, -3, 2\n7, 3, 3, 2\n8, 1, 1, 2\n\
                     *ELEMENT, TYPE=C3D8I, ELSET=ALL\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";

/// Reader that goes, `rubmap ls | head -1`: it has all that was wanted.
#[test]
fn a_reader_may_go() {
    let (shell, _program) = Shell::with_service();
    let binary = env!("CARGO_BIN_EXE_rubmap");
    shell.done("upload springs.zip");
    let script = format!("set -o pipefail; {binary} get springs section | head -c 10");
    let mut bash = std::process::Command::new("bash");
    let got = left(bash.arg("-c").arg(script).env("RUBMAP_SERVER", &shell.server));
    assert_eq!((got.code, got.out.len(), got.err.as_str()), (0, 10, ""));
}

/// Reader that goes before the first word, of commands that speak to no other service: lists end, work goes on and leaves its files.
#[test]
fn a_reader_may_be_gone() {
    let shell = Shell::of("127.0.0.1:9");
    shell.write("brick.inp", BRICK);
    for words in [
        "generate --preset small --out wheel.zip",
        "modes wheel.zip",
        "completions bash",
        "import mesh brick.inp --look",
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let left = shell.command(words).stdout(writer).output().unwrap();
        let said = String::from_utf8_lossy(&left.stderr);
        assert!(!said.contains("panicked") && !said.contains("output"), "{words}: {said}");
        assert_eq!(left.status.code(), Some(0), "{words}: {said}");
    }
    assert!(shell.path("wheel.zip").exists());
}
