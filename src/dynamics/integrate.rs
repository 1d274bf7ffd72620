//! Central differences with contact: the step loop, top to bottom (Eqs 8–10).
//!
//! Per step: predict every modal oscillator (Eq. 8), read the normal displacement of every contact node, solve
//! the complementarity problem of the gaps (Eqs 9, 10), correct the oscillators by the contact forces.

use std::f64::consts::{PI, TAU};

use pulp::{Simd, WithSimd};

use super::casing::{Casing, RestrictionTable};
use super::contact::delassus::Delassus;
use super::energy::EnergyAudit;
use super::modal_wheel::ModalWheel;
use super::oscillators::{Direction, LANES, ModalDamping, Oscillators, Rows};
use super::sector::ContactNode;
use super::statistics::RunStatistics;
use crate::numerics::complementarity::{ActiveSetSolver, ComplementarityError};
use crate::numerics::sector_fourier::SectorFourier;

/// One simulation of the wheel at its speed, from rest.
#[derive(Debug, Clone, Copy)]
pub struct Simulation<'a> {
    /// The wheel in modal coordinates.
    pub wheel: &'a ModalWheel,
    /// Contact nodes from leading to trailing edge.
    pub contact_nodes: &'a [ContactNode],
    /// Modal damping; absent: none.
    pub damping: Option<&'a ModalDamping>,
    /// Casing that the blades may touch; absent: none.
    pub casing: Option<&'a Casing>,
    /// Recorded displacements.
    pub sensors: &'a [SensorRow],
    /// Steps S per revolution, above the stability limit.
    pub steps_per_revolution: usize,
    /// Recorded samples per revolution, a divisor of S.
    pub samples_per_revolution: usize,
    /// Revolutions to simulate.
    pub revolutions: usize,
    /// Revolutions at the end for which nodal-diameter coordinates are recorded.
    pub window_revolutions: usize,
}

/// A recorded displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorRow {
    /// Where and along what.
    pub direction: Direction,
    /// At which sector.
    pub sector: usize,
}

/// What a simulation recorded.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// `[sensor][sample]`: displacement at the sensor's sector, over the whole run.
    pub displacement: Vec<Vec<f64>>,
    /// `[sensor][Fourier column][sample]`: coordinates of all sectors in the real orthonormal Fourier basis, over the
    /// window.
    pub harmonics: Vec<Vec<Vec<f64>>>,
}

/// How a simulation ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// All revolutions were integrated.
    Completed(History),
    /// A tip moved by more than a tenth of the wheel's radius, or a number overflowed, after so many revolutions.
    Diverged {
        /// Revolutions integrated until then.
        revolutions: f64,
    },
    /// The contact problem of a step could not be solved.
    ContactFailed {
        /// Revolutions integrated until then.
        revolutions: f64,
        /// Why.
        error: ComplementarityError,
    },
    /// The caller asked to stop.
    Cancelled,
}

/// Outcome with its credentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// How it ended.
    pub outcome: Outcome,
    /// What was counted.
    pub statistics: RunStatistics,
    /// The energy identity.
    pub energy: EnergyAudit,
}

/// Smallest number of steps per revolution that is stable: h = 2π/(ΩS) < 2/ω_max. At the limit itself the energy
/// grows without bound while displacements still look right, so S must exceed π ω_max/Ω.
pub fn smallest_stable_steps(largest_frequency: f64, speed_rad_s: f64) -> u64 {
    ((PI * largest_frequency / speed_rad_s).floor() as u64).saturating_add(1)
}

/// A restriction table larger than this many values (2 GiB) is refused.
pub const MAX_TABLE_VALUES: usize = 1 << 28;

/// Displacements beyond this share of the largest contact radius end a run as diverged: linear structural theory is
/// void long before.
const DIVERGED_SHARE_OF_RADIUS: f64 = 0.1;

/// Steps between two looks at progress and cancellation: some tens of milliseconds.
const WATCHED_STEPS: u64 = 1 << 14;

