//! One impeller sector as every computation sees it: cylindrical components, high face eliminated (docs/method.md, Conventions).

use faer::sparse::SparseColMat;
use serde::{Deserialize, Serialize};

/// Consistent units of a model (force = mass·length/time²); the physics never converts them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Unit of length, for example `mm`.
    #[cfg_attr(feature = "schema", schema(max_length = 40))]
    pub length: String,
    /// Unit of force, for example `N`.
    #[cfg_attr(feature = "schema", schema(max_length = 40))]
    pub force: String,
    /// Unit of time, for example `s`.
    #[cfg_attr(feature = "schema", schema(max_length = 40))]
    pub time: String,
    /// Unit of mass, for example `t`.
    #[cfg_attr(feature = "schema", schema(max_length = 40))]
    pub mass: String,
}

/// A sector matrix Y split by the cyclic structure (Eq. 2), both parts over the own DOF.
///
/// The wheel couples sector s to itself by `own` (Y0, with the high face's own block already added on the low
/// face) and to sector s+1 by `next` (Y1, whose non-zero columns are low-face DOF of sector s+1). Mass and stiffness are
/// symmetric, Ŷ(i) = Y0 + Y1 e^{jiα} + Y1ᵀ e^{−jiα}; the gyroscopic matrix is skew-symmetric,
/// Ĝ(i) = G0 + G1 e^{jiα} − G1ᵀ e^{−jiα}.
#[derive(Debug, Clone)]
pub struct CyclicMatrix {
    /// Y0: both triangles stored, `n × n`.
    pub own: SparseColMat<usize, f64>,
    /// Y1: coupling of this sector's rows to the next sector's low-face columns, `n × n`.
    pub next: SparseColMat<usize, f64>,
}

/// A node of the blade tip that may touch the casing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactNode {
    /// Node id in the user's model.
    pub id: u64,
    /// Position in cylindrical coordinates about the axis: radius, angle (rad), axial coordinate.
    pub position: [f64; 3],
    /// Unit normal out of the blade into the casing, in (r, θ, z) components at the node.
    pub normal: [f64; 3],
    /// Rows of its r, θ and z displacement among the own DOF.
    pub dofs: [usize; 3],
}

/// A validated sector: matrices over the own DOF (internal, low face and contact), in (r, θ, z) components.
///
/// Built only by an importer that has checked everything docs/package.md lists.
#[derive(Debug, Clone)]
pub struct SectorModel {
    /// Free text of the user.
    pub name: String,
    /// Number N of identical sectors in the wheel.
    pub sectors: usize,
    /// The package's consistent units.
    pub units: Units,
    /// Consistent mass matrix.
    pub mass: CyclicMatrix,
    /// Stiffness at each speed of `speeds_rad_s`.
    pub stiffness: Vec<CyclicMatrix>,
    /// Gyroscopic matrix G of M ü + Ω G u̇ + K(Ω) u = f in the rotating frame, skew-symmetric; absent if the package has
    /// none. A point mass m in (r, θ) has m(r̈ − 2Ωθ̇), m(θ̈ + 2Ωṙ): `G_rθ` = −2m, `G_θr` = 2m.
    pub gyroscopic: Option<CyclicMatrix>,
    /// Speeds of the stiffness matrices: `[0]` or `[0, Ω1/2, Ω1]`.
    pub speeds_rad_s: Vec<f64>,
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<ContactNode>,
    /// The three DOF of a node, or fewer where some are clamped, grouped node by node: index of the node each
    /// own DOF belongs to (the graph that fill-reducing orderings compress).
    pub node_of_dof: Vec<usize>,
}

impl SectorModel {
    /// Number of own DOF (internal with the low face, and contact).
    pub fn own_dofs(&self) -> usize {
        self.node_of_dof.len()
    }
}
