//! What a convergence study says: errors, times, observed orders and the Pareto front (work and precision), and histories.

use serde::{Deserialize, Serialize};

use super::errors::{Errors, Quantity, errors, history_error};
use super::study_request::StudyRequest;
use super::trial::{Cost, Setting, Trial, TrialRequest};
use crate::auto_or::AutoOr;
use crate::request::{SchemeChoice, Sensor};
use crate::result::{PointStatus, ReductionReport, StiffeningVerdict, Verdict};
use crate::run::VERSION;
use rubmap_numerics::convergence::observed_order;
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::response::sensitivity::{Growth, Sensitivity};

/// Errors of every setting of a study against its reference, and what each costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WorkPrecision {
    /// One per speed.
    pub speeds: Vec<SpeedStudy>,
    /// The reductions it rests on, by `modes_per_speed`.
    pub reductions: Vec<StudyReduction>,
    /// The whole request as resolved.
    pub settings: StudyRequest,
    /// Version of the code.
    pub version: String,
}

/// A reduction that a study rests on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StudyReduction {
    /// k.
    pub modes_per_speed: u32,
    /// Real unknowns of the whole reduced wheel.
    pub wheel_unknowns: u32,
    /// Wall time when it was computed, s.
    pub wall_time_s: f64,
    /// How far K(Ω) can be trusted between the given speeds; absent of a study that an earlier version made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<StiffeningVerdict>,
}

/// One speed of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SpeedStudy {
    /// Ω in rad/s.
    pub speed_rad_s: f64,
    /// What all runs are held against; it has no errors.
    pub reference: StudyRun,
    /// Whether trajectories can be compared: the growth of a tiny perturbation of the reference. Absent if it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivity: Option<Sensitivity>,
    /// How to read the errors, in words.
    pub message: String,
    /// One per setting.
    pub runs: Vec<StudyRun>,
    /// Observed orders in the time step, one per size and scheme.
    pub orders: Vec<StepOrder>,
}

/// A setting of a study: its errors and its cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StudyRun {
    /// The setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// Real unknowns that are integrated; 0 if nothing was.
    pub unknowns: u32,
    /// How the run ended.
    pub status: PointStatus,
    /// Why, unless it was completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Steady-state verdict of a completed run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// Largest violation of the energy identity, relative to the largest energy seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy_residual: Option<f64>,
    /// Differences from the reference; absent unless both were completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<Errors>,
    /// CPU time.
    pub cost: Cost,
    /// CPU time of the whole run, s: `set_up_s` and all revolutions.
    pub time_s: f64,
    /// Quantities for which no other run has a smaller error in less time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pareto: Vec<Quantity>,
}

/// Observed order in the time step of one size and scheme, from the displacement over the first revolutions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StepOrder {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    pub modes_per_speed: u32,
    /// The scheme.
    pub scheme: SchemeChoice,
    /// Modes that `massless_boundary` was asked to integrate; with `auto` their number grows with the steps, and the order is
    /// that of both together.
    pub kept_modes: AutoOr,
    /// Steps per revolution, ascending.
    pub steps_per_revolution: Vec<u32>,
    /// Difference from the next finer step, relative; null where there is nothing to compare, and none for the last.
    pub differences: Vec<Option<f64>>,
    /// Order observed over each three successive steps; null where differences do not fall or are round-off.
    pub orders: Vec<Option<f64>>,
}

/// Displacements over the first revolutions, one line per size: the paper's Figs 6 and 7.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Histories {
    /// Ω in rad/s.
    pub speed_rad_s: f64,
    /// What is recorded.
    pub sensors: Vec<Sensor>,
    /// Samples of a revolution; the first is one sampling interval after the start.
    pub samples_per_revolution: u32,
    /// In ascending size, the reference last.
    pub lines: Vec<HistoryLine>,
    /// Units of the model.
    pub units: Units,
    /// Version of the code.
    pub version: String,
}

/// The displacements of one size at the finest step of the grid's first scheme that completed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct HistoryLine {
    /// The setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// Whether it is the reference.
    pub reference: bool,
    /// Real unknowns that are integrated.
    pub unknowns: u32,
    /// `[sensor][sample]`.
    pub displacement: Vec<Vec<f64>>,
}

/// A trial of a study with its setting.
struct Tried<'a> {
    setting: Setting,
    trial: &'a Trial,
}

