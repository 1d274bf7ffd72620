//! What a run records at its samples.

use faer::{Mat, c64};
use pulp::Simd;

use super::super::contact::flexibility::outward_normals;
use super::super::oscillators::Oscillators;
use super::super::oscillators::rows::Rows;
use super::super::schemes::Scheme;
use super::super::schemes::massless_boundary::residual_flexibility;
use super::{History, Simulation};
use crate::numerics::sector_fourier::SectorFourier;

#[derive(Debug)]
pub(super) struct Recorder {
    rows: Rows,
    sectors: Vec<usize>,
    /// What contact forces add to the sensors through modes that are not integrated; empty if all are.
    residual: Vec<Residual>,
    harmonic: Vec<f64>,
    history: History,
}

/// Residual flexibility of one nodal diameter, sensors × contact nodes.
#[derive(Debug)]
struct Residual {
    block: Mat<c64>,
    /// Fourier column of the real part.
    column: usize,
    single: bool,
}

impl Recorder {
    pub(super) fn new(simulation: &Simulation<'_>, fourier: &SectorFourier) -> Self {
        let directions: Vec<_> = simulation.sensors.iter().map(|sensor| sensor.direction).collect();
        let scheme = simulation.scheme;
        let rows = Rows::new(simulation.wheel, &directions, |modes| scheme.integrated_modes(modes));
        let whole = simulation.samples_per_revolution * simulation.revolutions;
        let window = simulation.samples_per_revolution * simulation.window_revolutions;
        let sensors = directions.len();
        let mut residual = Vec::new();
        if let (Scheme::MasslessBoundary { kept_modes }, Some(_)) = (scheme, simulation.casing) {
            let normals = outward_normals(simulation.contact_nodes);
            let blocks = residual_flexibility(simulation.wheel, kept_modes, &directions, &normals);
            let mut column = 0;
            for (harmonic, block) in simulation.wheel.harmonics.iter().zip(blocks) {
                residual.push(Residual { block, column, single: harmonic.single });
                column += if harmonic.single { 1 } else { 2 };
            }
        }
        Self {
            harmonic: vec![0.0; fourier.sectors() * rows.stride],
            sectors: simulation.sensors.iter().map(|sensor| sensor.sector).collect(),
            residual,
            history: History {
                displacement: (0..sensors).map(|_| Vec::with_capacity(whole)).collect(),
                harmonics: (0..sensors)
                    .map(|_| (0..fourier.sectors()).map(|_| Vec::with_capacity(window)).collect())
                    .collect(),
            },
            rows,
        }
    }

    /// Records the sensors; `force` is that on the contact nodes in Fourier coordinates, `[column][node]`.
    #[inline(always)]
    pub(super) fn record<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        force: Option<&[f64]>,
        windowed: bool,
    ) {
        oscillators.project(simd, &self.rows, &mut self.harmonic);
        let stride = self.rows.stride;
        if let Some(force) = force {
            for residual in &self.residual {
                residual.add(force, force.len() / fourier.sectors(), stride, &mut self.harmonic);
            }
        }
        for (sensor, &sector) in self.sectors.iter().enumerate() {
            let coordinate = |column: usize| self.harmonic[column * stride + sensor];
            let row = fourier.row(sector).iter().enumerate();
            self.history.displacement[sensor].push(row.map(|(column, f)| f * coordinate(column)).sum());
            if windowed {
                for (column, line) in self.history.harmonics[sensor].iter_mut().enumerate() {
                    line.push(coordinate(column));
                }
            }
        }
    }

    pub(super) fn take(&mut self) -> History {
        std::mem::take(&mut self.history)
    }
}

impl Residual {
    #[inline(never)]
    fn add(&self, force: &[f64], force_stride: usize, stride: usize, out: &mut [f64]) {
        let part = |column: usize, node: usize| force[column * force_stride + node];
        for node in 0..self.block.ncols() {
            let re = part(self.column, node);
            let im = if self.single { 0.0 } else { part(self.column + 1, node) };
            if re == 0.0 && im == 0.0 {
                continue;
            }
            for sensor in 0..self.block.nrows() {
                let moved = self.block[(sensor, node)] * c64::new(re, im);
                out[self.column * stride + sensor] += moved.re;
                if !self.single {
                    out[(self.column + 1) * stride + sensor] += moved.im;
                }
            }
        }
    }
}
