//! Build script: takes Plotly's script out of the crate that carries it, and compresses it once for all.

use std::error::Error;
use std::fs::File;
use std::io::Write;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;

/// Opening and closing tag of each script; the first script is Plotly's, the second MathJax, for which the page has no use.
const TAGS: (&str, &str) = ("<script type=\"text/javascript\">", "</script>");

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    let both = plotly::Plot::offline_js_sources();
    let script = both.strip_prefix(TAGS.0).and_then(|rest| rest.split_once(TAGS.1));
    let (script, _) =
        script.filter(|(script, _)| script.contains("plotly.js v")).ok_or("no script of Plotly's")?;
    let file = File::create(Path::new(&std::env::var("OUT_DIR")?).join("plotly.js.gz"))?;
    let mut compressed = GzEncoder::new(file, Compression::best());
    compressed.write_all(script.as_bytes())?;
    compressed.finish()?;
    Ok(())
}
