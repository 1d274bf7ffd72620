//! Displacements that no integrated mode has: through the modes that are not integrated (docs/method.md, A boundary without mass), or
//! by forces that are yet to complete a step.

use faer::{Mat, c64};

use super::super::bending::Bending;
use super::super::contact::flexibility::outward_normals;
use super::super::direction::Direction;
use super::super::oscillators::Oscillators;
use super::super::schemes::Scheme;
use super::super::schemes::massless_boundary::residual_flexibility;
use super::simulation::Simulation;
use super::step_flexibility::step_flexibility;

/// Displacements F f of some rows.
#[derive(Debug)]
pub(super) struct ResidualDisplacement {
    harmonics: Vec<Harmonic>,
    /// Largest displacement of any row of any sector by a unit force in Fourier coordinates.
    largest: f64,
}

#[derive(Debug)]
struct Harmonic {
    /// Flexibility F, rows × contact nodes.
    flexibility: Mat<c64>,
    /// Fourier column of the real part.
    column: usize,
    single: bool,
}

impl ResidualDisplacement {
    /// Displacement through the modes that are not integrated; nothing if the scheme integrates every mode.
    pub(super) fn new(simulation: &Simulation<'_>, rows: &[Direction]) -> Self {
        match (simulation.scheme, simulation.casing) {
            (Scheme::MasslessBoundary { kept_modes }, Some(_)) => {
                let from = applied(simulation);
                Self::of(simulation, residual_flexibility(simulation.wheel, kept_modes, rows, &from))
            }
            _ => Self::of(simulation, Vec::new()),
        }
    }

    /// Displacement that includes the part by the forces of a step until they are applied.
    pub(super) fn until_applied(
        simulation: &Simulation<'_>,
        oscillators: &Oscillators,
        rows: &[Direction],
    ) -> Self {
        let blocks = match simulation.casing {
            Some(_) => step_flexibility(simulation, oscillators, rows, &applied(simulation)),
            None => Vec::new(),
        };
        Self::of(simulation, blocks)
    }

    /// Displacement with the blocks F of every nodal diameter, or with none.
    fn of(simulation: &Simulation<'_>, blocks: Vec<Mat<c64>>) -> Self {
        let mut harmonics: Vec<Harmonic> = Vec::new();
        let mut column = 0;
        for (modes, flexibility) in simulation.wheel.harmonics.iter().zip(blocks) {
            harmonics.push(Harmonic { flexibility, column, single: modes.single });
            column += if modes.single { 1 } else { 2 };
        }
        let entries = harmonics.iter().flat_map(|harmonic| harmonic.flexibility.col_iter());
        let largest = entries.flat_map(|column| column.iter()).fold(0.0f64, |m, f| m.max(f.norm()));
        // Real and imaginary part move both columns of a pair, each read with a weight of at most √(2/N).
        Self { harmonics, largest: 2.0 * largest * (2.0 / simulation.wheel.sectors as f64).sqrt() }
    }

    /// Upper bound of the displacement of any row by `force`.
    pub(super) fn bound(&self, force: &[f64]) -> f64 {
        if self.harmonics.is_empty() {
            0.0
        } else {
            self.largest * force.iter().map(|f| f.abs()).sum::<f64>()
        }
    }

    /// Adds to `out[column][row]` (rows padded to `stride`) the displacement by `force[column][node]` (nodes padded to `force_stride`).
    pub(super) fn add(&self, force: &[f64], force_stride: usize, out: &mut [f64], stride: usize) {
        for Harmonic { flexibility, column, single } in &self.harmonics {
            for node in 0..flexibility.ncols() {
                let re = force[column * force_stride + node];
                let im = if *single { 0.0 } else { force[(column + 1) * force_stride + node] };
                if re == 0.0 && im == 0.0 {
                    continue;
                }
                for row in 0..flexibility.nrows() {
                    let moved = flexibility[(row, node)] * c64::new(re, im);
                    out[column * stride + row] += moved.re;
                    if !single {
                        out[(column + 1) * stride + row] += moved.im;
                    }
                }
            }
        }
    }
}

/// Directions along which contact forces act.
pub(super) fn applied(simulation: &Simulation<'_>) -> Vec<Direction> {
    let mut applied = match simulation.effects.friction {
        Some(friction) => friction.directions.to_vec(),
        None => outward_normals(simulation.contact_nodes),
    };
    // Blades that bend far are pushed along their coordinates, too.
    applied.extend(simulation.effects.bending.iter().flat_map(Bending::directions));
    applied
}
