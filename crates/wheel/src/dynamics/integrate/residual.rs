//! Displacements through the modes that are not integrated, where they are read (docs/method.md, A boundary without mass).

use faer::{Mat, c64};

use super::super::contact::flexibility::outward_normals;
use super::super::direction::Direction;
use super::super::schemes::Scheme;
use super::super::schemes::massless_boundary::residual_flexibility;
use super::simulation::Simulation;

/// F f of some rows; nothing if the scheme integrates every mode.
#[derive(Debug)]
pub(super) struct ResidualDisplacement {
    harmonics: Vec<Harmonic>,
    /// No unit force in Fourier coordinates moves any row of any sector by more.
    largest: f64,
}

#[derive(Debug)]
struct Harmonic {
    /// Rows × contact nodes.
    flexibility: Mat<c64>,
    /// Fourier column of the real part.
    column: usize,
    single: bool,
}

impl ResidualDisplacement {
    pub(super) fn new(simulation: &Simulation<'_>, rows: &[Direction]) -> Self {
        let mut harmonics: Vec<Harmonic> = Vec::new();
        if let (Scheme::MasslessBoundary { kept_modes }, Some(_)) = (simulation.scheme, simulation.casing) {
            let applied = match simulation.effects.friction {
                Some(friction) => friction.directions.to_vec(),
                None => outward_normals(simulation.contact_nodes),
            };
            let blocks = residual_flexibility(simulation.wheel, kept_modes, rows, &applied);
            let mut column = 0;
            for (modes, flexibility) in simulation.wheel.harmonics.iter().zip(blocks) {
                harmonics.push(Harmonic { flexibility, column, single: modes.single });
                column += if modes.single { 1 } else { 2 };
            }
        }
        let entries = harmonics.iter().flat_map(|harmonic| harmonic.flexibility.col_iter());
        let largest = entries.flat_map(|column| column.iter()).fold(0.0f64, |m, f| m.max(f.norm()));
        // Real and imaginary part move both columns of a pair, each read with a weight of at most √(2/N).
        Self { harmonics, largest: 2.0 * largest * (2.0 / simulation.wheel.sectors as f64).sqrt() }
    }

    /// What `force` moves no row by more than.
    pub(super) fn bound(&self, force: &[f64]) -> f64 {
        if self.harmonics.is_empty() {
            0.0
        } else {
            self.largest * force.iter().map(|f| f.abs()).sum::<f64>()
        }
    }

    /// Adds to `out[column][row]` (rows padded to `stride`) what `force[column][node]` (nodes padded to `force_stride`)
    /// moves.
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
