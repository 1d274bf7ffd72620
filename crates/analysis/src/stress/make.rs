//! Stress in reduced coordinates, from the mesh and the basis of a reduction.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, c64};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::reduced::{HarmonicStress, StaticStress, StaticWheel};
use crate::own_load::own_load;
use rubmap_numerics::dense::Dense;
use rubmap_solid::load::centrifugal;
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::stress::NodalStress;
use rubmap_wheel::dynamics::nodes::SectorNode;
use rubmap_wheel::dynamics::reduction::{ReducedHarmonic, ReductionError, Watch, static_response};
use rubmap_wheel::dynamics::sector::SectorModel;

/// Number of unknowns whose stress is computed together.
const COLUMNS: usize = 8;

/// Maker of the stress of a reduction's unknowns and of the centrifugal load.
#[derive(Debug)]
pub struct StressMaker<'a> {
    mesh: &'a SectorMesh,
    /// Nodes of the mesh, in its order.
    nodes: &'a [SectorNode],
    operator: NodalStress,
}

/// Source of the rows of a basis: real and imaginary part of every unknown at an own DOF of a nodal diameter.
pub type StressOf<'r, E> = &'r mut dyn FnMut(usize, usize) -> Result<Vec<f64>, E>;

impl<'a> StressMaker<'a> {
    /// Maker for a mesh and its nodes in the same order, as packages have them.
    pub fn new(mesh: &'a SectorMesh, nodes: &'a [SectorNode]) -> Self {
        Self { mesh, nodes, operator: NodalStress::new(mesh) }
    }

    /// Operator of the stress at nodes.
    pub fn operator(&self) -> &NodalStress {
        &self.operator
    }

    /// Stress S̃ of a nodal diameter at all places, in single precision: a millionth of the root sum of squares of its unknowns. In
    /// parallel over unknowns, on the current rayon pool.
    ///
    /// # Errors
    /// Errors of `row`.
    pub fn harmonic<E>(
        &self,
        reduced: &ReducedHarmonic,
        own_dofs: usize,
        row: StressOf<'_, E>,
    ) -> Result<HarmonicStress, E> {
        let unknowns = reduced.mass.ncols();
        // Υ̂ᴴ, then (Υ̂ L⁻ᴴ)ᴴ = L⁻¹ Υ̂ᴴ.
        let mut adjoint = Mat::<c64>::zeros(unknowns, own_dofs);
        for dof in 0..own_dofs {
            for (unknown, value) in row(reduced.harmonic, dof)?.chunks_exact(2).enumerate() {
                adjoint[(unknown, dof)] = c64::new(value[0], -value[1]);
            }
        }
        if let Some(lower) = lower(reduced) {
            solve_lower_triangular_in_place(lower.as_ref(), adjoint.as_mut(), Par::Seq);
        }
        let angle = std::f64::consts::TAU * reduced.harmonic as f64 / self.mesh.sectors as f64;
        let phase = c64::new(angle.cos(), angle.sin());
        let blocks: Vec<(usize, Mat<c64>)> = (0..unknowns.div_ceil(COLUMNS))
            .into_par_iter()
            .map(|block| {
                let first = block * COLUMNS;
                let count = COLUMNS.min(unknowns - first);
                let shapes = self.at_nodes(count, |dof, column| adjoint[(first + column, dof)].conj());
                (first, self.operator.apply(phase, shapes.as_ref()))
            })
            .collect();
        let mut rows = Mat::<f32>::zeros(2 * unknowns, 6 * self.operator.places().len());
        for (first, stress) in blocks {
            for component in 0..stress.nrows() {
                for column in 0..stress.ncols() {
                    let value = stress[(component, column)];
                    rows[(2 * (first + column), component)] = value.re as f32;
                    rows[(2 * (first + column) + 1, component)] = value.im as f32;
                }
            }
        }
        Ok(HarmonicStress::new(rows))
    }

    /// Displacement under the centrifugal load, and its stress at all places.
    ///
    /// # Errors
    /// Errors of [`static_response`].
    pub fn fixed(&self, sector: &SectorModel, watch: Watch<'_>) -> Result<StaticWheel, ReductionError> {
        let load = own_load(self.nodes, &centrifugal(self.mesh), sector.own_dofs());
        let response = static_response(sector, &load, watch)?;
        let speeds = response.solutions.ncols();
        let shapes = self.at_nodes(speeds, |dof, speed| c64::new(response.solutions[(dof, speed)], 0.0));
        let stress = self.operator.apply(c64::new(1.0, 0.0), shapes.as_ref());
        let rows = (0..stress.nrows()).flat_map(|row| (0..speeds).map(move |speed| (row, speed)));
        let stress = StaticStress { stress: rows.map(|at| stress[at].re).collect(), span: response.span };
        let dofs = (0..sector.own_dofs()).flat_map(|dof| (0..speeds).map(move |speed| (dof, speed)));
        Ok(StaticWheel { stress, displacement: dofs.map(|at| response.solutions[at]).collect() })
    }

    /// Displacement (r, θ, z) at all nodes of `columns` vectors over the own DOF.
    fn at_nodes(&self, columns: usize, of: impl Fn(usize, usize) -> c64) -> Mat<c64> {
        let mut shapes = Mat::zeros(3 * self.nodes.len(), columns);
        for (index, node) in self.nodes.iter().enumerate().filter(|(_, node)| !node.on_high_face) {
            for dof in node.dofs.iter().flatten() {
                for column in 0..columns {
                    let value = of(dof.dof, column);
                    for (component, &share) in dof.components.iter().enumerate() {
                        shapes[(3 * index + component, column)] += value * share;
                    }
                }
            }
        }
        shapes
    }
}

/// Cholesky factor L of K_r(0) = L Lᴴ; every reduction has it.
pub(super) fn lower(reduced: &ReducedHarmonic) -> Option<Mat<c64>> {
    c64::lower_factor(reduced.stiffness.coefficients[0].as_ref())
}
