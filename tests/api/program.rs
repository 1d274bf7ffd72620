//! Real program as a child process.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::app::{Api, PATIENCE};

/// `rubmap serve` as a child process.
pub(crate) struct Program {
    child: Child,
    pub(crate) api: Api,
    /// Lines that the process has logged since it listens.
    log: Arc<Mutex<Vec<String>>>,
}

impl Program {
    pub(crate) fn serve(data: &Path) -> Self {
        Self::run(Command::new(env!("CARGO_BIN_EXE_rubmap")), data)
    }

    /// Starts a service by a command that runs the program with the arguments it gets.
    pub(crate) fn run(mut command: Command, data: &Path) -> Self {
        command.args(["serve", "--workers", "2", "--data"]).arg(data);
        #[cfg(feature = "cluster")]
        command.envs(super::app::servers::of(data).into_iter().flatten());
        Self::start(command)
    }

    /// Starts a service by a command that has all arguments but the address.
    pub(crate) fn start(mut command: Command) -> Self {
        let mut child = command
            .args(["--addr", "127.0.0.1:0"])
            .env("RUST_LOG", "info")
            .env("NO_COLOR", "1")
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut log = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        let base = loop {
            line.clear();
            assert_ne!(log.read_line(&mut line).unwrap(), 0, "the program ended before it listened");
            if let Some(at) = line.find("http://") {
                break line[at..].trim().to_owned();
            }
        };
        let lines = Arc::<Mutex<Vec<String>>>::default();
        let kept = Arc::clone(&lines);
        std::thread::spawn(move || {
            for line in log.lines().map_while(Result::ok) {
                if line.contains(" ERROR ") {
                    eprintln!("{line}");
                }
                kept.lock().unwrap().push(line);
            }
        });
        Self { child, api: Api::new(&base), log: lines }
    }

    /// Whether the process logged `message` about `part` of a reduction.
    pub(crate) fn said(&self, message: &str, part: &str) -> bool {
        let part = format!("part=\"{part}\"");
        self.log.lock().unwrap().iter().any(|line| line.contains(message) && line.contains(&part))
    }

    /// Id of the process.
    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Sends a signal, by its name.
    pub(crate) fn signal(&self, name: &str) {
        let sent = Command::new("kill").arg(format!("-{name}")).arg(self.id().to_string()).status().unwrap();
        assert!(sent.success());
    }

    /// Ends the process by SIGTERM; asserts that it ends well, and before anybody loses patience.
    pub(crate) fn terminate(mut self) {
        self.signal("TERM");
        let begin = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                assert!(status.success(), "a service told to stop ends well");
                return;
            }
            assert!(begin.elapsed() < PATIENCE, "it does not end");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Kills the process by SIGKILL: no handler runs, nothing is flushed.
    pub(crate) fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
