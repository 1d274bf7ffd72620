//! What a run records at its samples.

use pulp::Simd;

use super::super::initial::InitialMode;
use super::super::oscillators::Oscillators;
use super::super::oscillators::rows::Rows;
use super::residual::ResidualDisplacement;
use super::run::History;
use super::simulation::Simulation;
use rubmap_numerics::sector_fourier::SectorFourier;

#[derive(Debug)]
pub(super) struct Recorder {
    rows: Rows,
    sectors: Vec<usize>,
    energies: bool,
    /// What contact forces add to the sensors through modes that are not integrated.
    residual: ResidualDisplacement,
    harmonic: Vec<f64>,
    history: History,
}

impl Recorder {
    pub(super) fn new(simulation: &Simulation<'_>, fourier: &SectorFourier) -> Self {
        let directions: Vec<_> = simulation.sensors.iter().map(|sensor| sensor.direction).collect();
        let scheme = simulation.scheme;
        let rows = Rows::new(simulation.wheel, &directions, |modes| scheme.integrated_modes(modes));
        let whole = simulation.samples_per_revolution * simulation.revolutions;
        let window = simulation.samples_per_revolution * simulation.window_revolutions;
        let sensors = directions.len();
        Self {
            harmonic: vec![0.0; fourier.sectors() * rows.stride],
            energies: simulation.effects.energies,
            sectors: simulation.sensors.iter().map(|sensor| sensor.sector).collect(),
            residual: ResidualDisplacement::new(simulation, &directions),
            history: History {
                displacement: (0..sensors).map(|_| Vec::with_capacity(whole)).collect(),
                harmonics: (0..sensors)
                    .map(|_| (0..fourier.sectors()).map(|_| Vec::with_capacity(window)).collect())
                    .collect(),
                energies: Vec::new(),
                end: Vec::new(),
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
            self.residual.add(force, force.len() / fourier.sectors(), &mut self.harmonic, stride);
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

    pub(super) fn end_revolution(&mut self, oscillators: &Oscillators) {
        if self.energies {
            self.history.energies.push(oscillators.energies().collect());
        }
    }

    pub(super) fn end(&mut self, modes: Vec<InitialMode>) {
        self.history.end = modes;
    }

    pub(super) fn take(&mut self) -> History {
        std::mem::take(&mut self.history)
    }
}
