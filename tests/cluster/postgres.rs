//! PostgreSQL server of the test's own, which can be stopped and started again.

use std::net::TcpListener;
use std::os::unix::fs::{MetadataExt, chown};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time until the server takes connections.
const START: Duration = Duration::from_secs(60);

/// Id of the user nobody, as whom the server runs where the test is root's: it refuses to be root.
const NOBODY: u32 = 65_534;

/// PostgreSQL server of the test.
pub(crate) struct Postgres {
    binaries: PathBuf,
    folder: tempfile::TempDir,
    /// Port of this machine at which the server listens.
    pub(crate) port: u16,
    process: Option<Child>,
}

impl Postgres {
    /// Makes a server with an empty database; `None`, after printing why, where PostgreSQL is not installed.
    pub(crate) fn new() -> Option<Self> {
        let Some(binaries) = binaries() else {
            eprintln!("skipped: PostgreSQL is not installed");
            return None;
        };
        let folder = tempfile::Builder::new().prefix("rubmap-cluster-").tempdir().unwrap();
        if folder.path().metadata().unwrap().uid() == 0 {
            chown(folder.path(), Some(NOBODY), Some(NOBODY)).unwrap();
        }
        let mut server = Self { binaries, folder, port: free_port(), process: None };
        let made = server
            .command("initdb")
            .args(["-U", "rubmap", "-A", "trust", "-E", "UTF8", "--no-sync", "-D"])
            .arg(server.data())
            .stdout(Stdio::null())
            .status()
            .unwrap();
        assert!(made.success(), "initdb failed");
        server.start();
        Some(server)
    }

    /// Address of the server's database, by way of a port.
    pub(crate) fn url_by(&self, port: u16) -> String {
        format!("postgres://rubmap@127.0.0.1:{port}/postgres")
    }

    /// Address of the server's database.
    pub(crate) fn url(&self) -> String {
        self.url_by(self.port)
    }

    /// Starts the server, and waits until it takes connections.
    pub(crate) fn start(&mut self) {
        let process = self
            .command("postgres")
            .arg("-D")
            .arg(self.data())
            .arg("-k")
            .arg(self.folder.path())
            .args([
                "-p",
                &self.port.to_string(),
                "-c",
                "listen_addresses=127.0.0.1",
                "-c",
                "max_connections=200",
            ])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        self.process = Some(process);
        let begin = Instant::now();
        while !self
            .command("pg_isready")
            .args(["-q", "-h", "127.0.0.1", "-p", &self.port.to_string()])
            .status()
            .unwrap()
            .success()
        {
            assert!(begin.elapsed() < START, "PostgreSQL does not start");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Ends the server as a crash would: what it has promised is in its log, and nobody is told.
    pub(crate) fn crash(&mut self) {
        let Some(mut process) = self.process.take() else { return };
        let _ = Command::new("kill").args(["-QUIT", &process.id().to_string()]).status();
        process.wait().unwrap();
    }

    fn data(&self) -> PathBuf {
        self.folder.path().join("data")
    }

    fn command(&self, program: &str) -> Command {
        let program = self.binaries.join(program);
        if self.folder.path().metadata().unwrap().uid() != NOBODY {
            return Command::new(program);
        }
        let mut command = Command::new("setpriv");
        let nobody = NOBODY.to_string();
        command.args(["--reuid", &nobody, "--regid", &nobody, "--clear-groups", "--"]).arg(program);
        command.current_dir(self.folder.path());
        command
    }
}

impl Drop for Postgres {
    fn drop(&mut self) {
        self.crash();
    }
}

/// Folder of PostgreSQL's programs: where Debian puts them, or on the path.
fn binaries() -> Option<PathBuf> {
    let debian = std::fs::read_dir("/usr/lib/postgresql").into_iter().flatten().flatten();
    let mut folders: Vec<PathBuf> = debian.map(|version| version.path().join("bin")).collect();
    folders.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()));
    folders.into_iter().find(|folder| has_server(folder))
}

fn has_server(folder: &Path) -> bool {
    folder.join("initdb").exists() && folder.join("postgres").exists()
}

/// Port of this machine that nobody listens at.
pub(crate) fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}
