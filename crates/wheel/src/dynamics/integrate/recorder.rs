//! Recorder of a run: displacements at its samples, nodal diameters over its window, details of chosen revolutions.

use pulp::Simd;

use super::super::bending::Bending;
use super::super::energy::EnergyAudit;
use super::super::initial::{InitialMode, SteppedWave};
use super::super::modal_wheel::ModalWheel;
use super::super::oscillators::Oscillators;
use super::super::oscillators::rows::Rows;
use super::decimation::Decimation;
use super::detail::DetailRecorder;
use super::residual::ResidualDisplacement;
use super::revolutions::Repeated;
use super::run::History;
use super::second_order::SecondOrder;
use super::simulation::Simulation;
use super::states::StateRecorder;
use super::tally::ContactInterval;
use super::tips::TipTally;
use rubmap_numerics::sector_fourier::SectorFourier;

#[derive(Debug)]
pub(super) struct Recorder {
    rows: Rows,
    sectors: Vec<usize>,
    energies: bool,
    samples_per_revolution: usize,
    /// Displacements of the sensors by contact forces that no integrated mode has.
    residual: ResidualDisplacement,
    /// Displacements of second order of the sensors, of blades that bend far.
    second_order: Option<SecondOrder>,
    /// Displacements in Fourier coordinates as they were read last, `[column][sensor]`, sensors padded.
    harmonic: Vec<f64>,
    /// Displacements in Fourier coordinates as they were read last, without padding.
    reading: Vec<f64>,
    decimation: Decimation,
    tips: TipTally,
    detail: Option<DetailRecorder>,
    states: Option<StateRecorder>,
    history: History,
}

impl Recorder {
    /// Recorder whose `interval` holds the contact of the run, empty where there is none.
    pub(super) fn new(
        simulation: &Simulation<'_>,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        interval: ContactInterval,
    ) -> Self {
        let directions: Vec<_> = simulation.sensors.iter().map(|sensor| sensor.direction).collect();
        let scheme = simulation.scheme;
        let bending = simulation.effects.bending;
        let second_order = bending.map(|bending| SecondOrder::along(bending, &directions));
        let read: Vec<_> =
            directions.iter().copied().chain(bending.iter().flat_map(Bending::directions)).collect();
        let rows = Rows::new(simulation.wheel, &read, |modes| scheme.integrated_modes(modes));
        let samples = simulation.samples_per_revolution;
        let sensors = directions.len();
        let width = fourier.sectors() * sensors;
        let sampling = simulation.steps_per_revolution / samples;
        Self {
            harmonic: vec![0.0; fourier.sectors() * rows.stride],
            reading: vec![0.0; width],
            decimation: Decimation::new(width, sampling, samples * simulation.window_revolutions),
            energies: simulation.effects.energies,
            samples_per_revolution: samples,
            sectors: simulation.sensors.iter().map(|sensor| sensor.sector).collect(),
            residual: ResidualDisplacement::until_applied(simulation, oscillators, &read),
            second_order,
            tips: TipTally::new(simulation),
            detail: simulation.detail.map(|detail| DetailRecorder::new(simulation, detail, interval)),
            states: simulation.states.map(|states| StateRecorder::new(simulation, states, oscillators)),
            history: History {
                displacement: (0..sensors)
                    .map(|_| Vec::with_capacity(samples * simulation.revolutions))
                    .collect(),
                ..History::default()
            },
            rows,
        }
    }

    /// Whether the sensors are read after `step`, counted from the start, though it is not a sample.
    #[inline(always)]
    pub(super) fn reads(&self, step: u64, windowed: bool) -> bool {
        windowed || self.detail.as_ref().is_some_and(|detail| detail.reads(step))
    }

