//! Impeller sector as every computation sees it: cylindrical components, high face eliminated (docs/method.md, Conventions).

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

/// Sector matrix Y split by the cyclic structure (Eq. 2), both parts over the own DOF.
///
/// The wheel couples sector s to itself by `own` (Y0, with the high face's own block already added on the low
/// face) and to sector s+1 by `next` (Y1, whose non-zero columns are low-face DOF of sector s+1). Mass and stiffness are
/// symmetric, Ŷ(i) = Y0 + Y1 e^{jiα} + Y1ᵀ e^{−jiα}; the gyroscopic matrix is skew-symmetric,
/// Ĝ(i) = G0 + G1 e^{jiα} − G1ᵀ e^{−jiα}.
#[derive(Debug, Clone)]
pub struct CyclicMatrix {
    /// Matrix Y0: both triangles stored, `n × n`.
    pub own: SparseColMat<usize, f64>,
    /// Matrix Y1: coupling of this sector's rows to the next sector's low-face columns, `n × n`.
    pub next: SparseColMat<usize, f64>,
}

/// Node of the blade tip that may touch the casing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactNode {
    /// Node id in the user's model.
    pub id: u64,
    /// Position in cylindrical coordinates about the axis: radius, angle (rad), axial coordinate.
    pub position: [f64; 3],
    /// Unit normal out of the blade into the casing, in (r, θ, z) components at the node.
    pub normal: [f64; 3],
    /// Rows of the node's r, θ and z displacement among the own DOF.
    pub dofs: [usize; 3],
}

/// Node on the axis of several sectors: one point that they share, with one displacement.
///
/// Nodal diameter 0 leaves the axial direction of it, nodal diameter 1 a wave across the axis (both directions where there are two sectors),
/// and any other nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisNode {
    /// Row of the displacement along the axis among the own DOF; none where clamped.
    pub axial: Option<usize>,
    /// Rows of the displacements along two directions across the axis, the second +90° about the axis from the first; none where clamped.
    pub lateral: [Option<usize>; 2],
}

impl AxisNode {
    /// Rows of the free displacements: along the axis, then across it.
    pub(crate) fn rows(&self) -> [Option<usize>; 3] {
        [self.axial, self.lateral[0], self.lateral[1]]
    }
}

/// Parts of a sector: matrices over the own DOF (internal, low face and contact), in (r, θ, z) components.
#[derive(Debug, Clone)]
pub struct SectorParts {
    /// Name of the model: free text of the user.
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
    /// Nodes on the axis; with one sector they are nodes like others.
    pub axis: Vec<AxisNode>,
    /// Index of the node that each own DOF belongs to (the graph that fill-reducing orderings compress): the three DOF of a node, or fewer
    /// where some are clamped, grouped node by node.
    pub node_of_dof: Vec<usize>,
}

/// Sector whose parts fit together; they can be read, not changed. Further conditions on its numbers (symmetric, positive) an importer has
/// checked: everything docs/package.md lists.
#[derive(Debug, Clone)]
pub struct SectorModel(SectorParts);

/// Reason why parts make no sector.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UnsoundSector {
    /// Wheel without sectors.
    #[error("a wheel has at least one sector")]
    NoSectors,
    /// Sector without contact nodes: nothing could ever touch.
    #[error("a sector has at least one contact node")]
    NoContactNodes,
    /// Speeds other than `[0]` or `[0, Ω1/2, Ω1]`, or not as many as stiffness matrices.
    #[error(
        "{matrices} stiffness matrices at the speeds {speeds_rad_s:?} rad/s: give one at rest, or three at 0, Ω/2 and Ω"
    )]
    Speeds {
        /// Number of stiffness matrices.
        matrices: usize,
        /// Speeds of the matrices, rad/s.
        speeds_rad_s: Vec<f64>,
    },
    /// Matrix of another size than the number of DOF.
    #[error("a matrix has {rows} rows and {columns} columns, the sector {dofs} degrees of freedom")]
    Size {
        /// Number of rows of the matrix.
        rows: usize,
        /// Number of columns of the matrix.
        columns: usize,
        /// Number of own DOF of the sector.
        dofs: usize,
    },
    /// Node on the axis whose displacement is not among the DOF.
    #[error("a node on the axis has degree of freedom {dof}, the sector those below {dofs}")]
    AxisDof {
        /// Row of the displacement.
        dof: usize,
        /// Number of own DOF of the sector.
        dofs: usize,
    },
    /// Contact node whose displacement is not among the DOF.
    #[error("contact node {id} has degree of freedom {dof}, the sector those below {dofs}")]
    ContactDof {
        /// Id of the node.
        id: u64,
        /// Row of the displacement.
        dof: usize,
        /// Number of own DOF of the sector.
        dofs: usize,
    },
}