impl Simulation<'_> {
    /// Runs the simulation. `watch` is called now and then with the share of work done; `false` stops the run.
    ///
    /// # Panics
    /// If the sample count does not divide the step count, or the window exceeds the run.
    pub fn run(&self, watch: &dyn Fn(f64) -> bool) -> Run {
        assert!(self.steps_per_revolution.is_multiple_of(self.samples_per_revolution));
        assert!(self.window_revolutions <= self.revolutions);
        let mut stepper = Stepper::new(self);
        pulp::Arch::new().dispatch(Loop { simulation: self, stepper: &mut stepper, watch })
    }

    /// Runs against a restriction of any shape instead of the casing's lobes.
    #[cfg(test)]
    pub(super) fn run_against(&self, restriction: RestrictionTable, watch: &dyn Fn(f64) -> bool) -> Run {
        let mut stepper = Stepper::new(self);
        if let Some(obstacle) = &mut stepper.obstacle {
            obstacle.restriction = Some(restriction);
        }
        pulp::Arch::new().dispatch(Loop { simulation: self, stepper: &mut stepper, watch })
    }

    /// Normal displacement of a tip beyond which a run ends as diverged; without bound where all tips lie on the axis.
    fn reach(&self) -> f64 {
        let radius = self.contact_nodes.iter().fold(0.0f64, |r, node| r.max(node.position[0]));
        if radius > 0.0 { DIVERGED_SHARE_OF_RADIUS * radius } else { f64::INFINITY }
    }

    fn step_s(&self) -> f64 {
        TAU / (self.wheel.speed_rad_s * self.steps_per_revolution as f64)
    }
}

/// Everything a step changes or reads; built before the loop, nothing is allocated in it.
#[derive(Debug)]
struct Stepper {
    fourier: SectorFourier,
    oscillators: Oscillators,
    obstacle: Option<Obstacle>,
    recorder: Recorder,
    statistics: RunStatistics,
    energy: EnergyAudit,
}

/// Contact between the blades and the casing.
#[derive(Debug)]
struct Obstacle {
    rows: Rows,
    delassus: Delassus,
    solver: ActiveSetSolver,
    casing: Casing,
    restriction: Option<RestrictionTable>,
    /// p = 0 of a circular casing.
    unrestricted: Vec<f64>,
    /// c_k, padded with +∞.
    clearance: Vec<f64>,
    tolerance: f64,
    /// `[Fourier column][node]`
    harmonic: Vec<f64>,
    /// nᵀu at q+1, q and q−1: `[sector][node]`.
    normal: [Vec<f64>; 3],
    predicted_gap: Vec<f64>,
    /// c − p of this step.
    free_gap: Vec<f64>,
    /// Contact nodes with a force on any sector.
    loaded: Vec<usize>,
    is_loaded: Vec<bool>,
    force: Vec<f64>,
}

#[derive(Debug)]
struct Recorder {
    rows: Rows,
    sectors: Vec<usize>,
    harmonic: Vec<f64>,
    history: History,
}

impl Stepper {
    fn new(simulation: &Simulation<'_>) -> Self {
        let wheel = simulation.wheel;
        let fourier = SectorFourier::new(wheel.sectors);
        let oscillators = Oscillators::new(wheel, simulation.step_s(), simulation.damping);
        let obstacle =
            simulation.casing.map(|casing| Obstacle::new(simulation, casing, &oscillators, &fourier));
        let recorder = Recorder::new(simulation, &fourier);
        Self {
            fourier,
            oscillators,
            obstacle,
            recorder,
            statistics: RunStatistics::default(),
            energy: EnergyAudit::default(),
        }
    }
}

/// The loop as a value, so that the whole of it is compiled for the widest vectors of the machine.
struct Loop<'a> {
    simulation: &'a Simulation<'a>,
    stepper: &'a mut Stepper,
    watch: &'a dyn Fn(f64) -> bool,
}

impl WithSimd for Loop<'_> {
    type Output = Run;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Run {
        let outcome = match (self.simulation.damping.is_some(), self.stepper.obstacle.is_some()) {
            (true, true) => self.stepper.integrate::<S, true, true>(simd, self.simulation, self.watch),
            (true, false) => self.stepper.integrate::<S, true, false>(simd, self.simulation, self.watch),
            (false, true) => self.stepper.integrate::<S, false, true>(simd, self.simulation, self.watch),
            (false, false) => self.stepper.integrate::<S, false, false>(simd, self.simulation, self.watch),
        };
        let outcome = match outcome {
            Ok(()) => Outcome::Completed(std::mem::take(&mut self.stepper.recorder.history)),
            Err(ended) => ended,
        };
        Run { outcome, statistics: self.stepper.statistics, energy: self.stepper.energy }
    }
}

