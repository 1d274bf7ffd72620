//! Disturbances of a service: each of them at a random moment, for a random time.

use std::io::Write;
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, Connection};

use super::program::Program;
use super::random::Random;
use super::small_disk::SmallDisk;

/// Number of times that each disturbance was made.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) kills: u32,
    pub(crate) terminations: u32,
    pub(crate) pauses: u32,
    pub(crate) locks: u32,
    pub(crate) full_disks: u32,
    pub(crate) descriptor_lacks: u32,
    pub(crate) slow_clients: u32,
}

/// Disturbs the services of one data folder.
pub(crate) struct Disturbances<'a> {
    disk: Option<&'a SmallDisk>,
    data: PathBuf,
    /// Connections that were begun and send nothing more.
    slow: Vec<TcpStream>,
    pub(crate) tally: Tally,
}

impl<'a> Disturbances<'a> {
    pub(crate) fn new(disk: Option<&'a SmallDisk>, data: &Path) -> Self {
        Self { disk, data: data.to_owned(), slow: Vec::new(), tally: Tally::default() }
    }

    /// Disturbs the service in one way, or leaves it alone for a while; returns the program that runs afterwards.
    pub(crate) async fn draw(&mut self, program: Program, random: &mut Random) -> Program {
        let milliseconds = async |random: &mut Random, most| {
            tokio::time::sleep(Duration::from_millis(random.below(most))).await;
        };
        match random.below(10) {
            0 | 1 => {
                program.kill();
                self.tally.kills += 1;
                return self.start();
            }
            2 => {
                program.terminate();
                self.tally.terminations += 1;
                return self.start();
            }
            3 => {
                program.signal("STOP");
                milliseconds(random, 2000).await;
                program.signal("CONT");
                self.tally.pauses += 1;
            }
            4 => self.lock(random).await,
            5 => {
                if let Some(disk) = self.disk {
                    disk.fill();
                    milliseconds(random, 4000).await;
                    // In half of the cases it is killed on the full disk.
                    let program = if random.below(2) == 0 {
                        program.kill();
                        self.tally.kills += 1;
                        disk.make_room();
                        self.start()
                    } else {
                        disk.make_room();
                        program
                    };
                    self.tally.full_disks += 1;
                    return program;
                }
            }
            6 => {
                let limit = |number: u64| {
                    let pid = program.id().to_string();
                    Command::new("prlimit").args(["--pid", &pid, &format!("--nofile={number}:1024")]).status()
                };
                if limit(8 + random.below(40)).is_ok_and(|status| status.success()) {
                    milliseconds(random, 3000).await;
                    assert!(limit(1024).unwrap().success());
                    self.tally.descriptor_lacks += 1;
                }
            }
            7 => {
                let address = program.api.base().trim_start_matches("http://").to_owned();
                for _ in 0..random.below(100) {
                    if let Ok(mut stream) = TcpStream::connect(&address) {
                        let _ =
                            stream.write_all(b"POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Len");
                        self.slow.push(stream);
                        self.tally.slow_clients += 1;
                    }
                }
                let most = self.slow.len().saturating_sub(300);
                self.slow.drain(..most);
            }
            _ => milliseconds(random, 3000).await,
        }
        program
    }

    /// Ends the disturbances.
    pub(crate) fn end(&mut self) {
        self.slow.clear();
    }

    fn start(&self) -> Program {
        Program::serve(&self.data)
    }

    /// Locks the database, as another program that keeps it to itself.
    async fn lock(&mut self, random: &mut Random) {
        let options = SqliteConnectOptions::new().filename(self.data.join("rubmap.sqlite"));
        let Ok(mut other) = options.busy_timeout(Duration::from_secs(2)).connect().await else { return };
        if sqlx::query("begin exclusive").execute(&mut other).await.is_ok() {
            tokio::time::sleep(Duration::from_millis(random.below(8000))).await;
            let _ = sqlx::query("rollback").execute(&mut other).await;
            self.tally.locks += 1;
        }
        let _ = other.close().await;
    }
}
