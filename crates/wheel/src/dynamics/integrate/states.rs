//! States of the whole wheel, by all its modes, at the samples of chosen revolutions.

use faer::{Mat, c64};

use super::super::modal_wheel::ModalHarmonic;
use super::super::oscillators::Oscillators;
use super::super::schemes::Scheme;
use super::residual::applied;
use super::revolutions::{Repeated, Revolutions};
use super::simulation::Simulation;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Modal coordinates at some instants.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalStates {
    /// Instants, in revolutions since the start.
    pub revolutions: Vec<f64>,
    /// Modal coordinates z per nodal diameter of the wheel, `modes × instants`; modes that are not integrated follow the contact forces.
    pub harmonics: Vec<Mat<c64>>,
}

/// Recorder of [`ModalStates`].
#[derive(Debug)]
pub(super) struct StateRecorder {
    asked: Revolutions,
    /// Whole revolutions after which recording begins and ends.
    revolutions: (usize, usize),
    steps_per_revolution: usize,
    following: Vec<Following>,
    /// Number of force values of a sample; 0 where no mode follows forces.
    forces: usize,
    instants: Vec<f64>,
    /// Modal coordinates z as the oscillators store them, `[sample][number]`.
    modes: Vec<f64>,
    /// Contact forces, `[sample][column][node]`.
    force: Vec<f64>,
}

/// Modes of a nodal diameter that are not integrated.
#[derive(Debug)]
struct Following {
    /// Displacements z per unit force, `modes × directions`.
    receptance: Mat<c64>,
    /// Fourier column of the real part.
    column: usize,
    single: bool,
}

impl StateRecorder {
    pub(super) fn new(simulation: &Simulation<'_>, asked: Revolutions, oscillators: &Oscillators) -> Self {
        let revolutions = asked.of(simulation.revolutions, None);
        let (wheel, scheme) = (simulation.wheel, simulation.scheme);
        let samples = simulation.samples_per_revolution * (revolutions.1 - revolutions.0);
        let follows = matches!(scheme, Scheme::MasslessBoundary { .. }) && simulation.casing.is_some();
        let directions = if follows { applied(simulation) } else { Vec::new() };
        let mut column = 0;
        let following = wheel.harmonics.iter().map(|modes| {
            let integrated = scheme.integrated_modes(modes.omega.len());
            let of = |mode: usize, direction: usize| {
                let mode = integrated + mode;
                directions[direction].of(modes.contact.as_ref(), mode).conj() * modes.omega[mode].powi(-2)
            };
            let receptance = Mat::from_fn(modes.omega.len() - integrated, directions.len(), of);
            let following = Following { receptance, column, single: modes.single };
            column += if modes.single { 1 } else { 2 };
            following
        });
        let following = following.collect();
        let forces = wheel.sectors * directions.len();
        Self {
            asked,
            revolutions,
            steps_per_revolution: simulation.steps_per_revolution,
            following,
            forces,
            instants: Vec::with_capacity(samples),
            modes: Vec::with_capacity(samples * oscillators.positions().len()),
            force: Vec::with_capacity(samples * forces),
        }
    }

    /// Takes note that the run ends because its motion repeats.
    pub(super) fn end_after(&mut self, repeated: Repeated) {
        self.revolutions = self.asked.of(0, Some(repeated));
    }

    /// Stores the modes at a sample after `step`, if it is to be recorded; `force` as of
    /// [`ResidualDisplacement::add`](super::residual::ResidualDisplacement::add).
    #[inline(always)]
    pub(super) fn sample(
        &mut self,
        step: u64,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        force: Option<&[f64]>,
    ) {
        let end = |revolutions: usize| (revolutions * self.steps_per_revolution) as u64;
        if step <= end(self.revolutions.0) || step > end(self.revolutions.1) {
            return;
        }
        self.instants.push(step as f64 / self.steps_per_revolution as f64);
        self.modes.extend_from_slice(oscillators.positions());
        if let Some(force) = force.filter(|_| self.forces > 0) {
            let directions = self.forces / fourier.sectors();
            let columns = force.chunks_exact(force.len() / fourier.sectors());
            columns.for_each(|column| self.force.extend_from_slice(&column[..directions]));
        }
    }

    pub(super) fn end(self, wheel: &[ModalHarmonic], oscillators: &Oscillators) -> ModalStates {
        let width = oscillators.positions().len();
        let harmonic = |(index, (modes, following)): (usize, (&ModalHarmonic, &Following))| {
            let integrated = modes.omega.len() - following.receptance.nrows();
            Mat::from_fn(modes.omega.len(), self.instants.len(), |mode, sample| {
                match mode.checked_sub(integrated) {
                    None => {
                        oscillators.position(&self.modes[sample * width..(sample + 1) * width], index, mode)
                    }
                    Some(mode) => following
                        .position(mode, &self.force[sample * self.forces..(sample + 1) * self.forces]),
                }
            })
        };
        let harmonics = wheel.iter().zip(&self.following).enumerate().map(harmonic).collect();
        ModalStates { revolutions: self.instants, harmonics }
    }
}

impl Following {
    /// Displacement z of a mode under `force`, `[column][direction]`.
    fn position(&self, mode: usize, force: &[f64]) -> c64 {
        let directions = self.receptance.ncols();
        let at = |direction: usize| {
            let of = |column: usize| force.get(column * directions + direction).copied().unwrap_or(0.0);
            c64::new(of(self.column), if self.single { 0.0 } else { of(self.column + 1) })
        };
        (0..directions).map(|direction| self.receptance[(mode, direction)] * at(direction)).sum()
    }
}
