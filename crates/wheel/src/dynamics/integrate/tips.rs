//! Motion of the tips: every component of every contact node of every blade, over the window.

use pulp::Simd;

use super::super::bending::Bending;
use super::super::direction::{COMPONENTS, Direction};
use super::super::oscillators::Oscillators;
use super::super::oscillators::rows::Rows;
use super::carried::Carried;
use super::excursion::{Excursion, ExcursionTally};
use super::residual::ResidualDisplacement;
use super::second_order::SecondOrder;
use super::simulation::Simulation;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Motion of one component of one contact node of one blade over the window, from some 128 instants of a revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipMotion {
    /// Root mean square about the mean, length.
    pub rms: f64,
    /// Half the peak-to-peak displacement, length.
    pub half_peak_to_peak: f64,
}

/// Number of instants of a revolution at which tips are read, about: enough for levels, few enough to cost next to nothing.
const INSTANTS: usize = 128;

/// Sums over the window.
#[derive(Debug)]
pub(super) struct TipTally {
    rows: Rows,
    /// Number of components of all nodes of a blade.
    components: usize,
    residual: ResidualDisplacement,
    /// Displacements of second order of blades that bend far, and the share of the motion that their coordinates carry.
    second_order: Option<(SecondOrder, Carried)>,
    harmonic: Vec<f64>,
    /// Number of samples from one reading to the next.
    every: usize,
    samples: usize,
    looks: u32,
    /// Sums of the motion, `[sector][node][component]`.
    motions: Vec<Sums>,
    /// Displacements now, `[sector][node][component]`.
    now: Vec<f64>,
    excursion: ExcursionTally,
}

#[derive(Debug, Clone, Copy)]
struct Sums {
    /// Offset subtracted before squares are summed: the first value.
    origin: f64,
    sum: f64,
    squares: f64,
    low: f64,
    high: f64,
}

impl TipTally {
    pub(super) fn new(simulation: &Simulation<'_>) -> Self {
        let Simulation { wheel, scheme, .. } = *simulation;
        let nodes = 0..simulation.contact_nodes.len();
        let unit = |d: usize| std::array::from_fn(|component| if component == d { 1.0 } else { 0.0 });
        let directions: Vec<Direction> = nodes
            .flat_map(|node| (0..COMPONENTS).map(move |d| Direction { node, components: unit(d) }))
            .collect();
        let bending = simulation.effects.bending;
        let second_order =
            bending.map(|bending| (SecondOrder::along(bending, &directions), Carried::new(bending.blade)));
        let read: Vec<_> =
            directions.iter().copied().chain(bending.iter().flat_map(Bending::directions)).collect();
        let rows = Rows::new(wheel, &read, |modes| scheme.integrated_modes(modes));
        let none = Sums { origin: 0.0, sum: 0.0, squares: 0.0, low: f64::INFINITY, high: f64::NEG_INFINITY };
        Self {
            residual: ResidualDisplacement::new(simulation, &read),
            second_order,
            harmonic: vec![0.0; wheel.sectors * rows.stride],
            components: directions.len(),
            every: simulation.samples_per_revolution.div_ceil(INSTANTS),
            samples: 0,
            looks: 0,
            motions: vec![none; wheel.sectors * directions.len()],
            now: vec![0.0; wheel.sectors * directions.len()],
            excursion: ExcursionTally::new(simulation),
            rows,
        }
    }

    /// Reads the tips at a sample of the window, if it is time; `force` as of [`ResidualDisplacement::add`].
    #[inline(always)]
    pub(super) fn sample<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        force: Option<&[f64]>,
    ) {
        self.samples += 1;
        if !self.samples.is_multiple_of(self.every) {
            return;
        }
        let Self { rows, harmonic, .. } = self;
        oscillators.project(simd, rows, harmonic);
        if let Some(force) = force {
            self.residual.add(force, force.len() / fourier.sectors(), harmonic, rows.stride);
        }
        if let Some((second_order, carried)) = &mut self.second_order {
            carried.look(harmonic, rows.stride);
            second_order.add(fourier, harmonic);
        }
        let columns = harmonic.chunks_exact(rows.stride);
        let components = self.components;
        let blades = self.motions.chunks_exact_mut(components).zip(self.now.chunks_exact_mut(components));
        for (sector, (blade, now)) in blades.enumerate() {
            for (row, (sums, now)) in blade.iter_mut().zip(now).enumerate() {
                let terms = fourier.row(sector).iter().zip(columns.clone());
                *now = terms.map(|(f, column)| f * column[row]).sum();
                sums.add(*now, self.looks == 0);
            }
        }
        self.excursion.look(&self.now);
        self.looks += 1;
    }

    /// Motion of the tips, `[sector][contact node][component]`, one after the other.
    pub(super) fn motions(&self) -> Vec<TipMotion> {
        self.motions.iter().map(|sums| sums.motion(f64::from(self.looks))).collect()
    }

    pub(super) fn excursion(&self) -> Excursion {
        let outside_coordinates = self.second_order.as_ref().map_or(0.0, |(_, carried)| carried.outside());
        Excursion { outside_coordinates, ..self.excursion.found() }
    }
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, value: f64, first: bool) {
        if first {
            self.origin = value;
        }
        let moved = value - self.origin;
        self.sum += moved;
        self.squares += moved * moved;
        self.low = self.low.min(moved);
        self.high = self.high.max(moved);
    }

    fn motion(&self, looks: f64) -> TipMotion {
        let mean = self.sum / looks;
        TipMotion {
            rms: (self.squares / looks - mean * mean).max(0.0).sqrt(),
            half_peak_to_peak: 0.5 * (self.high - self.low),
        }
    }
}
