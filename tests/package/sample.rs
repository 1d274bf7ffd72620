//! Sample package, tiny and good, and the means to change its files.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::io::{Cursor, Read, Write};
use std::path::PathBuf;

use rubmap::dynamics::sector::Units;
use rubmap::package::raw::{Axis, Frame, Manifest, ManifestContact, RawDof, RawMatrix, RawNode, RawPackage};
use rubmap::package::{self, Imported, Limits, PackageError};

/// Reproducible stream of numbers in (−1, 1).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Shape of a sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape {
    pub(crate) sectors: usize,
    pub(crate) frame: Frame,
    pub(crate) origin: [f64; 3],
    pub(crate) direction: [f64; 3],
    /// Components present at the first pair, of 1, 2, 3.
    pub(crate) first_pair: [bool; 3],
    pub(crate) seed: u64,
}

impl Default for Shape {
    fn default() -> Self {
        let [origin, direction] = [[0.0; 3], [0.0, 0.0, 1.0]];
        Self { sectors: 3, frame: Frame::Cylindrical, origin, direction, first_pair: [true; 3], seed: 1 }
    }
}

/// Vector v turned by `angle` about the unit vector `axis` (Rodrigues), independently of the importer's own frames.
pub(crate) fn turn(v: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let dot = (0..3).map(|k| axis[k] * v[k]).sum::<f64>();
    let cross =
        [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]];
    std::array::from_fn(|k| v[k] * angle.cos() + cross[k] * angle.sin() + axis[k] * dot * (1.0 - angle.cos()))
}

pub(crate) fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// Package of the sample. Low nodes 1, 2; contact nodes 3, 4; high nodes 5, 6 (listed 6 first); node 7 clamped. Unassembled high face.
pub(crate) fn package(shape: Shape) -> RawPackage {
    let alpha = TAU / shape.sectors as f64;
    let axis = unit(shape.direction);
    // The helper is any vector off the axis; the importer's zero of θ does not matter for these samples.
    let helper = if axis[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let along: f64 = (0..3).map(|k| helper[k] * axis[k]).sum();
    let radial = unit(std::array::from_fn(|k| helper[k] - along * axis[k]));
    let at = |r: f64, theta: f64, z: f64| {
        let v = turn(radial, axis, theta);
        std::array::from_fn(|k| shape.origin[k] + r * v[k] + z * axis[k])
    };
    let nodes = [
        (1, at(10.0, 0.1, 0.0)),
        (2, at(11.0, 0.1, 5.0)),
        (3, at(12.0, 0.1 + 0.4 * alpha, 0.0)),
        (4, at(13.0, 0.1 + 0.6 * alpha, 5.0)),
        (6, at(11.0, 0.1 + alpha, 5.0)),
        (5, at(10.0, 0.1 + alpha, 0.0)),
        (7, at(5.0, 0.1 + 0.5 * alpha, 0.0)),
    ];
    let dofs: Vec<RawDof> = [1, 2, 3, 4, 6, 5]
        .into_iter()
        .flat_map(|node| (1..=3).map(move |component| RawDof { node, component }))
        .filter(|dof| !matches!(dof.node, 1 | 5) || shape.first_pair[usize::from(dof.component) - 1])
        .collect();
    let mut numbers = Numbers(shape.seed);
    let mut matrix = |scale: f64| {
        let size = dofs.len();
        let mut entries = Vec::new();
        for column in 0..size as u32 {
            entries.push((column, column, scale * (20.0 + numbers.next())));
            entries.extend((column + 1..size as u32).map(|row| (row, column, scale * numbers.next())));
        }
        RawMatrix { size, entries }
    };
    let units = Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() };
    let normal = [0.6, 0.0, -0.8];
    RawPackage {
        mass: matrix(1e-9),
        stiffness: vec![matrix(1e5), matrix(1.1e5), matrix(1.3e5)],
        gyroscopic: None,
        elements: None,
        manifest: Manifest {
            name: "sample".into(),
            sectors: shape.sectors,
            units,
            axis: Axis { origin: shape.origin, direction: shape.direction },
            speeds_rad_s: vec![0.0, 1000.0, 2000.0],
            frame: shape.frame,
            mass: "m.mtx".into(),
            stiffness: vec!["k0.mtx".into(), "k1.mtx".into(), "k2.mtx".into()],
            gyroscopic: None,
            nodes: "nodes.csv".into(),
            dofs: "dofs.csv".into(),
            cyclic: vec![[1, 5], [2, 6]],
            contact: vec![
                ManifestContact { node: 4, normal },
                ManifestContact { node: 3, normal: [0.0, 0.0, 1.0] },
            ],
            mesh: None,
        },
        nodes: nodes.into_iter().map(|(id, position)| RawNode { id, position }).collect(),
        dofs,
    }
}

