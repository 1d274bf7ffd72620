//! Exit codes of commands, all of them.

use std::process::Stdio;
use std::time::{Duration, Instant};

use rubmap::tokens::{Scope, new_token};
use serde_json::Value;

use super::app::{PATIENCE, long_sweep_of};
use super::program::Program;
use super::shell::{Shell, left};

#[track_caller]
fn ends(shell: &Shell, words: &str, code: i32, parts: &[&str]) {
    let left = shell.run(words);
    assert_eq!(left.code, code, "{words}: {left:?}");
    assert_eq!(left.out, "", "{words}");
    for part in parts {
        assert!(left.err.contains(part), "{words}: {part}: {left:?}");
    }
}

#[test]
fn one_is_something_here() {
    let shell = Shell::of("127.0.0.1:9");
    shell.write("broken.yaml", "scene: {}\nspeeds: [1,\nunit: rpm\n");
    shell.write("broken.json", "{\"scene\": {},\n \"speeds\": }");
    shell.write("list.yaml", "- 1\n");
    shell.write("twice.yaml", "scene: {}\nscene: {}\n");
    shell.write("token", "no\ttoken\n");
    for (words, parts) in [
        ("upload none.zip", &["none.zip", "No such file"][..]),
        ("upload .", &["is a folder"]),
        ("sweep none.yaml", &["none.yaml", "No such file"]),
        ("sweep .", &["Is a directory"]),
        ("sweep broken.yaml", &["broken.yaml is not YAML", "at line 4"]),
        ("sweep broken.json", &["broken.json is not JSON", "line 2 column"]),
        ("sweep list.yaml", &["is not the body of POST /v1/sweeps"]),
        ("sweep twice.yaml", &["duplicate entry", "scene"]),
        ("plan -", &["the input is not the body"]),
        ("ls --token-file none", &["cannot read the token in none"]),
        ("ls --token-file token", &["characters that no token has"]),
    ] {
        ends(&shell, words, 1, parts);
    }
}

#[test]
fn two_is_the_command_line() {
    let shell = Shell::of("127.0.0.1:9");
    for (words, part) in [
        ("sweep", "<REQUEST>"),
        ("sweep request.json --set speeds", "/speeds/count=80"),
        ("plan request.json --kind studies", "modal-analysis"),
        ("get job ../models", "interaction-map"),
        ("get job campbell frame", "sensor=1"),
        ("ls --models --kind sweep", "cannot be used with"),
        ("ls --server https://rig.example", "no TLS"),
        ("ls --server :", "no address"),
        ("watch", "<JOB>"),
        ("fly", "unrecognized"),
    ] {
        ends(&shell, words, 2, &[part]);
    }
}

#[test]
fn three_is_a_refusal_and_says_all_that_is_wrong() {
    let (shell, _program) = Shell::with_service();
    shell.write_sweep();
    shell.write("text.zip", "no zip");
    shell.done("upload springs.zip");
    shell.done("sweep request.json --model springs --set /name=a");
    shell.done("sweep request.json --model springs --set /name=b");
    let unknown = "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10";
    for (words, parts) in [
        ("upload text.zip", &["422", "is not a zip file"][..]),
        ("sweep request.json", &["\n  /model: "]),
        (
            "sweep request.json --model springs --set /speeds/count=x --set /scene/friktion={}",
            &["\n  /speeds/count: ", "\n  /scene/friktion: ", "friction"],
        ),
        ("sweep request.json --model none", &["none of the models", "\"none\""]),
        ("watch 0", &["may be 2 of the jobs"]),
        ("watch zero", &["none of the jobs"]),
        ("get a interaction-map --format xlsx", &["format: expected one of json"]),
        ("get a interaction-map sensor=9", &["sensor"]),
        ("get a nonsense", &["there is no result nonsense; the job has interaction-map, critical-speeds,"]),
    ] {
        ends(&shell, words, 3, parts);
    }
    ends(&shell, &format!("rm {unknown}"), 3, &["there is no job"]);
    // The output for scripts is the document of the problem.
    let refused = shell.run("sweep request.json --json");
    let problem: Value = serde_json::from_str(&refused.out).unwrap();
    assert_eq!((refused.code, &problem["errors"][0]["pointer"]), (3, &"/model".into()));
}

#[test]
fn a_token_comes_from_the_environment_or_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let tokens = folder.path().join("tokens");
    let token = new_token(&tokens, "anna", Scope::Write).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.env("RUBMAP_TOKENS", &tokens);
    let program = Program::run(command, &folder.path().join("data"));
    let shell = Shell::of(program.api.base());
    shell.write("token", &format!("{token}\n"));
    ends(&shell, "ls", 3, &["401"]);
    ends(&shell, "ls --token wrong", 3, &["401"]);
    shell.done("ls --token-file token");
    assert_eq!(left(shell.command("ls").env("RUBMAP_TOKEN", &token)).code, 0);
    // The last token given, that of the file, counts.
    assert_eq!(left(shell.command("ls --token-file token").env("RUBMAP_TOKEN", "wrong")).code, 0);
}

