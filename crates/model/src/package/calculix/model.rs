//! Options of an import.

use std::path::PathBuf;

use crate::package::raw::Axis;
use rubmap_wheel::dynamics::sector::Units;

/// Import request: the files, and options that the deck leaves open.
#[derive(Debug, Clone)]
pub struct CalculixModel {
    /// Path of the deck with the mesh and its node sets.
    pub deck: PathBuf,
    /// Job whose `.dof`, `.mas` and `.sti` are those at rest: their path without extension.
    pub rest: PathBuf,
    /// Speeds in rad/s, ascending, and the jobs whose `.dof` and `.sti` are those at speed.
    pub at_speed: Vec<(f64, PathBuf)>,
    /// Whether the matrices are those of the whole wheel instead of one sector.
    pub whole_wheel: bool,
    /// Number of sectors N; from `*CYCLIC SYMMETRY MODEL` if absent.
    pub sectors: Option<usize>,
    /// Axis of rotation; from `*CYCLIC SYMMETRY MODEL` if absent, else the z axis.
    pub axis: Option<Axis>,
    /// Node set of the low face; from the cyclic tie if absent. A single sector (N = 1) needs no faces.
    pub low_set: Option<String>,
    /// Node set of the high face; from the cyclic tie if absent. Not needed for a whole wheel.
    pub high_set: Option<String>,
    /// Node set along the blade tip.
    pub contact_set: String,
    /// Number of nodes of the contact set to be used, evenly spaced; all if absent.
    pub contact_count: Option<usize>,
    /// Whether to keep the order in which the deck lists the contact set, instead of that along the chord.
    pub contact_as_listed: bool,
    /// Source of the contact normals.
    pub normals: Normals,
    /// Whether the package gets the gyroscopic matrix that its mass implies.
    pub gyroscopic: bool,
    /// JSON file of strengths by material or element set; without it the package has none.
    pub strengths: Option<PathBuf>,
    /// Consistent units of the deck.
    pub units: Units,
    /// Name of the model.
    pub name: String,
}

/// Source of the contact nodes' normals.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Normals {
    /// Meridional curve through the contact nodes themselves.
    ContactNodes,
    /// File of the casing's meridional curve, lines `r,z`.
    Meridian(PathBuf),
    /// File of normals, lines `node,nx,ny,nz`, Cartesian.
    Table(PathBuf),
}