/// Package with a random gyroscopic matrix in `g.mtx`.
pub(crate) fn with_gyroscopic(mut package: RawPackage, seed: u64) -> RawPackage {
    let mut numbers = Numbers(seed);
    let size = package.dofs.len();
    let below = |column: u32| (column + 1..size as u32).map(move |row| (row, column));
    let entries = (0..size as u32).flat_map(below).map(|(row, column)| (row, column, 1e-9 * numbers.next()));
    package.gyroscopic = Some(RawMatrix { size, entries: entries.collect() });
    package.manifest.gyroscopic = Some("g.mtx".into());
    package
}

/// Package as files, in a form that tests can spoil.
#[derive(Debug, Clone)]
pub(crate) struct Files(pub(crate) BTreeMap<String, Vec<u8>>);

impl Files {
    pub(crate) fn of(package: &RawPackage) -> Self {
        let mut bytes = Cursor::new(Vec::new());
        package::write(package, &mut bytes).expect("a package that can be written");
        Self::unzip(&bytes.into_inner())
    }

    pub(crate) fn good() -> Self {
        Self::of(&package(Shape::default()))
    }

    pub(crate) fn unzip(bytes: &[u8]) -> Self {
        let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).expect("a zip");
        let names: Vec<String> = zip.file_names().map(|name| name.expect("a name").into_owned()).collect();
        let mut read = |name: &str| {
            let mut content = Vec::new();
            zip.by_name(name).expect("present").read_to_end(&mut content).expect("readable");
            content
        };
        Self(names.into_iter().map(|name| (name.clone(), read(&name))).collect())
    }

    pub(crate) fn text(&self, name: &str) -> String {
        String::from_utf8(self.0[name].clone()).expect("text")
    }

    pub(crate) fn put(&mut self, name: &str, content: impl Into<Vec<u8>>) {
        self.0.insert(name.to_owned(), content.into());
    }

    /// Replaces the first occurrence of a text, which must exist.
    pub(crate) fn replace(&mut self, name: &str, from: &str, to: &str) {
        let text = self.text(name);
        assert!(text.contains(from), "{name} does not contain {from:?}:\n{text}");
        self.put(name, text.replacen(from, to, 1));
    }

    /// Replaces a line, counted from 1.
    pub(crate) fn line(&mut self, name: &str, number: usize, line: &str) {
        let text = self.text(name);
        let mut lines: Vec<&str> = text.lines().collect();
        lines[number - 1] = line;
        self.put(name, lines.join("\n"));
    }

    /// Changes `sector.json` as a JSON value.
    pub(crate) fn json(&mut self, change: impl FnOnce(&mut serde_json::Value)) {
        let mut value = serde_json::from_slice(&self.0["sector.json"]).expect("JSON");
        change(&mut value);
        self.put("sector.json", value.to_string());
    }

    pub(crate) fn zip(&self, method: zip::CompressionMethod) -> Vec<u8> {
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, content) in &self.0 {
            let options = zip::write::SimpleFileOptions::default().compression_method(method);
            zip.start_file(name, options).expect("a name");
            zip.write_all(content).expect("in memory");
        }
        zip.finish().expect("in memory").into_inner()
    }

    pub(crate) fn import(&self) -> Result<Imported, PackageError> {
        import(&self.zip(zip::CompressionMethod::Deflated))
    }
}

/// Imports a package from its bytes.
pub(crate) fn import(bytes: &[u8]) -> Result<Imported, PackageError> {
    import_within(bytes, &Limits::default())
}

pub(crate) fn import_within(bytes: &[u8], limits: &Limits) -> Result<Imported, PackageError> {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(bytes).expect("written");
    package::read(file.path(), limits)
}

/// Folder of the shared models, if this machine has it.
pub(crate) fn shared_models() -> Option<PathBuf> {
    let beside = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared"));
    let shared = std::env::var_os("RUBMAP_SHARED").map_or(beside, PathBuf::from).join("models");
    shared.is_dir().then_some(shared)
}