#[test]
fn four_is_a_job_that_failed() {
    let (shell, _program) = Shell::with_service();
    shell.write_sweep();
    // No family has the number 99, so that no speed can be computed.
    let mut command =
        shell.command("sweep request.json --model springs.zip --set /name=failing --wait --set");
    let failed = left(command.arg("/scene/initial={nodal_diameter: 0, family: 99, amplitude: 0.01}"));
    assert_eq!(failed.code, 4, "{failed:?}");
    assert!(failed.err.contains("failed: none of the 6 speeds was completed"), "{failed:?}");
    let watched = shell.run("watch failing --json");
    let body: Value = serde_json::from_str(&watched.out).unwrap();
    assert_eq!((watched.code, &body["jobs"][0]["status"]), (4, &"failed".into()));
}

/// Starts a long sweep called `long` and waits until it runs.
fn start_long(shell: &Shell, program: &Program) -> String {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let mut request = long_sweep_of(&shell.done("upload springs.zip"), 200);
    request["name"] = "long".into();
    shell.write("long.json", &request.to_string());
    let id = shell.done("sweep long.json");
    runtime.block_on(program.api.follow(&id, |job| job["status"] == "running"));
    id
}

#[test]
fn five_is_a_job_that_was_cancelled() {
    let (shell, program) = Shell::with_service();
    let id = start_long(&shell, &program);
    let watch = shell.command("watch long").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    ends(&shell, "rm long", 3, &["is running: rubmap cancel"]);
    assert_eq!(shell.json("cancel long --json")["jobs"][0]["status"], "dismissed");
    let watched = watch.wait_with_output().unwrap();
    assert_eq!(watched.status.code(), Some(5));
    assert_eq!(String::from_utf8(watched.stdout).unwrap().trim_end(), format!("{id}  dismissed"));
    shell.done("rm long");
}

#[test]
fn a_job_is_set_aside_and_goes_on() {
    let (shell, program) = Shell::with_service();
    let id = start_long(&shell, &program);
    assert_eq!(shell.json("pause long --json")["jobs"][0]["status"], "paused");
    let on = shell.run("continue long");
    let says = |status: &str| on.err.contains(&format!("job {id} is {status}"));
    assert!(on.code == 0 && (says("accepted") || says("running")), "{on:?}");
    shell.done("cancel long");
    ends(&shell, "pause long", 3, &["dismissed: it cannot be paused"]);
}

#[test]
fn an_interrupted_command_leaves_the_job_and_says_how_to_go_on() {
    let (shell, program) = Shell::with_service();
    let id = start_long(&shell, &program);
    let watch = shell.command("watch long").stderr(Stdio::piped()).spawn().unwrap();
    let mut watch = Interrupted::when_it_speaks(watch);
    let (code, said) = watch.end();
    assert_eq!(code, Some(130), "{said}");
    for words in [format!("rubmap watch {id}"), format!("rubmap cancel {id}")] {
        assert!(said.contains(&words), "{said}");
    }
    assert_eq!(shell.json("ls --json")["jobs"][0]["status"], "running");
}

/// Command that gets SIGINT after its first line.
struct Interrupted {
    child: std::process::Child,
    errors: std::io::BufReader<std::process::ChildStderr>,
}

impl Interrupted {
    fn when_it_speaks(mut child: std::process::Child) -> Self {
        use std::io::BufRead;
        let mut errors = std::io::BufReader::new(child.stderr.take().unwrap());
        errors.read_line(&mut String::new()).unwrap();
        let id = child.id().to_string();
        assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        Self { child, errors }
    }

    fn end(&mut self) -> (Option<i32>, String) {
        let mut said = String::new();
        std::io::Read::read_to_string(&mut self.errors, &mut said).unwrap();
        (self.child.wait().unwrap().code(), said)
    }
}

#[test]
fn six_is_a_service_that_is_not_there() {
    // Nobody listens here any more.
    let address = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let shell = Shell::of(&address.to_string());
    shell.write("springs.zip", "whatever");
    for words in ["ls", "upload springs.zip", "watch 0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10"] {
        ends(&shell, &format!("{words} --patience 0"), 6, &["does not answer", "refused"]);
    }
    let begin = Instant::now();
    ends(&shell, "ls --patience 1", 6, &["asking again for 1 s"]);
    assert!(begin.elapsed() < PATIENCE);
}

#[test]
fn a_watch_outlives_its_service() {
    let (shell, program) = Shell::with_service();
    start_long(&shell, &program);
    let address = program.api.base().trim_start_matches("http://").to_owned();
    let watch = shell.command("watch long --patience 100").stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(300));
    program.kill();
    let mut command = shell.command(&format!("serve --workers 2 --data data --addr {address}"));
    let mut again = command.stderr(Stdio::null()).spawn().unwrap();
    shell.done("cancel long --patience 100");
    let output = watch.wait_with_output().unwrap();
    again.kill().unwrap();
    again.wait().unwrap();
    assert_eq!(output.status.code(), Some(5), "{output:?}");
}
