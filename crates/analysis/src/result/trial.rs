//! Result and cost of a trial.

use serde::{Deserialize, Serialize};

use crate::request::Integration;
use crate::result::point::{Point, PointStatus};
use rubmap_wheel::response::sensitivity::Sensitivity;
use rubmap_wheel::response::settling::Verdict;

/// Cost of a run in CPU time of its thread, from some repetitions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Cost {
    /// CPU time before the first step, s: eigenproblems at the speed, tables of contact and casing. Without the reduction.
    pub set_up_s: f64,
    /// CPU time of one revolution, s.
    pub per_revolution_s: f64,
    /// Number of repetitions, whose medians are given.
    pub repetitions: u32,
    /// Half the range of `per_revolution_s` over the repetitions, relative to its median; absent where the run was long enough
    /// to be timed once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spread: Option<f64>,
}

impl Cost {
    /// CPU time of a run of `revolutions`, s.
    pub fn of_run(&self, revolutions: f64) -> f64 {
        self.set_up_s + revolutions * self.per_revolution_s
    }

    /// Computes medians and spread from (set-up, per revolution) of every repetition.
    pub(crate) fn of(mut repetitions: Vec<(f64, f64)>) -> Self {
        let count = repetitions.len();
        let median = |of: fn(&(f64, f64)) -> f64, repetitions: &mut Vec<(f64, f64)>| {
            repetitions.sort_by(|a, b| of(a).total_cmp(&of(b)));
            of(&repetitions[count / 2])
        };
        let set_up_s = median(|r| r.0, &mut repetitions);
        let per_revolution_s = median(|r| r.1, &mut repetitions);
        let range = repetitions[count - 1].1 - repetitions[0].1;
        let spread = (count > 1 && per_revolution_s > 0.0).then(|| 0.5 * range / per_revolution_s);
        Self { set_up_s, per_revolution_s, repetitions: count as u32, spread }
    }
}

/// Result of a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Point, as a sweep would report it.
    pub point: Point,
    /// Real unknowns that are integrated.
    pub unknowns: u32,
    /// Amplitudes at the integer engine orders from 1 on, `[sensor][engine order]`, of a completed run.
    pub lines: Vec<Vec<f64>>,
    /// Root mean squares over successive parts of the window, `[sensor][block]`, of a completed run.
    pub levels: Vec<Vec<f64>>,
    /// Displacement over the first revolutions, `[sensor][sample]`.
    pub history: Vec<Vec<f64>>,
    /// Samples of a revolution of `history`.
    pub samples_per_revolution: u32,
    /// Growth of a tiny perturbation, which decides whether trajectories can be compared; of a completed trial with a twin.
    pub sensitivity: Option<Sensitivity>,
    /// Cost of the trial.
    pub cost: Cost,
}

impl Trial {
    /// Whether the trial was integrated to its end.
    pub(crate) fn is_completed(&self) -> bool {
        self.point.status == PointStatus::Completed
    }

    /// Number of revolutions of a run like this trial.
    pub(crate) fn revolutions(&self, asked: &Integration) -> f64 {
        // A response that was solved for costs as much as the longest march.
        let marched = self.point.march.as_ref().filter(|_| self.point.steady.is_none());
        f64::from(marched.map_or(asked.revolutions(), |march| march.revolutions))
    }

    /// Whether the steady response repeats.
    pub(crate) fn repeats(&self) -> bool {
        repeats(&self.point)
    }
}

/// Whether the steady response of a speed repeats.
pub(crate) fn repeats(point: &Point) -> bool {
    let verdict = point.settling.as_ref().map(|settling| settling.verdict);
    matches!(verdict, Some(Verdict::Periodic | Verdict::Subharmonic))
}
