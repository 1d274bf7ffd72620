//! Settings of a model that is made from a mesh: all that the file does not say.

use std::collections::BTreeMap;

use rubmap_solid::material::Material;
use rubmap_solid::rule::MassRule;
use rubmap_wheel::dynamics::sector::Units;
use serde::{Deserialize, Serialize};

use crate::package::raw::Axis;

/// Number of contact nodes along the tip, unless another is asked for.
const CONTACT_NODES: usize = 10;

/// Settings of a model that is made from a mesh. The top speed has no default; everything else is read from the file or found from its
/// geometry where it is left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct MeshSettings {
    /// Name of the mesh file in a package; left out beside a bare mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh_file: Option<String>,
    /// Name of the model; that of the file if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Consistent units of the file (mm, N, s, t if left out).
    #[serde(default = "default_units")]
    pub units: Units,
    /// Highest speed Ω1 of the stiffness matrices, rad/s.
    pub top_speed_rad_s: f64,
    /// Number of sectors N; found from the cyclic faces if left out. A single blade on a rigid disk has 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sectors: Option<usize>,
    /// Axis of rotation; stated by the file or found from the cyclic faces if left out, with the largest component of its direction positive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(value_type = Object))]
    pub axis: Option<Axis>,
    /// Materials by element set or by material of the file; `*` is for all elements. They replace those of the file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[cfg_attr(feature = "schema", schema(value_type = Object))]
    pub materials: BTreeMap<String, Material>,
    /// Temperature by element set or by material of the file, `*` for all: where the file tabulates a material over temperature.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub temperatures: BTreeMap<String, f64>,
    /// Node set of the clamp. If left out, the nodes that the file holds are clamped, and if it holds none, those of the bore.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clamp_set: Option<String>,
    /// Nodes of the smooth patches of the skin that are clamped, instead of a set: of each patch a node away from its edges, or all corners of
    /// one of its faces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub clamp_at: Vec<u64>,
    /// Node set along the blade's tip, a line of nodes or the whole tip; found as the longest tip if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_set: Option<String>,
    /// Nodes between which the contact line runs along the sharp edges of the skin, instead of a set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_between: Option<[u64; 2]>,
    /// Node of the smooth patch of the skin that is the tip, away from its edges, instead of a set; or all corners of one of its faces. The
    /// contact line runs in the middle of its thickness.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contact_at: Vec<u64>,
    /// Curve of the shroud as points [r, z] from the axis, in the units of the mesh: the tip that is nearest to it has the contact line, instead
    /// of a set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shroud: Option<Vec<[f64; 2]>>,
    /// Largest number of contact nodes, evenly spaced.
    #[serde(default = "default_contact_nodes")]
    pub contact_nodes: usize,
    /// Rule by which mass is integrated.
    #[serde(default)]
    pub mass: MassRule,
    /// Whether the model has the gyroscopic matrix that Coriolis forces need.
    #[serde(default = "default_gyroscopic")]
    pub gyroscopic: bool,
}

fn default_units() -> Units {
    Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() }
}

fn default_contact_nodes() -> usize {
    CONTACT_NODES
}

fn default_gyroscopic() -> bool {
    true
}

impl MeshSettings {
    /// Settings with a top speed in rad/s and nothing else.
    pub fn new(top_speed_rad_s: f64) -> Self {
        Self {
            mesh_file: None,
            name: None,
            units: default_units(),
            top_speed_rad_s,
            sectors: None,
            axis: None,
            materials: BTreeMap::new(),
            temperatures: BTreeMap::new(),
            clamp_set: None,
            clamp_at: Vec::new(),
            contact_set: None,
            contact_between: None,
            contact_at: Vec::new(),
            shroud: None,
            contact_nodes: CONTACT_NODES,
            mass: MassRule::default(),
            gyroscopic: true,
        }
    }

    /// Settings of a look at a mesh from JSON: those of a model, of which the top speed may be left out.
    ///
    /// # Errors
    /// Text that is no object of settings.
    pub fn of_look(text: &[u8]) -> serde_json::Result<Self> {
        let mut fields: serde_json::Map<String, serde_json::Value> = serde_json::from_slice(text)?;
        fields.entry("top_speed_rad_s").or_insert_with(|| 0.0.into());
        serde_json::from_value(fields.into())
    }
}
