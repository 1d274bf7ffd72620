//! Flexibility within a step: displacements at its end by the forces in it.

use faer::{Mat, c64};

use super::super::contact::flexibility::flexibility;
use super::super::direction::Direction;
use super::super::oscillators::Oscillators;
use super::super::schemes::Scheme;
use super::super::schemes::massless_boundary::residual_flexibility;
use super::simulation::Simulation;

/// Displacements along `to` at the end of a step per unit force along `from` in it, per nodal diameter, `to.len() × from.len()`; a
/// boundary without mass moves by them at once.
pub(super) fn step_flexibility(
    simulation: &Simulation<'_>,
    oscillators: &Oscillators,
    to: &[Direction],
    from: &[Direction],
) -> Vec<Mat<c64>> {
    match simulation.scheme {
        Scheme::CentralDifferences | Scheme::ExactModal if simulation.wheel.turns() => {
            oscillators.turned_flexibility(simulation.wheel, simulation.step_s(), to, from)
        }
        _ => symmetric_flexibility(simulation, oscillators, to, from),
    }
}

/// Displacements as of [`step_flexibility`], without Coriolis forces.
pub(super) fn symmetric_flexibility(
    simulation: &Simulation<'_>,
    oscillators: &Oscillators,
    to: &[Direction],
    from: &[Direction],
) -> Vec<Mat<c64>> {
    match simulation.scheme {
        Scheme::CentralDifferences | Scheme::ExactModal => {
            flexibility(simulation.wheel, to, from, |harmonic, mode| oscillators.receptance(harmonic, mode))
        }
        Scheme::MasslessBoundary { kept_modes } => {
            residual_flexibility(simulation.wheel, kept_modes, to, from)
        }
    }
}
