//! An S3 server of the test's own: moto, which keeps all in memory.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::postgres::free_port;

/// Longest time until it takes connections.
const START: Duration = Duration::from_secs(60);

/// The server, with an empty bucket.
pub(crate) struct S3 {
    process: Child,
    port: u16,
}

impl S3 {
    /// A new server; none, saying why, where moto is not installed.
    pub(crate) fn new() -> Option<Self> {
        let port = free_port();
        let mut command = Command::new("moto_server");
        command.args(["-H", "127.0.0.1", "-p", &port.to_string()]);
        let Ok(process) = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn() else {
            eprintln!("a folder instead of S3: moto_server is not on the path");
            return None;
        };
        let begin = Instant::now();
        while !make_bucket(port) {
            assert!(begin.elapsed() < START, "moto does not start");
            std::thread::sleep(Duration::from_millis(50));
        }
        Some(Self { process, port })
    }

    /// The port of this machine at which it listens.
    pub(crate) fn port(&self) -> u16 {
        self.port
    }
}

impl Drop for S3 {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The environment of who finds the bucket by way of a port.
pub(crate) fn environment(port: u16) -> [(&'static str, String); 6] {
    [
        ("RUBMAP_OBJECTS", "s3://bucket/rubmap".to_owned()),
        ("AWS_ENDPOINT", format!("http://127.0.0.1:{port}")),
        ("AWS_ALLOW_HTTP", "true".to_owned()),
        ("AWS_REGION", "us-east-1".to_owned()),
        ("AWS_ACCESS_KEY_ID", "test".to_owned()),
        ("AWS_SECRET_ACCESS_KEY", "test".to_owned()),
    ]
}

fn make_bucket(port: u16) -> bool {
    let Ok(mut stream) = TcpStream::connect(("127.0.0.1", port)) else { return false };
    let request = "PUT /bucket HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    let mut answer = String::new();
    stream.write_all(request.as_bytes()).and_then(|()| stream.read_to_string(&mut answer)).is_ok()
        && answer.contains(" 200 ")
}
