//! Displacements of nodes of the sector in the reduced coordinates (docs/method.md, Reduction), to read the wheel there.

use std::collections::BTreeMap;

use faer::{Mat, c64};

use super::error::ModelError;
use super::modal_wheel::{ModalWheel, mode_shapes};
use super::nodes::SectorNode;
use super::reduction::ReducedWheel;

/// Rows of the reduction basis at some nodes of a sector.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NodeRows {
    /// Nodes by id: their index, and whether they lie on the high face.
    nodes: BTreeMap<u64, (usize, bool)>,
    /// Coordinates (r, θ, z) of each node.
    coordinates: Vec<[f64; 3]>,
    /// Rows of each nodal diameter, `3 nodes × unknowns`: r, θ, z of every node.
    harmonics: Vec<Mat<c64>>,
}

impl NodeRows {
    /// Gathers the rows of `nodes` for the nodal diameters of `reduced`; `row` gives the row of an own DOF at a nodal diameter, real and
    /// imaginary part of every unknown.
    ///
    /// # Errors
    /// Errors of `row`.
    pub fn gather<E>(
        nodes: &[SectorNode],
        reduced: &ReducedWheel,
        mut row: impl FnMut(usize, usize) -> Result<Vec<f64>, E>,
    ) -> Result<Self, E> {
        let mut harmonics = Vec::with_capacity(reduced.harmonics.len());
        for (harmonic, reduced) in reduced.harmonics.iter().enumerate() {
            let mut rows = Mat::zeros(3 * nodes.len(), reduced.mass.ncols());
            for (index, node) in nodes.iter().enumerate() {
                for dof in node.dofs.iter().flatten() {
                    for (column, value) in row(harmonic, dof.dof)?.chunks_exact(2).enumerate() {
                        let value = c64::new(value[0], value[1]);
                        for (component, &share) in dof.components.iter().enumerate() {
                            rows[(3 * index + component, column)] += value * share;
                        }
                    }
                }
            }
            harmonics.push(rows);
        }
        let place = |(index, node): (usize, &SectorNode)| (node.id, (index, node.on_high_face));
        let coordinates = nodes.iter().map(|node| node.coordinates).collect();
        Ok(Self { nodes: nodes.iter().enumerate().map(place).collect(), coordinates, harmonics })
    }

    /// Index of node `id`, and whether it lies on the high face; none if it is not among the nodes.
    pub fn find(&self, id: u64) -> Option<(usize, bool)> {
        self.nodes.get(&id).copied()
    }

    /// Position of the node of this index: r, θ, z.
    pub fn coordinates(&self, index: usize) -> [f64; 3] {
        self.coordinates[index]
    }

    /// Joins these nodes to `wheel`, below its contact nodes, at its speed. They can be read, not loaded.
    ///
    /// # Errors
    /// Errors of [`ModalWheel::at`].
    pub fn join(
        &self,
        mut wheel: ModalWheel,
        reduced: &ReducedWheel,
        stiffening: bool,
    ) -> Result<ModalWheel, ModelError> {
        for harmonic in &mut wheel.harmonics {
            let shapes = mode_shapes(reduced, harmonic.harmonic, wheel.speed_rad_s, stiffening)?;
            let read = &self.harmonics[harmonic.harmonic] * shapes;
            let contact = harmonic.contact.nrows();
            harmonic.contact = Mat::from_fn(contact + read.nrows(), read.ncols(), |row, mode| {
                match row.checked_sub(contact) {
                    None => harmonic.contact[(row, mode)],
                    Some(row) => read[(row, mode)],
                }
            });
        }
        Ok(wheel)
    }
}