impl Tried<'_> {
    fn completed(&self) -> bool {
        self.trial.point.status == PointStatus::Completed
    }

    fn run(&self, reference: Option<&Trial>, revolutions: u32) -> StudyRun {
        let point = &self.trial.point;
        StudyRun {
            setting: self.setting,
            unknowns: self.trial.unknowns,
            status: point.status,
            message: point.message.clone(),
            verdict: point.settling.as_ref().map(|settling| settling.verdict),
            energy_residual: point.energy_residual,
            errors: reference.and_then(|reference| errors(self.trial, reference)),
            cost: self.trial.cost,
            time_s: self.trial.cost.of_run(revolutions),
            pareto: Vec::new(),
        }
    }
}

/// What the finished trials of a resolved study say, with a document of histories for every speed; `trial` looks one up. None if
/// one is missing.
pub fn work_precision<'a>(
    request: &StudyRequest,
    (sectors, units): (u32, &Units),
    reports: &[ReductionReport],
    trial: &dyn Fn(&TrialRequest) -> Option<&'a Trial>,
) -> Option<(WorkPrecision, Vec<Histories>)> {
    let (mut speeds, mut histories) = (Vec::new(), Vec::new());
    for speed_rad_s in request.speeds.resolve().unwrap_or_default() {
        let (reference, grid) = request.trials(speed_rad_s, sectors);
        let reference = Tried { setting: request.reference(sectors), trial: trial(&reference)? };
        let settings = request.settings(sectors).into_iter().zip(&grid);
        let tried = settings.map(|(setting, request)| Some(Tried { setting, trial: trial(request)? }));
        let tried: Vec<Tried> = tried.collect::<Option<_>>()?;
        speeds.push(speed_study(request, speed_rad_s, &reference, &tried));
        histories.push(history_lines(request, speed_rad_s, units, &reference, &tried));
    }
    let reductions = reports
        .iter()
        .map(|report| StudyReduction {
            modes_per_speed: report.modes_per_speed,
            wheel_unknowns: report.wheel_unknowns,
            wall_time_s: report.wall_time_s,
            stiffening: Some(report.stiffening.verdict),
        })
        .collect();
    let settings = request.clone();
    Some((WorkPrecision { speeds, reductions, settings, version: VERSION.to_owned() }, histories))
}

fn speed_study(request: &StudyRequest, speed_rad_s: f64, reference: &Tried, tried: &[Tried]) -> SpeedStudy {
    let revolutions = request.integration.revolutions;
    let mut runs: Vec<StudyRun> =
        tried.iter().map(|tried| tried.run(Some(reference.trial), revolutions)).collect();
    // Trajectories that have separated differ by chance.
    let separated = reference.trial.sensitivity.and_then(|found| found.separated_after_revolutions);
    let comparable = separated.is_none_or(|revolution| revolution > request.history_revolutions);
    for quantity in Quantity::ALL.into_iter().filter(|&q| q != Quantity::History || comparable) {
        let places: Vec<Option<(f64, f64)>> =
            runs.iter().map(|run| Some((run.time_s, run.errors.as_ref()?.judged(quantity)?))).collect();
        for index in front(&places) {
            runs[index].pareto.push(quantity);
        }
    }
    SpeedStudy {
        speed_rad_s,
        message: in_words(reference, request.history_revolutions),
        sensitivity: reference.trial.sensitivity,
        reference: reference.run(None, revolutions),
        runs,
        orders: orders(tried),
    }
}

fn in_words(reference: &Tried, history_revolutions: u32) -> String {
    let point = &reference.trial.point;
    let Some(sensitivity) = reference.trial.sensitivity.filter(|_| reference.completed()) else {
        let why = point.message.as_deref().unwrap_or("its perturbed twin did not end");
        return format!("there is nothing to hold the runs against: {why}");
    };
    let rate = match sensitivity.rate_in_words() {
        Some(rate) => format!(" by {rate}"),
        None => String::new(),
    };
    let apart = match sensitivity.separated_after_revolutions {
        Some(revolution) if revolution <= history_revolutions => {
            format!(
                "; trajectories separate in revolution {revolution}, so that their histories are not comparable over \
                     {history_revolutions}"
            )
        }
        Some(revolution) => format!("; trajectories have separated after {revolution} revolutions"),
        None => String::new(),
    };
    let repeats = reference.trial.repeats();
    match sensitivity.growth {
        Growth::Chaotic => format!(
            "chaotic: a tiny perturbation of the reference grows{rate}{apart}. Later on only statistics are compared: \
             amplitudes with their spread over the window"
        ),
        Growth::QuasiPeriodic => format!(
            "quasi-periodic: a tiny perturbation of the reference neither grows nor decays; its rate is {}. Peaks at engine orders \
             are not compared",
            sensitivity.rate_in_words().unwrap_or_default()
        ),
        Growth::Stable if repeats => {
            "a tiny perturbation of the reference decays or stays small; all quantities can be compared".to_owned()
        }
        Growth::Stable => "a tiny perturbation of the reference decays; its response does not repeat, so that peaks at engine \
                           orders are not compared"
            .to_owned(),
        Growth::Undecided => format!(
            "the reference is too short to say whether it is chaotic: a tiny perturbation grows{rate}{apart}{}",
            if repeats { "" } else { ". Peaks at engine orders are not compared" }
        ),
    }
}