impl Stepper {
    #[inline(always)]
    fn integrate<S: Simd, const DAMPED: bool, const CONTACT: bool>(
        &mut self,
        simd: S,
        simulation: &Simulation<'_>,
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<(), Outcome> {
        let steps = simulation.steps_per_revolution;
        let sampling = steps / simulation.samples_per_revolution;
        let reach = simulation.reach();
        let window_start = simulation.revolutions - simulation.window_revolutions;
        for revolution in 0..simulation.revolutions {
            for step in 1..=steps {
                let revolutions = revolution as f64 + step as f64 / steps as f64;
                let loss = self.oscillators.advance::<S, DAMPED>(simd);
                if DAMPED {
                    self.energy.add_loss(loss);
                }
                if CONTACT {
                    self.resolve_contact::<S, DAMPED>(simd, step % steps, revolutions)?;
                }
                self.statistics.steps += 1;
                if self.statistics.steps.is_multiple_of(WATCHED_STEPS)
                    && !watch(revolutions / simulation.revolutions as f64)
                {
                    return Err(Outcome::Cancelled);
                }
                if step % sampling == 0 {
                    let energy = self.oscillators.energy();
                    self.energy.check(energy);
                    self.recorder.record(simd, &self.oscillators, &self.fourier, revolution >= window_start);
                    if !energy.is_finite() || self.largest_normal_displacement() > reach {
                        return Err(Outcome::Diverged { revolutions });
                    }
                }
            }
        }
        Ok(())
    }

    /// Eqs 9 and 10 for the step that `advance` has predicted; `step` is its position in the revolution.
    #[inline(always)]
    fn resolve_contact<S: Simd, const DAMPED: bool>(
        &mut self,
        simd: S,
        step: usize,
        revolutions: f64,
    ) -> Result<(), Outcome> {
        let Some(obstacle) = &mut self.obstacle else { return Ok(()) };
        obstacle.normal.rotate_right(1);
        self.oscillators.project(simd, &obstacle.rows, &mut obstacle.harmonic);
        if obstacle.predict_gaps(simd, &self.fourier, step, revolutions) >= 0.0 {
            return Ok(());
        }
        obstacle
            .solver
            .solve(&obstacle.delassus, &obstacle.predicted_gap, obstacle.tolerance)
            .map_err(|error| Outcome::ContactFailed { revolutions, error })?;
        let work = obstacle.apply_forces(&self.fourier, self.oscillators.step(), &mut self.statistics);
        self.energy.add_work(work);
        let loss =
            self.oscillators.correct::<S, DAMPED>(simd, &obstacle.rows, &obstacle.loaded, &obstacle.force);
        if DAMPED {
            self.energy.add_loss(loss);
        }
        Ok(())
    }

    fn largest_normal_displacement(&self) -> f64 {
        self.obstacle.as_ref().map_or(0.0, |o| o.normal[0].iter().fold(0.0, |m, u| m.max(u.abs())))
    }
}

impl Obstacle {
    fn new(
        simulation: &Simulation<'_>,
        casing: &Casing,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
    ) -> Self {
        let nodes = simulation.contact_nodes;
        let normals: Vec<_> = nodes
            .iter()
            .enumerate()
            .map(|(node, contact)| Direction { node, components: contact.normal })
            .collect();
        let rows = Rows::new(simulation.wheel, &normals);
        let (stride, sectors) = (rows.stride, fourier.sectors());
        let angles: Vec<_> = nodes.iter().map(|node| node.position[1]).collect();
        let restriction = casing.restriction.map(|restriction| {
            let profile = |angle| restriction.height(angle);
            RestrictionTable::new(profile, &angles, simulation.steps_per_revolution, sectors, stride)
        });
        let mut clearance = casing.clearance.clone();
        clearance.resize(stride, f64::INFINITY);
        let delassus = Delassus::new(simulation.wheel, &rows, oscillators, fourier);
        let size = sectors * stride;
        Self {
            delassus,
            solver: ActiveSetSolver::new(size),
            restriction,
            unrestricted: vec![0.0; stride],
            clearance,
            // Gaps are differences of lengths of this scale. A casing far out of reach of some node must not loosen it.
            tolerance: 1e-14 * casing.length_scale(simulation.reach()),
            casing: casing.clone(),
            harmonic: vec![0.0; size],
            normal: std::array::from_fn(|_| vec![0.0; size]),
            predicted_gap: vec![0.0; size],
            free_gap: vec![0.0; size],
            loaded: Vec::with_capacity(stride),
            is_loaded: vec![false; stride],
            force: vec![0.0; size],
            rows,
        }
    }

