//! Downloads: files that are whole, or not there.

use std::os::unix::fs::PermissionsExt;

use axum::Json;
use axum::body::Body;
use axum::http::header;
use axum::response::IntoResponse;
use futures::StreamExt;

use super::model::files_in;
use super::shell::{Shell, read};
use super::small_disk::SmallDisk;
use super::stub::{JOB, Stub, job};

/// Service whose result breaks off after some bytes, as often as `times`, and is whole afterwards.
fn breaking(times: usize) -> Stub {
    Stub::start(move |before, request| async move {
        if !request.uri().path().ends_with("/campbell") {
            return Json(job("successful", 100)).into_response();
        }
        let first = futures::stream::once(async { Ok::<_, std::io::Error>("first half, ") });
        let second = futures::stream::once(async move {
            // The first bytes have to be on their way before the rest breaks off.
            tokio::time::sleep(std::time::Duration::from_millis(50)).await;
            if before < times { Err(std::io::Error::other("gone")) } else { Ok("second half") }
        });
        ([(header::CONTENT_TYPE, "text/csv")], Body::from_stream(first.chain(second))).into_response()
    })
}

#[test]
fn a_download_that_breaks_off_begins_again_or_leaves_what_was_there() {
    let stub = breaking(1);
    let shell = Shell::of(&stub.address);
    shell.done(&format!("get {JOB} campbell -o table.csv"));
    assert_eq!(read(&shell.path("table.csv")), "first half, second half");
    assert_eq!(stub.asked().len(), 2);

    let stub = breaking(usize::MAX);
    let shell = Shell::of(&stub.address);
    shell.write("table.csv", "of yesterday");
    let left = shell.run(&format!("get {JOB} campbell -o table.csv --patience 1"));
    assert_eq!(left.code, 6, "{left:?}");
    assert_eq!(read(&shell.path("table.csv")), "of yesterday");
    assert_eq!(files_in(shell.folder.path()), ["table.csv"], "nothing half is left");
    // Printed bytes cannot be taken back, and are not printed again.
    let left = shell.run(&format!("get {JOB} campbell"));
    assert_eq!((left.code, left.out.as_str()), (6, "first half, "), "{left:?}");
}

#[test]
fn files_are_as_files_are_and_what_is_no_file_stays() {
    let stub = breaking(0);
    let shell = Shell::of(&stub.address);
    shell.write("like", "");
    shell.write("target.csv", "");
    std::os::unix::fs::symlink("target.csv", shell.path("link.csv")).unwrap();
    for file in ["new.csv", "link.csv", "/dev/null"] {
        shell.done(&format!("get {JOB} campbell -o {file}"));
    }
    let mode = |name: &str| shell.path(name).metadata().unwrap().permissions().mode();
    assert_eq!(mode("new.csv"), mode("like"));
    assert!(shell.path("link.csv").is_symlink());
    assert_eq!(read(&shell.path("target.csv")), "first half, second half");
    assert!(!std::path::Path::new("/dev/null").is_file());
    for (file, words) in [(".", "it is a folder"), ("none/x.csv", "No such file"), ("/dev/full", "No space")]
    {
        let left = shell.run(&format!("get {JOB} campbell -o {file}"));
        assert!(left.code == 1 && left.err.contains(words), "{file}: {left:?}");
    }
}

#[test]
fn a_full_disk_leaves_nothing() {
    let Some(disk) = SmallDisk::mount(1) else { return };
    let stub = breaking(0);
    let shell = Shell::of(&stub.address);
    std::fs::create_dir(disk.data()).unwrap();
    disk.fill();
    let file = disk.data().join("table.csv");
    let left = shell.run(&format!("get {JOB} campbell -o {}", file.display()));
    assert!(left.code == 1 && left.err.contains("No space left"), "{left:?}");
    assert!(files_in(&disk.data()).is_empty());
}
