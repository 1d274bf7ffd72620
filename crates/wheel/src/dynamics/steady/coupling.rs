//! Coupling of the modes within a linearised step: mistuning, and Coriolis forces.
//!
//! With them a step is that of [`driven`](crate::dynamics::oscillators::driven), in which forces at engine orders, being the same for all
//! states, leave no trace:
//!
//! ```text
//! δz⁺ − δz⁻ = S (keep·δd − pull·δz + δd − R M δz),   M = −∂f/∂z of mistuning
//! ```

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, MatRef, Par, c64};

use crate::dynamics::coriolis::swing_matrix;
use crate::dynamics::integrate::{Passage, Unknown};

/// Coupling of the unknowns of a return map; empty where nothing couples them.
#[derive(Debug)]
pub(super) struct Coupling {
    /// Unknowns of every mistuned family, with the matrix R M.
    mistuned: Vec<(Vec<usize>, Mat<f64>)>,
    /// Unknowns of every nodal diameter, with the matrix S.
    turned: Vec<(Range<usize>, Mat<f64>)>,
}

impl Coupling {
    pub(super) fn of(passage: &Passage<'_>, receptance: &[f64]) -> Self {
        let unknowns = passage.unknowns();
        let mistuned = passage.mistuned().into_iter().enumerate().map(|(family, stiffness)| {
            // In the order of the Fourier columns.
            let own: Vec<usize> = (0..unknowns.len()).filter(|&i| unknowns[i].family == family).collect();
            let scaled = |i: usize, j: usize| receptance[own[i]] * stiffness[(i, j)];
            let scaled = Mat::from_fn(own.len(), own.len(), scaled);
            (own, scaled)
        });
        let simulation = passage.simulation();
        let turned = simulation.wheel.harmonics.iter().enumerate().filter_map(|(harmonic, modes)| {
            let g = modes.gyroscopic.as_ref()?;
            let first = unknowns.partition_point(|unknown| unknown.harmonic < harmonic);
            let end = unknowns.partition_point(|unknown| unknown.harmonic <= harmonic);
            let own = &unknowns[first..end];
            let of_modes: Vec<f64> =
                (first..end).filter(|&i| !unknowns[i].imaginary).map(|i| receptance[i]).collect();
            let s = swing_matrix(g.as_ref(), simulation.wheel.speed_rad_s, passage.step_s(), &of_modes);
            Some((first..end, Mat::from_fn(own.len(), own.len(), |i, j| part(&s, own[i], own[j]))))
        });
        Self { mistuned: mistuned.collect(), turned: turned.collect() }
    }

    pub(super) fn is_none(&self) -> bool {
        self.mistuned.is_empty() && self.turned.is_empty()
    }

    /// Subtracts R M z from `swing`.
    pub(super) fn pull(&self, z: MatRef<'_, f64>, mut swing: MatMut<'_, f64>) {
        for (own, stiffness) in &self.mistuned {
            let gathered = Mat::from_fn(own.len(), z.ncols(), |i, column| z[(own[i], column)]);
            let pulled = stiffness * gathered;
            for column in 0..z.ncols() {
                for (i, &at) in own.iter().enumerate() {
                    swing[(at, column)] -= pulled[(i, column)];
                }
            }
        }
    }

    /// Multiplies `swing` by S.
    pub(super) fn turn(&self, mut swing: MatMut<'_, f64>) {
        for (own, s) in &self.turned {
            let mut rows = swing.rb_mut().subrows_mut(own.start, own.len());
            let before = rows.to_owned();
            matmul(rows.rb_mut(), Accum::Replace, s.as_ref(), before.rb(), 1.0, Par::Seq);
        }
    }
}

/// Entry of S as a real matrix over real and imaginary parts.
fn part(s: &Mat<c64>, to: Unknown, from: Unknown) -> f64 {
    let value = s[(to.family, from.family)];
    match (to.imaginary, from.imaginary) {
        (false, true) => -value.im,
        (true, false) => value.im,
        _ => value.re,
    }
}