    /// Normal displacements of all sectors from their Fourier coordinates, and g_p = c − p − nᵀu, whose smallest value
    /// is returned.
    #[inline(always)]
    fn predict_gaps<S: Simd>(
        &mut self,
        simd: S,
        fourier: &SectorFourier,
        step: usize,
        revolutions: f64,
    ) -> f64 {
        let mut smallest = simd.splat_f64s(f64::INFINITY);
        let stride = self.rows.stride;
        let vectors = stride / S::F64_LANES;
        let growth = simd.splat_f64s(self.casing.growth(revolutions));
        let clearance = &S::as_simd_f64s(&self.clearance).0[..vectors];
        let harmonic = S::as_simd_f64s(&self.harmonic).0;
        for sector in 0..fourier.sectors() {
            let range = sector * stride..(sector + 1) * stride;
            let normal = &mut S::as_mut_simd_f64s(&mut self.normal[0][range.clone()]).0[..vectors];
            let free_gap = &mut S::as_mut_simd_f64s(&mut self.free_gap[range.clone()]).0[..vectors];
            let gap = &mut S::as_mut_simd_f64s(&mut self.predicted_gap[range]).0[..vectors];
            let restricted = match &self.restriction {
                Some(table) => table.at(step, sector),
                None => &self.unrestricted,
            };
            let restricted = &S::as_simd_f64s(restricted).0[..vectors];
            for v in 0..vectors {
                let mut u = simd.splat_f64s(0.0);
                for (&f, column) in fourier.row(sector).iter().zip(harmonic.chunks_exact(vectors)) {
                    u = simd.mul_add_e_f64s(simd.splat_f64s(f), column[v], u);
                }
                let free = simd.negate_mul_add_e_f64s(growth, restricted[v], clearance[v]);
                normal[v] = u;
                free_gap[v] = free;
                gap[v] = simd.sub_f64s(free, u);
                smallest = simd.min_f64s(smallest, gap[v]);
            }
        }
        simd.reduce_min_f64s(smallest)
    }

    /// Takes the solved λ: forces in Fourier coordinates, corrected normal displacements, statistics. Returns the
    /// work of the forces fᵀ(u_{q+1} − u_{q−1})/2.
    #[inline(always)]
    fn apply_forces(&mut self, fourier: &SectorFourier, step_s: f64, statistics: &mut RunStatistics) -> f64 {
        let stride = self.rows.stride;
        let gap = self.solver.gap();
        for ((u, &free), &g) in self.normal[0].iter_mut().zip(&self.free_gap).zip(gap) {
            // Padding has an infinite gap.
            if g < f64::INFINITY {
                *u = free - g;
            }
        }
        let deepest = -lowest(gap);
        statistics.largest_penetration = statistics.largest_penetration.max(deepest);
        statistics.pivots = self.solver.statistics();
        for &row in &self.loaded {
            self.is_loaded[row] = false;
            for column in 0..fourier.sectors() {
                self.force[column * stride + row] = 0.0;
            }
        }
        self.loaded.clear();
        let (mut work, mut impulse) = (0.0, 0.0);
        for (&index, &lambda) in self.solver.active().iter().zip(self.solver.lambda()) {
            let (sector, row) = (index / stride, index % stride);
            if !self.is_loaded[row] {
                self.is_loaded[row] = true;
                self.loaded.push(row);
            }
            for (column, &f) in fourier.row(sector).iter().enumerate() {
                self.force[column * stride + row] -= f * lambda;
            }
            work -= 0.5 * lambda * (self.normal[0][index] - self.normal[2][index]);
            impulse += lambda * step_s;
            let smallest = statistics.smallest_multiplier.map_or(lambda, |least| least.min(lambda));
            statistics.smallest_multiplier = Some(smallest);
        }
        if impulse > 0.0 {
            statistics.contact_steps += 1;
            statistics.contact_impulse += impulse;
        }
        work
    }
}

/// The smallest of 0 and `values`, whose number is a multiple of the lanes; lane by lane, so that it vectorises.
#[inline(always)]
fn lowest(values: &[f64]) -> f64 {
    let mut lanes = [0.0f64; LANES];
    for chunk in values.chunks_exact(LANES) {
        for (low, &value) in lanes.iter_mut().zip(chunk) {
            *low = if value < *low { value } else { *low };
        }
    }
    lanes.iter().fold(0.0, |low, &value| low.min(value))
}

impl Recorder {
    fn new(simulation: &Simulation<'_>, fourier: &SectorFourier) -> Self {
        let directions: Vec<_> = simulation.sensors.iter().map(|sensor| sensor.direction).collect();
        let rows = Rows::new(simulation.wheel, &directions);
        let whole = simulation.samples_per_revolution * simulation.revolutions;
        let window = simulation.samples_per_revolution * simulation.window_revolutions;
        let sensors = directions.len();
        Self {
            harmonic: vec![0.0; fourier.sectors() * rows.stride],
            sectors: simulation.sensors.iter().map(|sensor| sensor.sector).collect(),
            history: History {
                displacement: (0..sensors).map(|_| Vec::with_capacity(whole)).collect(),
                harmonics: (0..sensors)
                    .map(|_| (0..fourier.sectors()).map(|_| Vec::with_capacity(window)).collect())
                    .collect(),
            },
            rows,
        }
    }

    #[inline(always)]
    fn record<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        windowed: bool,
    ) {
        oscillators.project(simd, &self.rows, &mut self.harmonic);
        let stride = self.rows.stride;
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
}
