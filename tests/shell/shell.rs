//! Shell of a user.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

use super::app::sweep_of;
use super::model;
use super::program::Program;

/// Folder of a user, and the service to which commands in it speak.
pub(crate) struct Shell {
    pub(crate) folder: TempDir,
    pub(crate) server: String,
}

/// Exit code and output of a command.
#[derive(Debug)]
pub(crate) struct Left {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Shell {
    pub(crate) fn of(server: &str) -> Self {
        Self { folder: tempfile::tempdir().unwrap(), server: server.to_owned() }
    }

    /// Makes a shell with a service of its own and a package.
    pub(crate) fn with_service() -> (Self, Program) {
        let folder = tempfile::tempdir().unwrap();
        let program = Program::serve(&folder.path().join("data"));
        std::fs::write(folder.path().join("springs.zip"), model::package(1.0)).unwrap();
        (Self { folder, server: program.api.base().to_owned() }, program)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Command of words between blanks.
    pub(crate) fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
        command.args(words.split_whitespace()).current_dir(&self.folder).env("RUBMAP_SERVER", &self.server);
        for variable in ["RUBMAP_TOKEN", "RUBMAP_TOKEN_FILE", "DISPLAY", "WAYLAND_DISPLAY"] {
            command.env_remove(variable);
        }
        command.stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, words: &str) -> Left {
        left(&mut self.command(words))
    }

    /// Runs a command that must be done; returns its output.
    #[track_caller]
    pub(crate) fn done(&self, words: &str) -> String {
        let left = self.run(words);
        assert_eq!(left.code, 0, "{words}: {left:?}");
        left.out.trim_end().to_owned()
    }

    /// Runs a command that must be done; returns the document that it prints.
    #[track_caller]
    pub(crate) fn json(&self, words: &str) -> Value {
        serde_json::from_str(&self.done(words)).unwrap()
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Writes a short sweep to request.json, without a model.
    pub(crate) fn write_sweep(&self) {
        let mut request = sweep_of("");
        request.as_object_mut().unwrap().remove("model");
        self.write("request.json", &request.to_string());
    }
}

pub(crate) fn left(command: &mut Command) -> Left {
    let output = command.output().unwrap();
    Left {
        code: output.status.code().expect("it ends by itself"),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

pub(crate) fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}
