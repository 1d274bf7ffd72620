//! Histories of two revolutions from rest, and their differences.

use rubmap::dynamics::integrate::{Outcome, SensorRow, Simulation};

use crate::scene::{Scene, Stepping, TOUCHING, radial};
use crate::timing::timed;

pub(crate) const REVOLUTIONS: usize = 2;
/// Samples a revolution; steps are multiples of it.
pub(crate) const SAMPLES: usize = 100;

/// Radial displacements at `sensors`, one after the other.
pub(crate) struct Recorded {
    pub(crate) values: Vec<f64>,
    pub(crate) contact_share: f64,
    /// Wall time with the run's set-up, s.
    pub(crate) time: f64,
}

/// Sensors at leading edge, middle and trailing edge of three blades.
pub(crate) fn sensors(scene: &Scene) -> Vec<SensorRow> {
    let last = scene.reduced.wheel.contact.len() - 1;
    [0, 3, 7].into_iter().flat_map(|sector| [0, last / 2, last].map(|node| radial(node, sector))).collect()
}

/// Number of steps per revolution, at least `steps`, that the samples divide.
pub(crate) fn sampled(steps: f64) -> usize {
    (steps.ceil() as usize).next_multiple_of(SAMPLES)
}

pub(crate) fn history(scene: &Scene, stepping: Stepping) -> Recorded {
    let casing = scene.casing(TOUCHING);
    let sensors = sensors(scene);
    let simulation = Simulation {
        samples_per_revolution: SAMPLES,
        revolutions: REVOLUTIONS,
        window_revolutions: 0,
        ..scene.simulation(stepping, &casing, &sensors)
    };
    let (run, time) = timed(|| simulation.run(&|_| true));
    let Outcome::Completed(history) = run.outcome else { panic!("{stepping:?}: {:?}", run.outcome) };
    Recorded { values: history.displacement.concat(), contact_share: run.statistics.contact_share(), time }
}

/// Relative error of a history: root mean square of the difference over that of `reference`.
pub(crate) fn error(values: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(values.len(), reference.len());
    let square = |sum: f64, x: f64| sum + x * x;
    let difference = values.iter().zip(reference).map(|(a, b)| a - b).fold(0.0, square);
    (difference / reference.iter().copied().fold(0.0, square)).sqrt()
}
