//! Page in the browser, as it is served.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use flate2::read::GzDecoder;
use rubmap::tokens::{Scope, new_token};

use super::app::{Api, TestApp};

/// Addresses of our own files with their content.
fn own_files() -> BTreeMap<String, Vec<u8>> {
    fn add(folder: &Path, address: &str, files: &mut BTreeMap<String, Vec<u8>>) {
        for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let address = format!("{address}/{}", entry.file_name().to_str().unwrap());
            if entry.file_type().unwrap().is_dir() {
                add(&entry.path(), &address, files);
            } else {
                files.insert(address, std::fs::read(entry.path()).unwrap());
            }
        }
    }
    let mut files = BTreeMap::new();
    add(&Path::new(env!("CARGO_MANIFEST_DIR")).join("web"), "/page", &mut files);
    files
}

/// Whole answer: status, headers and bytes.
struct Whole {
    status: u16,
    headers: reqwest::header::HeaderMap,
    body: Vec<u8>,
}

impl Whole {
    async fn of(api: &Api, method: &str, path: &str, header: (&str, &str)) -> Self {
        let answer = api.request(method, path).header(header.0, header.1).send().await.unwrap();
        let (status, headers) = (answer.status().as_u16(), answer.headers().clone());
        Self { status, headers, body: answer.bytes().await.unwrap().into() }
    }

    fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", |value| value.to_str().unwrap())
    }
}

/// Path at which the page says that Plotly's script is.
async fn script_of(api: &Api) -> String {
    let index = Whole::of(api, "GET", "/", ("accept", "*/*")).await;
    let index = String::from_utf8(index.body).unwrap();
    let (_, rest) = index.split_once("<meta name=\"plotly\" content=\"").unwrap();
    rest.split_once('"').unwrap().0.to_owned()
}

#[tokio::test]
async fn the_page_is_what_lies_in_its_folder() {
    let app = TestApp::start().await;
    let api = &app.api;
    let files = own_files();
    for (address, content) in &files {
        if address == "/page/index.html" {
            continue;
        }
        let kind = match address.rsplit_once('.').unwrap().1 {
            "js" => "text/javascript; charset=utf-8",
            "css" => "text/css; charset=utf-8",
            "svg" => "image/svg+xml",
            other => panic!("what is a file {other}?"),
        };
        let plain = Whole::of(api, "GET", address, ("accept-encoding", "identity")).await;
        assert_eq!((plain.status, plain.header("content-type")), (200, kind), "{address}");
        assert_eq!((&plain.body, plain.header("content-encoding")), (content, ""), "{address}");
        let gzipped = Whole::of(api, "GET", address, ("accept-encoding", "gzip")).await;
        assert_eq!(gzipped.header("content-encoding"), "gzip");
        let mut unpacked = Vec::new();
        GzDecoder::new(&gzipped.body[..]).read_to_end(&mut unpacked).unwrap();
        assert_eq!(&unpacked, content, "{address}");
    }
    // Everything that the index names is there.
    let index = Whole::of(api, "GET", "/", ("accept", "*/*")).await;
    assert_eq!((index.status, index.header("content-type")), (200, "text/html; charset=utf-8"));
    let index = String::from_utf8(index.body).unwrap();
    let script = script_of(api).await;
    assert_eq!(index.replace(&script, "{{plotly}}").as_bytes(), files["/page/index.html"]);
    for part in index.split(['"', '\'']).filter(|part| part.starts_with("/page/")) {
        assert_eq!(Whole::of(api, "HEAD", part, ("accept", "*/*")).await.status, 200, "{part}");
    }
    app.stop().await;
}

#[tokio::test]
async fn plotly_s_script_is_sent_once_and_compressed() {
    let app = TestApp::start().await;
    let api = &app.api;
    let address = script_of(api).await;
    let gzipped = Whole::of(api, "GET", &address, ("accept-encoding", "gzip, br")).await;
    assert_eq!(gzipped.header("cache-control"), "public, max-age=31536000, immutable");
    assert_eq!(gzipped.header("content-encoding"), "gzip");
    assert!(gzipped.body.len() < 1_600_000, "{} bytes", gzipped.body.len());
    let plain = Whole::of(api, "GET", &address, ("accept-encoding", "identity")).await;
    assert!(plain.body.starts_with(b"/**\n* plotly.js v"));
    // It holds one script, not the one behind it.
    assert!(!plain.body.windows(8).any(|part| part == b"</script"));
    let mut unpacked = Vec::new();
    GzDecoder::new(&gzipped.body[..]).read_to_end(&mut unpacked).unwrap();
    assert!(unpacked == plain.body);
    app.stop().await;
}

#[tokio::test]
async fn browsers_are_told_what_the_page_may_do_and_what_they_have_already() {
    let app = TestApp::start().await;
    let api = &app.api;
    for address in ["/".to_owned(), "/page/app.js".to_owned(), script_of(api).await] {
        let first = Whole::of(api, "GET", &address, ("accept-encoding", "gzip")).await;
        let tag = first.header("etag").to_owned();
        let again = Whole::of(api, "GET", &address, ("if-none-match", &tag)).await;
        let head = Whole::of(api, "HEAD", &address, ("accept-encoding", "gzip")).await;
        assert_eq!((first.status, again.status, head.status), (200, 304, 200), "{address}");
        assert!(again.body.is_empty() && head.body.is_empty());
        assert_eq!(head.header("content-length"), first.body.len().to_string(), "{address}");
        for answer in [&first, &again, &head] {
            assert_eq!(answer.header("etag"), tag);
            assert_eq!(answer.headers.get_all("vary").iter().collect::<Vec<_>>(), ["accept-encoding"]);
            let policy = answer.header("content-security-policy");
            assert!(policy.starts_with("default-src 'none'; script-src 'self';"), "{policy}");
            assert!(!policy.contains("unsafe-inline") && !policy.contains("unsafe-eval"));
            assert_eq!(answer.header("x-content-type-options"), "nosniff");
            assert_eq!(answer.header("referrer-policy"), "no-referrer");
            assert_eq!(answer.header("cross-origin-opener-policy"), "same-origin");
        }
        let checked =
            if address.contains("plotly") { "public, max-age=31536000, immutable" } else { "no-cache" };
        assert_eq!(first.header("cache-control"), checked);
    }
    app.stop().await;
}

#[tokio::test]
async fn the_page_needs_no_token_and_the_rest_does() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tokens");
    new_token(&file, "alice", Scope::Read).unwrap();
    let app = TestApp::start_with(|config| config.tokens = Some(file)).await;
    for (path, status) in [
        ("/", 200),
        ("/page/app.js", 200),
        ("/page/nothing.js", 404),
        ("/page/", 404),
        ("/page/../v1/jobs", 401),
        ("/page/..%2F..%2FCargo.toml", 404),
        ("/page/index.html", 404),
        ("/page", 401),
        ("/v1/jobs", 401),
        ("/openapi.json", 401),
    ] {
        assert_eq!(Whole::of(&app.api, "GET", path, ("accept", "*/*")).await.status, status, "{path}");
    }
    app.api.get("/page/nothing.js").await.problem(404, "not-found");
    let wrong = Whole::of(&app.api, "POST", "/", ("accept", "*/*")).await;
    assert_eq!((wrong.status, wrong.header("allow")), (405, "GET,HEAD"));
    app.stop().await;
}
