//! Rigid motions of a sector, and the nodes at which K(0) gives no force against them.
//!
//! An elastic stiffness gives no force at a node that no clamp, support or cyclic face touches, except for the round-off of the entries as
//! they were written.

use nalgebra::Vector3;
use rubmap_solid::frame::Basis;

use super::better::count;
use crate::package::check::layout::{Layout, NONE};
use crate::package::raw::{Frame, RawMatrix, RawPackage};

/// Number of rigid motions: three translations and three rotations.
pub(super) const MOTIONS: usize = 6;

/// Part of Σ|K_ij| times the size of the sector below which forces are in balance: entries of four digits leave 1e-6, a node at a wrong
/// position 1e-3 and more.
pub(super) const IN_BALANCE: f64 = 1e-5;

/// Value for every rigid motion.
pub(super) type OfMotions = [f64; MOTIONS];

/// Nodes of a sector with their positions, and the rows that the package gives them.
pub(super) struct Body {
    /// Positions from the middle of the sector.
    positions: Vec<Vector3<f64>>,
    /// Parts of the positions normal to the axis, from the axis.
    from_axis: Vec<Vector3<f64>>,
    axis: Vector3<f64>,
    /// Local unit vectors (r, θ, z) of each node.
    cylindrical: Vec<Basis>,
    pub(super) stated: Reading,
    /// Whether each node is on a cyclic face.
    pub(super) on_face: Vec<bool>,
    /// Whether each node is on the axis of several sectors, where the sector alone is not in balance under its own load.
    on_axis: Vec<bool>,
    rows: usize,
    /// Largest distance of a node from the middle.
    pub(super) size: f64,
}

/// Rows and components of each node, as a package states them or as they might be meant.
#[derive(Clone)]
pub(super) struct Reading {
    pub(super) rows_of_node: Vec<[u32; 3]>,
    /// Local unit vectors of each node's components.
    pub(super) bases: Vec<Basis>,
}

impl Body {
    pub(super) fn of(package: &RawPackage, layout: &Layout) -> Self {
        let free = |node: &usize| layout.rows_of_node[*node] != [NONE; 3];
        let at = |node: usize| Vector3::from(package.nodes[node].position);
        let nodes = package.nodes.len();
        let count = (0..nodes).filter(free).count().max(1) as f64;
        let middle = (0..nodes).filter(free).map(|node| at(node) / count).sum::<Vector3<f64>>();
        let positions: Vec<_> = (0..nodes).map(|node| at(node) - middle).collect();
        let size = (0..nodes).filter(free).map(|node| positions[node].norm()).fold(0.0, f64::max);
        let local = |node: usize| {
            let [r, theta, _] = layout.frame.coordinates(package.nodes[node].position);
            let basis = layout.frame.cylindrical(theta);
            (basis.row(0).transpose() * r, basis)
        };
        let (from_axis, cylindrical): (Vec<_>, Vec<Basis>) = (0..nodes).map(local).unzip();
        let bases = match package.manifest.frame {
            Frame::Cartesian => vec![Basis::identity(); nodes],
            Frame::Cylindrical => cylindrical.clone(),
        };
        Self {
            positions,
            from_axis,
            axis: layout.frame.direction(),
            cylindrical,
            stated: Reading { rows_of_node: layout.rows_of_node.clone(), bases },
            on_face: (0..nodes).map(|k| layout.high_of[k] != NONE || layout.low_of[k] != NONE).collect(),
            on_axis: (0..nodes).map(|node| layout.on_axis.contains(&(node as u32))).collect(),
            rows: package.dofs.len(),
            size,
        }
    }

    /// Vector from the axis, normal to it, to the middle of the sector.
    pub(super) fn middle_from_axis(&self) -> Vector3<f64> {
        let place = self.from_axis.iter().zip(&self.positions).next();
        place.map_or_else(Vector3::zeros, |(from_axis, position)| from_axis - self.in_plane(*position))
    }

    /// Rows as stated, components of each node in the frame that is given.
    pub(super) fn in_frames(&self, frame: impl Fn(usize) -> Frame) -> Reading {
        let basis = |node: usize| match frame(node) {
            Frame::Cartesian => Basis::identity(),
            Frame::Cylindrical => self.cylindrical[node],
        };
        let bases = (0..self.positions.len()).map(basis).collect();
        Reading { rows_of_node: self.stated.rows_of_node.clone(), bases }
    }

    /// Displacement of a node in a motion, global components: motions 0 to 2 move it by the size of the sector along x, y and z, 3 to 5
    /// turn it by 1 rad about the middle of the sector.
    fn displacement(&self, node: usize, motion: usize) -> Vector3<f64> {
        let mut unit = Vector3::zeros();
        unit[motion % 3] = 1.0;
        if motion < 3 { unit * self.size } else { unit.cross(&self.positions[node]) }
    }

    /// Unit vector about which a motion turns; 0 for a translation.
    pub(super) fn turn(motion: usize) -> Vector3<f64> {
        let mut unit = Vector3::zeros();
        if motion >= 3 {
            unit[motion - 3] = 1.0;
        }
        unit
    }

