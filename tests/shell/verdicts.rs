//! Verdicts in the shell: shown at the end of a sweep, and a gate for pipelines.

use super::shell::Shell;

/// Setting of an operating range within the speeds of the sweep.
const RANGE: &str = "/operation={ranges: [{name: run, from: 400, to: 800, unit: rad_s}]}";

#[test]
fn a_sweep_ends_with_its_verdict_and_can_fail_on_it() {
    let (shell, _program) = Shell::with_service();
    shell.write_sweep();
    let sweep = |name: &str, limit: &str, words: &str| {
        let mut command =
            shell.command(&format!("sweep request.json --model springs.zip --wait {words} --set"));
        command
            .arg(format!("/name={name}"))
            .args(["--set", RANGE, "--set"])
            .arg(format!("/limits/tip_motion={limit}"));
        super::shell::left(&mut command)
    };
    let strict = sweep("strict", "0.000001", "");
    assert_eq!(strict.code, 0, "without --fail-on it is a successful sweep: {strict:?}");
    assert_eq!(strict.out.lines().count(), 1, "the output is the id: {strict:?}");
    for part in ["Act: in range \"run\" (3,820 to 7,639 rpm) at ", "worst (rpm)", "in run, -", "tip motion "]
    {
        assert!(strict.err.contains(part), "{part}: {}", strict.err);
    }
    assert_eq!(sweep("again", "0.000001", "--fail-on act").code, 3);
    let loose = sweep("loose", "1000000", "--fail-on act");
    assert_eq!(loose.code, 0, "{loose:?}");
    // Six speeds do not cover the range: undecided.
    let undecided = sweep("open", "1000000", "--fail-on undecided");
    assert_eq!(undecided.code, 3, "{undecided:?}");
    assert!(undecided.err.contains("to decide: "), "{}", undecided.err);
    assert!(undecided.err.contains("is undecided, and --fail-on asks to fail then"), "{}", undecided.err);
    // Watching the same jobs.
    for (words, code) in [
        ("watch loose", 0),
        ("watch loose --fail-on act", 0),
        ("watch loose strict --fail-on act", 3),
        ("watch loose --fail-on watch", 3),
    ] {
        assert_eq!(shell.run(words).code, code, "{words}");
    }
    // One word beside each job.
    let listed = shell.done("ls");
    let word = |name: &str| {
        let line = listed.lines().find(|line| line.ends_with(&format!(" {name}"))).unwrap();
        line.split("%").nth(1).unwrap().split_whitespace().next().unwrap().to_owned()
    };
    assert_eq!((word("strict").as_str(), word("open").as_str()), ("act", "undecided"), "{listed}");
    let jobs = shell.json("ls --json --name strict");
    assert_eq!(jobs["jobs"][0]["verdict"], "act");
    assert_eq!(shell.json("watch open --json")["jobs"][0]["verdict"], "undecided");
    let watched = shell.done("watch strict open");
    let ends: Vec<&str> = watched.lines().map(|line| &line[36..]).collect();
    assert_eq!(ends, ["  successful  act", "  successful  undecided"]);
    // The same text, and the document.
    let text = shell.done("get strict verdict --format text");
    assert!(strict.err.contains(&text), "{text}");
    let shown = shell.done("show strict");
    for part in [text.as_str(), "sweep \"strict\", ", "successful at 100 %, 6 of 6 speeds", "results: "] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    let document = shell.json("get strict verdict");
    assert_eq!(document["verdict"], "act");
    assert!(text.starts_with(document["sentence"].as_str().unwrap()));
    for words in ["get strict verdict --format text -o verdict.txt", "sweep request.json --fail-on act"] {
        assert_ne!(shell.run(words).code, 0, "{words}");
    }
}
