//! Content of a package as its files state it, before any check: what readers produce and writers consume.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use rubmap_solid::element::ElementKind;
use rubmap_solid::material::Material;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::quote::quoted;
use rubmap_wheel::dynamics::sector::Units;

/// Most characters of the model's name, and of a file's.
pub(super) const LONGEST_NAME: usize = 200;

/// Content of `sector.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Name of the model, free text of at most 200 characters.
    pub name: String,
    /// Number of identical sectors N ≥ 1.
    pub sectors: usize,
    /// Consistent units of length, force, time and mass.
    pub units: Units,
    /// Axis of rotation.
    pub axis: Axis,
    /// Speeds of the stiffness matrices, ascending from 0: one or three.
    pub speeds_rad_s: Vec<f64>,
    /// Frame of DOF components and contact normals.
    pub frame: Frame,
    /// File name of the mass matrix.
    pub mass: String,
    /// File names of the stiffness matrices, one per speed.
    pub stiffness: Vec<String>,
    /// File name of the gyroscopic matrix, if the package has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gyroscopic: Option<String>,
    /// File name of the node table.
    pub nodes: String,
    /// File name of the DOF table.
    pub dofs: String,
    /// Pairs `[low node, high node]`.
    pub cyclic: Vec<[u64; 2]>,
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<ManifestContact>,
    /// Elements, if the package has them: without them there is no stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<ManifestMesh>,
}

/// Elements that the matrices were made of, and their materials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestMesh {
    /// File name of the element table.
    pub elements: String,
    /// Material of each element set.
    #[serde(deserialize_with = "each_set_once")]
    pub sets: BTreeMap<String, Material>,
}

/// Reads a map and refuses repeated keys: it must not be guessed which of two materials of one set holds.
fn each_set_once<'de, D: serde::Deserializer<'de>>(from: D) -> Result<BTreeMap<String, Material>, D::Error> {
    struct Sets;
    impl<'de> Visitor<'de> for Sets {
        type Value = BTreeMap<String, Material>;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a material for each element set")
        }
        fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
            let mut sets = BTreeMap::new();
            while let Some(name) = entries.next_key::<String>()? {
                let material = entries.next_value()?;
                if sets.contains_key(&name) {
                    let message = format!("the set \"{}\" has two materials; give it one", quoted(&name));
                    return Err(A::Error::custom(message));
                }
                sets.insert(name, material);
            }
            Ok(sets)
        }
    }
    from.deserialize_map(Sets)
}

impl Manifest {
    /// Renames the matrix files, so that [`write`](super::write()) stores them in `format`.
    pub fn store_matrices_as(&mut self, format: MatrixFormat) {
        for name in std::iter::once(&mut self.mass).chain(&mut self.stiffness).chain(&mut self.gyroscopic) {
            let plain = name.strip_suffix(".gz").unwrap_or(name);
            let stem = plain.strip_suffix(MatrixFormat::of(plain).extension()).unwrap_or(plain);
            *name = format!("{stem}{}", format.extension());
        }
    }
}

/// Format in which a matrix is stored; the extension of its file decides it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum MatrixFormat {
    /// Matrix Market text: readable everywhere, large.
    Mtx,
    /// Arrays as `scipy.sparse.save_npz` writes them: compact, exact, fast.
    Npz,
}

impl MatrixFormat {
    /// Format of a file of this name: `.npz` or `.npz.gz`, otherwise Matrix Market.
    pub(super) fn of(name: &str) -> Self {
        let plain = name.strip_suffix(".gz").unwrap_or(name);
        if plain.ends_with(Self::Npz.extension()) { Self::Npz } else { Self::Mtx }
    }

    fn extension(self) -> &'static str {
        match self {
            Self::Mtx => ".mtx",
            Self::Npz => ".npz",
        }
    }
}

/// Axis of rotation; rotation is positive about `direction`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Point on the axis.
    pub origin: [f64; 3],
    /// Direction of the axis, of any length.
    pub direction: [f64; 3],
}

/// Frame of DOF components and contact normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Frame {
    /// Global Cartesian frame x, y, z.
    Cartesian,
    /// Local cylindrical frame r, θ, z of each node about the axis.
    Cylindrical,
}

impl Frame {
    /// Name of the frame in `sector.json`.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Cartesian => "cartesian",
            Self::Cylindrical => "cylindrical",
        }
    }
}

/// Contact node of `sector.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestContact {
    /// Id of the node.
    pub node: u64,
    /// Outward unit normal in the package's frame.
    pub normal: [f64; 3],
}

/// Line of the node table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RawNode {
    /// Id of the node.
    pub id: u64,
    /// Cartesian position.
    pub position: [f64; 3],
}

/// Line of the DOF table: the unknown of one matrix row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RawDof {
    /// Id of the node.
    pub node: u64,
    /// Component 1, 2 or 3 in the package's frame.
    pub component: u8,
}

/// Line of the element table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawElement {
    /// Number of the element.
    pub id: u64,
    /// Type of the element.
    pub kind: ElementKind,
    /// Name of the element's set.
    pub set: Arc<str>,
    /// Ids of the element's nodes, in CalculiX's order.
    pub nodes: Box<[u64]>,
}

/// Entries of a symmetric or skew-symmetric matrix: the lower triangle (of a skew-symmetric one without its diagonal,
/// which is zero), 0-based, each position once.
#[derive(Debug, Clone, PartialEq)]
pub struct RawMatrix {
    /// Number of rows (= columns).
    pub size: usize,
    /// Entries `(row, column, value)` with row ≥ column.
    pub entries: Vec<(u32, u32, f64)>,
}

/// Content of a package, with all its files.
#[derive(Debug, Clone, PartialEq)]
pub struct RawPackage {
    /// Content of `sector.json`.
    pub manifest: Manifest,
    /// Node table.
    pub nodes: Vec<RawNode>,
    /// DOF table, in matrix row order.
    pub dofs: Vec<RawDof>,
    /// Mass matrix.
    pub mass: RawMatrix,
    /// Stiffness matrices, in the order of the speeds.
    pub stiffness: Vec<RawMatrix>,
    /// Gyroscopic matrix G per unit speed, skew-symmetric.
    pub gyroscopic: Option<RawMatrix>,
    /// Element table.
    pub elements: Option<Vec<RawElement>>,
}
