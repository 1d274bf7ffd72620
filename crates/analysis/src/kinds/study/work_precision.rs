//! Results of a convergence study: errors, times, observed orders and the Pareto front (work and precision), and histories.

use crate::accuracy::errors::{errors, history_error};
use crate::effects::table::planned;
use crate::model::ModelFacts;
use crate::plan::warnings;
use crate::request::{AutoOr, SchemeChoice, Setting};
use crate::resolved::{ResolvedStudy, TrialRequest};
use crate::result::{
    Histories, HistoryLine, PointStatus, Quantity, ReductionReport, SpeedStudy, Stability, SteadyReport,
    StepOrder, StudyPlan, StudyReduction, StudyRun, Trial, WorkPrecision, front,
};
use rubmap_numerics::convergence::observed_order;
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::response::sensitivity::Growth;
use rubmap_wheel::revision::VERSION;

/// Trial of a study with its setting.
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
            steady: point.steady.clone(),
            energy_residual: point.energy_residual,
            errors: reference.and_then(|reference| errors(self.trial, reference)),
            cost: self.trial.cost,
            time_s: self.trial.cost.of_run(f64::from(revolutions)),
            pareto: Vec::new(),
        }
    }
}

/// Plans a resolved study: the runs that it makes, without those that are stored, which nobody knows beforehand.
pub(crate) fn plan_study(study: &ResolvedStudy, facts: &ModelFacts) -> StudyPlan {
    let trials = study.all_trials(facts.sectors);
    let revolutions = u64::from(study.sweep.integration.revolutions());
    let steps = |trial: &TrialRequest| match trial.sweep().integration.steps_per_revolution {
        AutoOr::Fixed(steps) => u64::from(steps) * revolutions,
        AutoOr::Auto => 0,
    };
    let mut reductions: Vec<u32> = trials.iter().map(|trial| trial.sweep().modes_per_speed()).collect();
    reductions.dedup();
    StudyPlan {
        effects: planned(&study.sweep.scene),
        speeds: study.speeds().count(),
        simulations: trials.len() as u32,
        steps: trials.iter().map(steps).sum(),
        reductions,
        warnings: warnings(&study.sweep.scene, facts, None),
        settings: study.clone().into(),
        version: VERSION.to_owned(),
    }
}

/// Results of the finished trials of a resolved study, with a document of histories for every speed; `trial` looks one up. None if one is
/// missing.
pub fn work_precision<'a>(
    request: &ResolvedStudy,
    (sectors, units): (u32, &Units),
    reports: &[ReductionReport],
    trial: &dyn Fn(&TrialRequest) -> Option<&'a Trial>,
) -> Option<(WorkPrecision, Vec<Histories>)> {
    let (mut speeds, mut histories) = (Vec::new(), Vec::new());
    for &speed_rad_s in request.speeds().rad_s() {
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
    let settings = request.clone().into();
    Some((WorkPrecision { speeds, reductions, settings, version: VERSION.to_owned() }, histories))
}

fn speed_study(request: &ResolvedStudy, speed_rad_s: f64, reference: &Tried, tried: &[Tried]) -> SpeedStudy {
    let revolutions = request.sweep.integration.revolutions();
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
    if let Some(SteadyReport { taken: true, stability, .. }) = point.steady {
        let lasts = match stability {
            Some(Stability::Stable | Stability::Narrow) => {
                "lasts; histories of runs that were marched are not compared with it, all else can be"
            }
            Some(Stability::Undecided) | None => {
                "may last or not, which could not be told: marched runs may show another response"
            }
            Some(Stability::Flip | Stability::Fold | Stability::NeimarkSacker) => {
                "does not last: runs that are marched leave it, and only those that are solved for can be compared with it"
            }
        };
        return format!("the reference is a periodic response that was solved for and {lasts}");
    }
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

/// Observed orders of convergence, from trials of the same size and scheme, ascending in steps.
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
    request: &ResolvedStudy,
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
        sensors: request.sensors().iter().map(|&sensor| sensor.into()).collect(),
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
