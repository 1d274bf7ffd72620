//! Program as a client, as a user has it: the binary in a pipe and in a terminal, against the real service; and against one that
//! behaves as services do on bad days.

#[path = "../api/app.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod app;
mod bad_days;
mod codes;
mod downloads;
mod files;
mod fits;
#[path = "../api/model.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod model;
mod pages;
mod pipe;
#[path = "../api/program.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod program;
mod shell;
#[path = "../api/small_disk.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod small_disk;
mod stub;
mod terminal;
mod verdicts;
