//! S3 server of the test's own, by `moto_server`, which can be stopped and started again. A start forgets all objects.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time until the server takes connections.
const START: Duration = Duration::from_secs(60);

/// S3 server with one bucket.
pub(crate) struct S3 {
    /// Port of this machine at which the server listens.
    pub(crate) port: u16,
    /// Whether the server looks at keys, of which it knows none.
    is_strict: bool,
    process: Option<Child>,
}

impl S3 {
    /// Name of the bucket.
    pub(crate) const BUCKET: &str = "wheels";

    /// Makes a server that lets everybody in; `None`, after printing why, where moto is not installed.
    pub(crate) fn new() -> Option<Self> {
        Self::of(false)
    }

    /// Makes a server that lets nobody in.
    pub(crate) fn strict() -> Option<Self> {
        Self::of(true)
    }

    fn of(is_strict: bool) -> Option<Self> {
        let mut help = Command::new("moto_server");
        let help = help.arg("--help").stdout(Stdio::null()).stderr(Stdio::null()).status();
        if !help.is_ok_and(|status| status.success()) {
            eprintln!("skipped: there is no moto_server (pip install 'moto[server]')");
            return None;
        }
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let mut server = Self { port, is_strict, process: None };
        server.start();
        Some(server)
    }

    pub(crate) fn endpoint(&self) -> String {
        format!("http://127.0.0.1:{}", self.port)
    }

    /// Starts the server with an empty bucket, and waits until it answers.
    pub(crate) fn start(&mut self) {
        let mut command = Command::new("moto_server");
        command.args(["-H", "127.0.0.1", "-p", &self.port.to_string()]);
        if self.is_strict {
            // This applies to all but the first request, which makes the bucket.
            command.env("INITIAL_NO_AUTH_ACTION_COUNT", "1");
        }
        self.process = Some(command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap());
        let begin = Instant::now();
        let mut stream = loop {
            match TcpStream::connect(("127.0.0.1", self.port)) {
                Ok(stream) => break stream,
                Err(error) => assert!(begin.elapsed() < START, "moto_server does not start: {error}"),
            }
            std::thread::sleep(Duration::from_millis(50));
        };
        let make = "HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
        write!(stream, "PUT /{} {make}", Self::BUCKET).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    }

    /// Ends the server as a crash would.
    pub(crate) fn crash(&mut self) {
        let Some(mut process) = self.process.take() else { return };
        let _ = process.kill();
        process.wait().unwrap();
    }

    /// Stops the process, without a word to those who wait for it.
    pub(crate) fn freeze(&self) {
        let id = self.process.as_ref().unwrap().id().to_string();
        assert!(Command::new("kill").args(["-STOP", &id]).status().unwrap().success());
    }
}

impl Drop for S3 {
    fn drop(&mut self) {
        self.crash();
    }
}
