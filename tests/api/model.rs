//! Small wheel as a package: springs and masses, quick to reduce and to integrate.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use serde_json::{Value, json};

/// Number of sectors of the wheel.
pub(crate) const SECTORS: u32 = 4;

/// Number of nodes of a sector: low face, inner, two contact nodes, high face.
const NODES: usize = 5;
const LOW: usize = 0;
const INNER: usize = 1;
const LEADING: usize = 2;
const TRAILING: usize = 3;
const HIGH: usize = 4;

/// Package of the wheel. Every sector hangs on the ground by its inner node and on its neighbours by the faces; the
/// springs pull alike in r, θ and z. `scale` multiplies the stiffness: another scale, another model.
pub(crate) fn package(scale: f64) -> Vec<u8> {
    zip(&files(scale), 6)
}

/// Package of the wheel with the same content, zipped otherwise.
pub(crate) fn package_stored(scale: f64) -> Vec<u8> {
    zip(&files(scale), 0)
}

/// Package with stiffness at three speeds through which no sound K(Ω) leads: a hundredth of that at rest at 500 rad/s, all of it at 1000.
pub(crate) fn deformed_package() -> Vec<u8> {
    let mut files = files(1.0);
    let mut manifest: Value = serde_json::from_str(&files[0].1).unwrap();
    manifest["speeds_rad_s"] = json!([0.0, 500.0, 1000.0]);
    manifest["stiffness"] = json!(["k0.mtx", "k1.mtx", "k2.mtx"]);
    files[0].1 = manifest.to_string();
    for (name, scale) in [("k1.mtx", 0.01), ("k2.mtx", 1.0)] {
        files.push((name, self::files(scale).pop().unwrap().1));
    }
    zip(&files, 6)
}

/// Package with `spoil` applied to its `sector.json`.
pub(crate) fn spoilt_package(spoil: impl FnOnce(&mut Value)) -> Vec<u8> {
    let mut files = files(1.0);
    let mut manifest = serde_json::from_str(&files[0].1).unwrap();
    spoil(&mut manifest);
    files[0].1 = manifest.to_string();
    zip(&files, 6)
}

/// Package with a node 6 that has no DOF.
pub(crate) fn package_with_a_clamped_node() -> Vec<u8> {
    let mut files = files(1.0);
    files[1].1.push_str("6,41,38,0\n");
    zip(&files, 6)
}

/// Names in a folder, sorted.
pub(crate) fn files_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn files(scale: f64) -> Vec<(&'static str, String)> {
    let manifest = json!({
        "name": "springs",
        "sectors": SECTORS,
        "units": {"length": "mm", "force": "N", "time": "s", "mass": "t"},
        "axis": {"origin": [0.0, 0.0, 0.0], "direction": [0.0, 0.0, 1.0]},
        "speeds_rad_s": [0.0],
        "frame": "cylindrical",
        "mass": "m.mtx",
        "stiffness": ["k0.mtx"],
        "nodes": "nodes.csv",
        "dofs": "dofs.csv",
        "cyclic": [[1, 5]],
        "contact": [
            {"node": 3, "normal": [1.0, 0.0, 0.0]},
            {"node": 4, "normal": [1.0, 0.0, 0.0]},
        ],
    });
    // A quarter turn takes node 1 to node 5.
    let nodes = "1,50,0,0\n2,40,40,0\n3,45,45,0\n4,45,45,10\n5,0,50,0\n".to_owned();
    let mut dofs = String::new();
    for node in 1..=NODES {
        for component in 1..=3 {
            writeln!(dofs, "{node},{component}").unwrap();
        }
    }
    let mut stiffness = [[0.0; NODES]; NODES];
    let mut spring = |a: usize, b: usize, k: f64| {
        stiffness[a][a] += k;
        stiffness[b][b] += k;
        stiffness[a][b] -= k;
        stiffness[b][a] -= k;
    };
    spring(INNER, LOW, 300.0 * scale);
    spring(INNER, HIGH, 300.0 * scale);
    spring(INNER, LEADING, 200.0 * scale);
    spring(INNER, TRAILING, 220.0 * scale);
    spring(LEADING, TRAILING, 50.0 * scale);
    stiffness[INNER][INNER] += 150.0 * scale;
    let mut mass = [[0.0; NODES]; NODES];
    for (node, m) in [(LOW, 2e-5), (INNER, 2e-5), (LEADING, 1e-5), (TRAILING, 1e-5)] {
        mass[node][node] = m;
    }
    vec![
        ("sector.json", manifest.to_string()),
        ("nodes.csv", nodes),
        ("dofs.csv", dofs),
        ("m.mtx", matrix_market(&mass)),
        ("k0.mtx", matrix_market(&stiffness)),
    ]
}

/// Matrix Market text of one 3×3 multiple of the identity per pair of nodes, lower triangle.
fn matrix_market(by_node: &[[f64; NODES]; NODES]) -> String {
    let mut entries = Vec::new();
    for (row, values) in by_node.iter().enumerate() {
        for (column, value) in values.iter().enumerate().take(row + 1).filter(|(_, value)| **value != 0.0) {
            for component in 1..=3 {
                entries.push((3 * row + component, 3 * column + component, value));
            }
        }
    }
    let size = 3 * NODES;
    let mut text =
        format!("%%MatrixMarket matrix coordinate real symmetric\n{size} {size} {}\n", entries.len());
    for (row, column, value) in entries {
        writeln!(text, "{row} {column} {value:e}").unwrap();
    }
    text
}

pub(crate) fn zip(files: &[(&str, String)], level: i64) -> Vec<u8> {
    let method = if level == 0 { zip::CompressionMethod::Stored } else { zip::CompressionMethod::Deflated };
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(method)
        .compression_level((level > 0).then_some(level));
    let mut writer = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, text) in files {
        writer.start_file(*name, options).unwrap();
        writer.write_all(text.as_bytes()).unwrap();
    }
    writer.finish().unwrap().into_inner()
}