impl SectorModel {
    /// Builds a sector from parts that fit together.
    ///
    /// # Errors
    /// [`UnsoundSector`] names the parts that do not fit.
    pub fn new(parts: SectorParts) -> Result<Self, UnsoundSector> {
        if parts.sectors == 0 {
            return Err(UnsoundSector::NoSectors);
        }
        if parts.contact.is_empty() {
            return Err(UnsoundSector::NoContactNodes);
        }
        let speeds_fit = match parts.speeds_rad_s[..] {
            [rest] => rest == 0.0,
            [rest, half, full] => rest == 0.0 && rest < half && half < full && full.is_finite(),
            _ => false,
        };
        if !speeds_fit || parts.stiffness.len() != parts.speeds_rad_s.len() {
            let (matrices, speeds_rad_s) = (parts.stiffness.len(), parts.speeds_rad_s);
            return Err(UnsoundSector::Speeds { matrices, speeds_rad_s });
        }
        let dofs = parts.node_of_dof.len();
        let matrices = parts.stiffness.iter().chain([&parts.mass]).chain(&parts.gyroscopic);
        for matrix in matrices.flat_map(|matrix| [&matrix.own, &matrix.next]) {
            let (rows, columns) = (matrix.nrows(), matrix.ncols());
            if (rows, columns) != (dofs, dofs) {
                return Err(UnsoundSector::Size { rows, columns, dofs });
            }
        }
        for node in &parts.contact {
            if let Some(&dof) = node.dofs.iter().find(|&&dof| dof >= dofs) {
                return Err(UnsoundSector::ContactDof { id: node.id, dof, dofs });
            }
        }
        let mut on_axis = parts.axis.iter().flat_map(AxisNode::rows).flatten();
        if let Some(dof) = on_axis.find(|&dof| dof >= dofs) {
            return Err(UnsoundSector::AxisDof { dof, dofs });
        }
        Ok(Self(parts))
    }

    /// Parts of the sector, to make another one from.
    pub fn into_parts(self) -> SectorParts {
        self.0
    }
}

impl std::ops::Deref for SectorModel {
    type Target = SectorParts;

    fn deref(&self) -> &SectorParts {
        &self.0
    }
}

impl SectorParts {
    /// Number of own DOF (internal with the low face, and contact).
    pub fn own_dofs(&self) -> usize {
        self.node_of_dof.len()
    }
}

#[cfg(test)]
mod tests {
    use faer::sparse::Triplet;

    use super::*;

    fn matrix(size: usize) -> CyclicMatrix {
        let diagonal: Vec<_> = (0..size).map(|i| Triplet::new(i, i, 1.0)).collect();
        let own = SparseColMat::try_new_from_triplets(size, size, &diagonal).unwrap();
        let next = SparseColMat::try_new_from_triplets(size, size, &[]).unwrap();
        CyclicMatrix { own, next }
    }

    fn parts() -> SectorParts {
        let unit = || "1".to_owned();
        SectorParts {
            name: String::new(),
            sectors: 3,
            units: Units { length: unit(), force: unit(), time: unit(), mass: unit() },
            mass: matrix(3),
            stiffness: vec![matrix(3); 3],
            gyroscopic: None,
            speeds_rad_s: vec![0.0, 50.0, 100.0],
            contact: vec![ContactNode {
                id: 7,
                position: [1.0, 0.0, 0.0],
                normal: [1.0, 0.0, 0.0],
                dofs: [0, 1, 2],
            }],
            axis: Vec::new(),
            node_of_dof: vec![0; 3],
        }
    }

    #[test]
    fn only_parts_that_fit_make_a_sector() {
        let refused = |change: fn(&mut SectorParts)| {
            let mut parts = parts();
            change(&mut parts);
            SectorModel::new(parts).map(|_| ())
        };
        assert_eq!(refused(|_| ()), Ok(()));
        assert_eq!(refused(|parts| parts.sectors = 0), Err(UnsoundSector::NoSectors));
        assert_eq!(refused(|parts| parts.contact.clear()), Err(UnsoundSector::NoContactNodes));
        for change in [
            (|parts| parts.speeds_rad_s.truncate(2)) as fn(&mut SectorParts),
            |parts| parts.stiffness.truncate(1),
            |parts| parts.speeds_rad_s[2] = 40.0,
            |parts| parts.speeds_rad_s[0] = 1.0,
        ] {
            assert!(matches!(refused(change), Err(UnsoundSector::Speeds { .. })));
        }
        let other = Err(UnsoundSector::Size { rows: 4, columns: 4, dofs: 3 });
        assert_eq!(refused(|parts| parts.mass = matrix(4)), other);
        assert_eq!(refused(|parts| parts.gyroscopic = Some(matrix(4))), other);
        let beyond = Err(UnsoundSector::ContactDof { id: 7, dof: 3, dofs: 3 });
        assert_eq!(refused(|parts| parts.contact[0].dofs[2] = 3), beyond);
        let on_axis = AxisNode { axial: Some(3), lateral: [None; 2] };
        let mut with_axis = parts();
        with_axis.axis.push(on_axis);
        let refused = SectorModel::new(with_axis).map(|_| ());
        assert_eq!(refused, Err(UnsoundSector::AxisDof { dof: 3, dofs: 3 }));
    }
}