    /// Displacements of all motions by row.
    pub(super) fn motions(&self, reading: &Reading) -> Vec<OfMotions> {
        self.by_row(reading, |node, motion| self.displacement(node, motion))
    }

    /// Parts of all motions normal to the axis, by row.
    pub(super) fn motions_in_plane(&self, reading: &Reading) -> Vec<OfMotions> {
        self.by_row(reading, |node, motion| self.in_plane(self.displacement(node, motion)))
    }

    /// Radius vectors from the axis, by row.
    pub(super) fn radii(&self, reading: &Reading) -> Vec<OfMotions> {
        self.by_row(reading, |node, motion| if motion == 0 { self.from_axis[node] } else { Vector3::zeros() })
    }

    pub(super) fn in_plane(&self, vector: Vector3<f64>) -> Vector3<f64> {
        vector - self.axis * vector.dot(&self.axis)
    }

    /// Part of a vector at a node along the circumference.
    pub(super) fn around(&self, node: usize, vector: Vector3<f64>) -> f64 {
        self.cylindrical[node].row(1).transpose().dot(&vector)
    }

    fn by_row(&self, reading: &Reading, vector: impl Fn(usize, usize) -> Vector3<f64>) -> Vec<OfMotions> {
        let mut by_row = vec![[0.0; MOTIONS]; self.rows];
        for (node, rows) in reading.rows_of_node.iter().enumerate().filter(|(_, rows)| **rows != [NONE; 3]) {
            let local: [Vector3<f64>; MOTIONS] =
                std::array::from_fn(|motion| reading.bases[node] * vector(node, motion));
            for (component, &row) in rows.iter().enumerate().filter(|(_, row)| **row != NONE) {
                by_row[row as usize] = local.map(|moved| moved[component]);
            }
        }
        by_row
    }

    /// Nodes that have all three components and are neither on a cyclic face nor on the axis.
    pub(super) fn inner(&self) -> impl Iterator<Item = usize> + '_ {
        let rows = &self.stated.rows_of_node;
        (0..rows.len())
            .filter(|&node| !self.on_face[node] && !self.on_axis[node] && !rows[node].contains(&NONE))
    }
}

impl Reading {
    /// Vector of a node, global components, from its rows.
    pub(super) fn vector(&self, node: usize, by_row: &[OfMotions], motion: usize) -> Vector3<f64> {
        let local = Vector3::from(self.rows_of_node[node].map(|row| by_row[row as usize][motion]));
        self.bases[node].tr_mul(&local)
    }
}

/// Forces of a matrix against motions, by row.
pub(super) fn forces(matrix: &RawMatrix, motions: &[OfMotions]) -> Vec<OfMotions> {
    let mut forces = vec![[0.0; MOTIONS]; matrix.size];
    for &(row, column, value) in &matrix.entries {
        let (row, column) = (row as usize, column as usize);
        for motion in 0..MOTIONS {
            forces[row][motion] += value * motions[column][motion];
            if row != column {
                forces[column][motion] += value * motions[row][motion];
            }
        }
    }
    forces
}

/// Sums Σ_j |M_ij| of the rows of a matrix.
pub(super) fn absolute_sums(matrix: &RawMatrix) -> Vec<f64> {
    let mut sums = vec![0.0; matrix.size];
    for &(row, column, value) in &matrix.entries {
        sums[row as usize] += value.abs();
        if row != column {
            sums[column as usize] += value.abs();
        }
    }
    sums
}

/// Inner nodes that K(0) leaves in balance.
pub(super) struct Balance {
    /// Whether each node is in balance.
    pub(super) nodes: Vec<bool>,
    /// Forces against the motions, by row.
    pub(super) forces: Vec<OfMotions>,
    /// Median of the largest force at nodes in balance, as a part of Σ|K_ij| times the size of the sector.
    pub(super) residual: f64,
}

impl Balance {
    pub(super) fn of(body: &Body, reading: &Reading, stiffness: &RawMatrix) -> Self {
        let scale = absolute_sums(stiffness);
        let forces = forces(stiffness, &body.motions(reading));
        let mut nodes = vec![false; body.positions.len()];
        let mut residuals = Vec::new();
        for node in body.inner() {
            let rows = reading.rows_of_node[node];
            let largest = |row: u32| forces[row as usize].iter().map(|force| force.abs()).fold(0.0, f64::max);
            let force = rows.iter().map(|&row| largest(row)).fold(0.0, f64::max);
            let scale = rows.iter().map(|&row| scale[row as usize] * body.size).fold(0.0, f64::max);
            if force <= IN_BALANCE * scale && scale > 0.0 {
                nodes[node] = true;
                residuals.push(force / scale);
            }
        }
        residuals.sort_unstable_by(f64::total_cmp);
        let residual = residuals.get(residuals.len() / 2).copied().unwrap_or(0.0);
        Self { nodes, forces, residual }
    }

    pub(super) fn count(&self) -> usize {
        count(&self.nodes)
    }
}
