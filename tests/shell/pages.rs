//! Completions, pages for `man`, and a browser that opens.

use std::os::unix::fs::PermissionsExt;
use std::process::Command;

use super::model::files_in;
use super::shell::{Shell, left, read};
use super::stub::{JOB, Stub, job};

/// Names of all commands, by the program's own help.
fn commands(shell: &Shell) -> Vec<String> {
    let help = shell.done("--help");
    let lines = help.lines().filter_map(|line| line.strip_prefix("  "));
    let first = lines.filter(|line| !line.starts_with([' ', '-'])).filter_map(|line| line.split("  ").next());
    first.map(ToOwned::to_owned).collect()
}

#[test]
fn shells_and_man_know_every_command() {
    let shell = Shell::of("127.0.0.1:9");
    let commands = commands(&shell);
    assert!(commands.len() > 20 && commands.contains(&"watch".to_owned()), "{commands:?}");
    for name in ["bash", "zsh", "fish"] {
        let script = shell.done(&format!("completions {name}"));
        assert!(commands.iter().all(|command| script.contains(command.as_str())), "{name}");
        shell.write(name, &script);
    }
    let script = "source ./bash; COMP_WORDS=(rubmap ls --status s); COMP_CWORD=3; _rubmap rubmap s --status; echo ${COMPREPLY[@]}";
    let completed = left(Command::new("bash").arg("-c").arg(script).current_dir(&shell.folder));
    assert_eq!(completed.out.trim_end(), "successful", "{completed:?}");

    shell.done("man --out made/man1");
    let pages = files_in(&shell.path("made/man1"));
    for command in commands.iter().filter(|command| *command != "help") {
        assert!(pages.contains(&format!("rubmap-{command}.1")), "{command}: {pages:?}");
    }
    let page = read(&shell.path("made/man1/rubmap-watch.1"));
    for words in ["RUBMAP_SERVER", "Exit codes", "\\-\\-patience", "the service refuses"] {
        assert!(page.contains(words), "{words}: {page}");
    }
}

#[test]
fn a_browser_opens_where_there_is_a_display() {
    let stub = Stub::start(|_, _| async {
        axum::response::IntoResponse::into_response(axum::Json(job("running", 0)))
    });
    let shell = Shell::of(&stub.address);
    shell.write("xdg-open", "#!/bin/sh\necho \"$1\" > opened.new && mv opened.new opened\n");
    std::fs::set_permissions(shell.path("xdg-open"), PermissionsExt::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", shell.folder.path().display(), std::env::var("PATH").unwrap());
    let address = format!("http://{}/#/jobs/{JOB}", stub.address);

    let mut without = shell.command(&format!("open {JOB}"));
    assert_eq!(left(without.env("PATH", &path)).out.trim_end(), address);
    assert!(!shell.path("opened").exists());
    let mut with = shell.command(&format!("open {JOB}"));
    assert_eq!(left(with.env("PATH", &path).env("DISPLAY", ":7")).code, 0);
    while !shell.path("opened").exists() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert_eq!(read(&shell.path("opened")).trim_end(), address);
}
