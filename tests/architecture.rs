//! What must not be there, is not there: the invariants at the top of `lib.rs`, as far as a search can tell.

use std::path::{Path, PathBuf};

/// Files of a module that contain one of `words`.
fn offenders(module: &str, words: &[&str]) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut waiting = vec![root.join(module)];
    let mut found = Vec::new();
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            waiting.extend(std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
        } else if words.iter().any(|word| std::fs::read_to_string(&path).unwrap().contains(word)) {
            found.push(path);
        }
    }
    found
}

#[test]
fn physics_knows_no_service() {
    for module in ["numerics", "dynamics", "response", "analysis", "impeller", "package"] {
        let service = ["axum", "sqlx", "tokio", "async fn", "std::env::", "chrono::", "apalis", "SystemTime"];
        assert_eq!(offenders(module, &service), [""; 0].map(PathBuf::from), "{module}");
    }
}

#[test]
fn arrows_point_one_way() {
    for (module, later) in [
        (
            "numerics",
            &["crate::dynamics", "crate::response", "crate::analysis", "crate::package", "crate::impeller"][..],
        ),
        ("dynamics", &["crate::response", "crate::analysis", "crate::package", "crate::impeller"]),
        ("response", &["crate::analysis", "crate::package", "crate::impeller"]),
        (
            "package",
            &[
                "crate::response",
                "crate::analysis",
                "crate::impeller",
                "crate::store",
                "crate::jobs",
                "crate::http",
            ],
        ),
        ("impeller", &["crate::response", "crate::analysis", "crate::store", "crate::jobs", "crate::http"]),
        ("analysis", &["crate::store", "crate::jobs", "crate::http", "crate::package", "crate::impeller"]),
        ("store", &["crate::jobs", "crate::http"]),
        ("jobs", &["crate::http"]),
        ("http", &["crate::app"]),
    ] {
        assert_eq!(offenders(module, later), [""; 0].map(PathBuf::from), "{module}");
    }
}

#[test]
fn only_the_store_has_sql_and_only_http_has_status_codes() {
    for module in ["jobs", "http", "app.rs", "config.rs", "cli", "main.rs"] {
        assert_eq!(offenders(module, &["sqlx"]), [""; 0].map(PathBuf::from), "{module}");
    }
    for module in ["store", "jobs", "app.rs", "config.rs"] {
        assert_eq!(offenders(module, &["StatusCode"]), [""; 0].map(PathBuf::from), "{module}");
    }
}

#[test]
fn http_computes_nothing() {
    let verbs = [
        "run::prepare",
        "run::check",
        "run::run_speed",
        "run::modal_analysis",
        "run::critical_speeds",
        "run::plan",
    ];
    assert_eq!(offenders("http", &verbs), [""; 0].map(PathBuf::from));
}