/// Indices of the points (time, error) that no other one is as good as in both and better in one.
pub fn front(points: &[Option<(f64, f64)>]) -> Vec<usize> {
    let beaten = |(time, error): (f64, f64)| {
        points.iter().flatten().any(|&(t, e)| t <= time && e <= error && (t < time || e < error))
    };
    let on =
        |(index, point): (usize, &Option<(f64, f64)>)| point.filter(|&point| !beaten(point)).map(|_| index);
    points.iter().enumerate().filter_map(on).collect()
}

/// Trials of the same size and scheme, ascending in steps.
fn orders(tried: &[Tried]) -> Vec<StepOrder> {
    let same = |a: &Tried, b: &Tried| {
        Setting { steps_per_revolution: 0, ..a.setting } == Setting { steps_per_revolution: 0, ..b.setting }
    };
    tried
        .chunk_by(same)
        .map(|line| {
            let completed: Vec<&Tried> = line.iter().filter(|tried| tried.completed()).collect();
            let steps: Vec<u32> = completed.iter().map(|tried| tried.setting.steps_per_revolution).collect();
            let differences: Vec<Option<f64>> =
                completed.windows(2).map(|pair| history_error(pair[0].trial, pair[1].trial)).collect();
            let order = |(n, d): (&[u32], &[Option<f64>])| {
                observed_order([n[0], n[1], n[2]].map(f64::from), [d[0]?, d[1]?])
            };
            StepOrder {
                modes_per_speed: line[0].setting.modes_per_speed,
                scheme: line[0].setting.scheme,
                kept_modes: line[0].setting.kept_modes,
                orders: steps.windows(3).zip(differences.windows(2)).map(order).collect(),
                steps_per_revolution: steps,
                differences,
            }
        })
        .collect()
}

fn history_lines(
    request: &StudyRequest,
    speed_rad_s: f64,
    units: &Units,
    reference: &Tried,
    tried: &[Tried],
) -> Histories {
    let mut sizes = request.grid.modes_per_speed.clone();
    sizes.sort_unstable();
    let finest = |&modes: &u32| {
        let of = |scheme: &SchemeChoice| {
            let here = |tried: &&Tried| {
                tried.completed() && tried.setting.modes_per_speed == modes && tried.setting.scheme == *scheme
            };
            tried.iter().filter(here).max_by_key(|tried| tried.setting.steps_per_revolution)
        };
        request.grid.schemes.iter().find_map(of)
    };
    let line = |(tried, reference): (&Tried, bool)| HistoryLine {
        setting: tried.setting,
        reference,
        unknowns: tried.trial.unknowns,
        displacement: tried.trial.history.clone(),
    };
    let samples = tried.iter().chain([reference]).map(|tried| tried.trial.samples_per_revolution);
    let grid = sizes.iter().filter_map(finest).map(|tried| (tried, false));
    let shown = grid.chain(reference.completed().then_some((reference, true)));
    Histories {
        speed_rad_s,
        sensors: request.sensors.clone(),
        // A run that was not made has none.
        samples_per_revolution: samples.max().unwrap_or(0),
        lines: shown.map(line).collect(),
        units: units.clone(),
        version: VERSION.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points =
            [Some((1.0, 0.5)), Some((2.0, 0.1)), Some((3.0, 0.2)), None, Some((2.0, 0.3)), Some((9.0, 0.01))];
        assert_eq!(front(&points), [0, 1, 5]);
        assert_eq!(front(&[Some((1.0, 1.0)), Some((1.0, 1.0))]), [0, 1], "neither beats the other");
    }
}