    /// Reads the sensors after `step`; `force` is that on the contact nodes in Fourier coordinates, `[column][node]`.
    #[inline(always)]
    pub(super) fn read<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        force: Option<&[f64]>,
        step: u64,
        windowed: bool,
    ) {
        oscillators.project(simd, &self.rows, &mut self.harmonic);
        let stride = self.rows.stride;
        if let Some(force) = force {
            self.residual.add(force, force.len() / fourier.sectors(), &mut self.harmonic, stride);
        }
        if let Some(second_order) = &mut self.second_order {
            second_order.add(fourier, &mut self.harmonic);
        }
        let sensors = self.sectors.len();
        if windowed && sensors > 0 {
            let columns = self.harmonic.chunks_exact(stride);
            for (to, from) in self.reading.chunks_exact_mut(sensors).zip(columns) {
                to.copy_from_slice(&from[..sensors]);
            }
            self.decimation.add(&self.reading);
        }
        if let Some(detail) = &mut self.detail
            && detail.reads(step)
        {
            let (harmonic, sectors) = (&self.harmonic, &self.sectors);
            detail.read(step, |sensor| displacement(harmonic, stride, fourier, sensor, sectors[sensor]));
        }
    }

    /// Records the last reading at a sample.
    #[inline(always)]
    pub(super) fn record(&mut self, fourier: &SectorFourier, step: u64, energy: &EnergyAudit) {
        for (sensor, &sector) in self.sectors.iter().enumerate() {
            let now = displacement(&self.harmonic, self.rows.stride, fourier, sensor, sector);
            self.history.displacement[sensor].push(now);
        }
        if let Some(detail) = &mut self.detail {
            detail.sample(step, energy);
        }
    }

    /// Adds the largest size of the last reading at any sector to every sensor's line.
    #[inline(always)]
    pub(super) fn largest(&self, fourier: &SectorFourier, lines: &mut [Vec<f64>]) {
        for (sensor, line) in lines.iter_mut().enumerate() {
            let at = |sector| displacement(&self.harmonic, self.rows.stride, fourier, sensor, sector).abs();
            line.push((0..fourier.sectors()).map(at).fold(0.0, f64::max));
        }
    }

    /// Records the tips at a sample of the window; `force` as of [`Self::read`].
    #[inline(always)]
    pub(super) fn look_at_tips<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        force: Option<&[f64]>,
    ) {
        self.tips.sample(simd, oscillators, fourier, force);
    }

    /// Stores all modes at a sample, if they are asked for; `force` as of [`Self::read`].
    #[inline(always)]
    pub(super) fn keep_state(
        &mut self,
        step: u64,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        force: Option<&[f64]>,
    ) {
        if let Some(states) = &mut self.states {
            states.sample(step, oscillators, fourier, force);
        }
    }

    /// Interval of contact to fill between this sample and the last one, where it is asked for.
    #[inline(always)]
    pub(super) fn contact_interval(&mut self, step: u64) -> Option<&mut ContactInterval> {
        self.detail.as_mut()?.interval(step)
    }

    /// Takes note that the run ends because its motion repeats: one period of it is recorded from now on.
    pub(super) fn end_after(&mut self, repeated: Repeated) {
        self.history.repeated = Some(repeated);
        self.decimation.shorten(self.samples_per_revolution * repeated.period);
        if let Some(detail) = &mut self.detail {
            detail.end_after(repeated);
        }
        if let Some(states) = &mut self.states {
            states.end_after(repeated);
        }
    }

    pub(super) fn end_revolution(&mut self, oscillators: &Oscillators) {
        if self.energies {
            self.history.energies.push(oscillators.energies().collect());
        }
    }

    /// Ends the run of `wheel` after `steps`, with its modes and its casing as they are.
    pub(super) fn end(
        &mut self,
        wheel: &ModalWheel,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        modes: Vec<InitialMode>,
        casing: Vec<SteppedWave>,
        steps: u64,
    ) {
        (self.history.end, self.history.casing_end) = (modes, casing);
        self.history.tips = self.tips.motions();
        self.history.excursion = self.tips.excursion();
        self.history.detail = self.detail.take().map(|detail| Box::new(detail.end(steps)));
        let states = self.states.take().map(|states| states.end(&wheel.harmonics, oscillators));
        self.history.states = states.map(Box::new);
        let sensors = self.sectors.len();
        let columns = self.reading.len() / sensors.max(1);
        let line = |sensor: usize| {
            (0..columns).map(|column| self.decimation.line(column * sensors + sensor)).collect()
        };
        self.history.harmonics = (0..sensors).map(line).collect();
        let window = |(columns, &sector): (&Vec<Vec<f64>>, &usize)| {
            let at = |sample: usize| {
                fourier.row(sector).iter().zip(columns).map(|(f, column)| f * column[sample]).sum()
            };
            (0..columns.first().map_or(0, Vec::len)).map(at).collect()
        };
        self.history.window = self.history.harmonics.iter().zip(&self.sectors).map(window).collect();
    }

    pub(super) fn take(&mut self) -> History {
        std::mem::take(&mut self.history)
    }
}

/// Displacement at a sector, from Fourier coordinates.
#[inline(always)]
fn displacement(
    harmonic: &[f64],
    stride: usize,
    fourier: &SectorFourier,
    sensor: usize,
    sector: usize,
) -> f64 {
    let row = fourier.row(sector).iter().enumerate();
    row.map(|(column, f)| f * harmonic[column * stride + sensor]).sum()
}
