//! Runs of a study, as its drawings need them.

use super::axis::{label, significant};
use super::cells::rpm;
use super::scheme;
use super::sketch::Sketch;
use rubmap_analysis::request::auto_or::AutoOr;
use rubmap_analysis::result::{PointStatus, Quantity, SpeedStudy, StudyRun};
use rubmap_analysis::run::{Setting, WorkPrecision};
use serde_json::json;

/// Words for a quantity.
pub(super) fn words(quantity: Quantity, study: &WorkPrecision) -> String {
    match quantity {
        Quantity::History => {
            format!("displacement over the first {} revolutions", study.settings.history_revolutions)
        }
        Quantity::Amplitude => "steady amplitude".to_owned(),
        Quantity::EngineOrders => "peaks at integer engine orders".to_owned(),
        Quantity::Impulse => "contact impulse".to_owned(),
        Quantity::Stress => "largest von Mises stress".to_owned(),
    }
}

/// Begins a sketch of one speed of a study.
pub(super) fn begin(
    kind: &'static str,
    title: &str,
    (study, at): (&WorkPrecision, &SpeedStudy),
    quantity: Quantity,
) -> Sketch<'static> {
    let title = format!("{title}, {} rpm", label(rpm(at.speed_rad_s), 0));
    let sketch = Sketch::new(kind, title, vec![at.message.clone(), origin(study, at)]).high(640);
    let sketch = Sketch { footnote: Some(left_out(at, quantity)), ..sketch };
    sketch.meta("quantity", quantity).meta("speed_rpm", rpm(at.speed_rad_s)).meta("units", json!({"y": "1"}))
}

/// Sketch with a message, where a study has no speed of this index.
pub(super) fn no_speed(kind: &'static str, title: &str, speed: usize) -> Sketch<'static> {
    Sketch::new(kind, title, Vec::new()).nothing(format!("the study has no speed of index {speed}"))
}

/// Title of the axis of errors.
pub(super) fn error_axis(quantity: Quantity, study: &WorkPrecision) -> String {
    format!("relative error: {}", words(quantity, study))
}

/// Words for the reference of the runs, and their origin.
fn origin(study: &WorkPrecision, at: &SpeedStudy) -> String {
    let reference = &at.reference;
    let model: String = study.settings.model.chars().take(12).collect();
    format!(
        "reference: {}, {} unknowns, {} s · {} revolutions · model {model} · rubmap {}",
        setting(&reference.setting),
        label(reference.unknowns.into(), 0),
        significant(reference.time_s),
        study.settings.integration.revolutions,
        study.version
    )
}

pub(super) fn setting(setting: &Setting) -> String {
    let kept = match setting.kept_modes {
        AutoOr::Fixed(kept) => format!(" with {kept} kept modes"),
        AutoOr::Auto => String::new(),
    };
    format!(
        "{} modes per speed, {}{kept}, {} steps a revolution",
        setting.modes_per_speed,
        scheme::words(setting.scheme),
        label(setting.steps_per_revolution.into(), 0)
    )
}

/// Run that can be drawn.
pub(super) struct Drawn<'a> {
    pub(super) run: &'a StudyRun,
    pub(super) error: f64,
    /// Standard error of `error`, where there is one.
    pub(super) spread: Option<f64>,
}

impl<'a> Drawn<'a> {
    pub(super) fn of(run: &'a StudyRun, quantity: Quantity) -> Option<Self> {
        let errors = run.errors.as_ref()?;
        let error = errors.of(quantity)?;
        let spread = errors.amplitude_spread.filter(|_| quantity == Quantity::Amplitude);
        (error > 0.0 && error.is_finite() && run.time_s > 0.0).then_some(Self { run, error, spread })
    }

    pub(super) fn title(&self) -> String {
        let run = self.run;
        let spread = self.spread.map(|spread| format!(" ± {}", significant(spread))).unwrap_or_default();
        format!(
            "{} ({} unknowns integrated): error {}{spread}; set-up {} s, {} ms a revolution, {} s in all",
            setting(&run.setting),
            label(run.unknowns.into(), 0),
            significant(self.error),
            significant(run.cost.set_up_s),
            significant(1e3 * run.cost.per_revolution_s),
            significant(run.time_s)
        )
    }
}

/// Words for the runs that are not drawn.
fn left_out(at: &SpeedStudy, quantity: Quantity) -> String {
    let (mut not_completed, mut exact, mut without) = (0, 0, 0);
    for run in &at.runs {
        let error = run.errors.as_ref().and_then(|errors| errors.of(quantity));
        match error {
            _ if run.status != PointStatus::Completed => not_completed += 1,
            Some(0.0) => exact += 1,
            _ if Drawn::of(run, quantity).is_none() => without += 1,
            _ => {}
        }
    }
    let parts = [
        (not_completed, "not completed"),
        (exact, "with an error of exactly 0"),
        (without, "without this error"),
    ];
    let parts: Vec<String> = parts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, words)| format!("{count} {words}"))
        .collect();
    match parts.is_empty() {
        true => String::new(),
        false => format!("Left out of {} runs: {}", at.runs.len(), parts.join(", ")),
    }
}

/// Reason why nothing is drawn.
pub(super) fn reason(at: &SpeedStudy, quantity: Quantity) -> String {
    let completed = |run: &&StudyRun| run.status == PointStatus::Completed;
    if at.reference.status != PointStatus::Completed {
        return "Nothing to draw: the reference was not completed".to_owned();
    }
    if at.runs.iter().filter(completed).count() == 0 {
        let first = at.runs.iter().find_map(|run| run.message.as_deref());
        return format!("Nothing to draw: no run was completed ({})", first.unwrap_or("no reason given"));
    }
    let error = |run: &StudyRun| run.errors.as_ref()?.of(quantity);
    let why = match (at.runs.iter().any(|run| error(run).is_some()), quantity) {
        (true, _) => "all errors are exactly 0",
        (false, Quantity::EngineOrders) => "the response does not repeat and has no steady peaks",
        (false, Quantity::Impulse) => "there is no contact",
        (false, Quantity::Stress) => "no stress was recorded",
        (false, Quantity::History | Quantity::Amplitude) => "no run has this error",
    };
    format!("Nothing to draw: {why}")
}

/// Ends of a logarithmic axis for positive values, with some room, and at least a decade apart.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) =
        values.fold((f64::INFINITY, 0f64), |(low, high), value| (low.min(value), high.max(value)));
    if high == 0.0 {
        return (0.1, 10.0);
    }
    let room = f64::max(1.5, (10.0 * low / high).sqrt());
    (low / room, high * room)
}
