//! Session in a terminal.

use rexpect::process::WaitStatus;
use rexpect::session::{PtySession, spawn_command};

use super::app::{PATIENCE, long_sweep_of};
use super::shell::Shell;

fn spawn(shell: &Shell, words: &str) -> PtySession {
    let mut command = shell.command(words);
    // The terminal is as wide as terminals are, and able to move the cursor.
    command.env("TERM", "xterm").env("COLUMNS", "120");
    spawn_command(command, Some(PATIENCE.as_millis() as u64)).unwrap()
}

fn code(mut session: PtySession) -> i32 {
    session.exp_eof().unwrap();
    match session.process().wait().unwrap() {
        WaitStatus::Exited(_, code) => code,
        other => panic!("{other:?}"),
    }
}

#[test]
fn bars_are_drawn_and_ctrl_c_leaves_the_job() {
    let (shell, _program) = Shell::with_service();
    let mut upload = spawn(&shell, "upload springs.zip");
    upload.exp_string("upload").unwrap();
    upload.exp_string("[====").unwrap();
    upload.exp_string("100 %").unwrap();
    let (_, model) = upload.exp_regex("[0-9a-f]{64}").unwrap();
    assert_eq!(code(upload), 0);

    shell.write("long.json", &long_sweep_of(&model, 200).to_string());
    let mut sweep = spawn(&shell, "sweep long.json --wait");
    let (_, id) = sweep.exp_regex("[0-9a-f]{8}-[0-9a-f-]{27}").unwrap();
    sweep.exp_string("\u{1b}[").unwrap();
    sweep.exp_string("of 200 speeds").unwrap();
    sweep.send_control('c').unwrap();
    sweep.exp_string("interrupted; the service goes on").unwrap();
    sweep.exp_string(&format!("rubmap cancel {id}")).unwrap();
    assert_eq!(code(sweep), 130);
    assert_eq!(shell.json("ls --json")["jobs"][0]["status"], "running");

    let mut watch = spawn(&shell, &format!("watch {id}"));
    watch.exp_string("of 200 speeds").unwrap();
    shell.done(&format!("cancel {id}"));
    watch.exp_string("was cancelled").unwrap();
    assert_eq!(code(watch), 5);
}

#[test]
fn pictures_are_not_for_terminals() {
    let (shell, _program) = Shell::with_service();
    shell.done("upload springs.zip");
    let mut text = spawn(&shell, "get springs section");
    text.exp_string("\"nodes\"").unwrap();
    assert_eq!(code(text), 0);
    let mut picture = spawn(&shell, "get springs section --format png");
    picture.exp_string("no text: give it a file with -o").unwrap();
    assert_eq!(code(picture), 1);
}
