//! The reduction basis of one nodal diameter: static modes at rest, fixed-interface modes at the given speeds.

use faer::sparse::SymbolicSparseColMatRef;
use faer::{Mat, c64};

use super::{Basis, ReductionError, ReductionOptions, Watch};
use crate::dynamics::cyclic::{HarmonicMatrix, Partition};
use crate::dynamics::error::ModelError;
use crate::dynamics::sector::SectorModel;
use crate::numerics::block_lanczos::{LanczosError, LanczosOptions, lowest_modes};
use crate::numerics::orthonormal::orthonormal_basis;
use crate::numerics::sparse_cholesky::{SparseCholesky, SymbolicFactor};
use crate::numerics::sparse_product::sparse_product;

/// Ψ_s(0) and Ψ* (Eqs 4, 5).
pub(super) fn reduction_basis(
    sector: &SectorModel,
    harmonic: usize,
    partition: &Partition,
    mass: &HarmonicMatrix,
    stiffness: &[HarmonicMatrix],
    options: &ReductionOptions,
    watch: Watch<'_>,
) -> Result<Basis, ReductionError> {
    let (n_i, n_b) = (partition.internal.len(), partition.contact.len());
    if n_i == 0 {
        return Ok(Basis {
            static_modes: Mat::zeros(0, n_b),
            modes: Mat::zeros(0, 0),
            largest_mode_residual: 0.0,
        });
    }
    let count = options.modes_per_speed.min(n_i);
    let nodes: Vec<usize> = compress(partition.internal.iter().map(|&dof| sector.node_of_dof[dof]));
    let mut symbolic = SymbolicFactor::new(stiffness[0].internal.symbolic(), &nodes);
    // Modes see only the low end of the spectrum; an indefinite mass may hide at the other.
    let mass_factor = SymbolicFactor::new(mass.internal.symbolic(), &nodes);
    SparseCholesky::new(&mass_factor, &mass.internal)
        .map_err(|_| ModelError::MassNotPositiveDefinite { nodal_diameter: harmonic })?;
    let mut static_modes = Mat::zeros(n_i, n_b);
    let mut modes = Mat::zeros(n_i, count * stiffness.len());
    let mut largest_mode_residual: f64 = 0.0;
    for (index, (k, &speed_rad_s)) in stiffness.iter().zip(&sector.speeds_rad_s).enumerate() {
        let done = index as f64 / stiffness.len() as f64;
        let phase = format!("fixed-interface modes at {speed_rad_s} rad/s");
        if !watch(done, &phase) {
            return Err(ReductionError::Cancelled);
        }
        // An exporter may leave zeros out of one matrix and not of another.
        if index > 0 && !same_pattern(k.internal.symbolic(), stiffness[index - 1].internal.symbolic()) {
            symbolic = SymbolicFactor::new(k.internal.symbolic(), &nodes);
        }
        let factor = SparseCholesky::new(&symbolic, &k.internal).map_err(|_| {
            let hint = if index == 0 {
                "is the hub constrained, and does every part of the sector hang on it?"
            } else {
                "the sector would buckle under its own centrifugal load, or this matrix is not K(Ω)"
            };
            ModelError::StiffnessNotPositiveDefinite { nodal_diameter: harmonic, speed_rad_s, hint }
        })?;
        if index == 0 {
            static_modes = k.coupling.to_dense() * faer::Scale(c64::new(-1.0, 0.0));
            factor.solve_in_place(static_modes.as_mut());
        }
        let keep_going = || watch(done, &phase);
        let options = LanczosOptions::default();
        let found = lowest_modes(&k.internal, &mass.internal, &factor, count, &options, &keep_going)
            .map_err(|error| mode_error(error, harmonic, speed_rad_s))?;
        largest_mode_residual = largest_mode_residual.max(found.largest_residual);
        modes.subcols_mut(index * count, count).copy_from(&found.vectors);
    }
    let gram = modes.adjoint() * sparse_product(&mass.internal, modes.as_ref());
    let modes = orthonormal_basis(modes.as_ref(), gram.as_ref(), options.basis_tolerance)
        .ok_or(ModelError::MassNotPositiveDefinite { nodal_diameter: harmonic })?;
    Ok(Basis { static_modes, modes, largest_mode_residual })
}

fn mode_error(error: LanczosError, nodal_diameter: usize, speed_rad_s: f64) -> ReductionError {
    match error {
        LanczosError::Stopped => ReductionError::Cancelled,
        LanczosError::NotConverged { residual, block_steps } => {
            ModelError::ModesNotConverged { nodal_diameter, speed_rad_s, residual, iterations: block_steps }
                .into()
        }
        LanczosError::Massless => ModelError::MassNotPositiveDefinite { nodal_diameter }.into(),
        LanczosError::DenseFailed => ModelError::DecompositionFailed { nodal_diameter, speed_rad_s }.into(),
    }
}

/// Renumbers arbitrary labels to 0, 1, 2 … in order of appearance.
fn compress(labels: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut known = std::collections::HashMap::new();
    labels
        .map(|label| {
            let next = known.len();
            *known.entry(label).or_insert(next)
        })
        .collect()
}

fn same_pattern(a: SymbolicSparseColMatRef<'_, usize>, b: SymbolicSparseColMatRef<'_, usize>) -> bool {
    a.col_ptr() == b.col_ptr() && a.row_idx() == b.row_idx()
}
