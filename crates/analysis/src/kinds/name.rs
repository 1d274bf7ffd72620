//! Name of a job that was posted without one: model, kind, range of speeds, clearance and lobes.

use std::f64::consts::TAU;

use super::kind::ResolvedJob;
use super::sweep::kind::SWEEP;
use crate::effects::casing::resolved::{Casing, Clearance};
use crate::model::ModelFacts;
use crate::verdict::sentence::{digits, rpm_number};

/// Characters of the model's name that a name has at most.
const MODEL: usize = 60;

/// Names a job of a model, such as `Impeller: 12,730 to 38,200 rpm, clearance 0.3–0.22 mm, 2 lobes of 0.425 mm`.
pub fn name(job: &dyn ResolvedJob, model: &ModelFacts) -> String {
    let kind = (job.kind() != &SWEEP).then(|| job.kind().name.replace('_', " "));
    let speeds = job.span_rad_s().map(|ends| {
        let [low, high] = ends.map(|end| rpm_number(round(end)));
        if low == high { format!("{low} rpm") } else { format!("{low} to {high} rpm") }
    });
    let casing = job.scene().and_then(|scene| scene.scene.casing.as_ref());
    let casing = casing.map(|casing| gap(casing, &model.units.length));
    let parts: Vec<String> = kind.into_iter().chain(speeds).chain(casing).collect();
    format!("{}: {}", shortened(&model.name), parts.join(", "))
}

/// Speed in rad/s as one says it: to four digits of its rpm.
fn round(speed_rad_s: f64) -> f64 {
    let rpm = speed_rad_s * 60.0 / TAU;
    let rpm: f64 = format!("{rpm:.3e}").parse().unwrap_or(rpm);
    rpm * TAU / 60.0
}

/// Clearance at both ends of the blade, and lobes.
fn gap(casing: &Casing, length: &str) -> String {
    let [first, last] = match &casing.clearance {
        Clearance::AlongChord { leading, trailing } => [*leading, *trailing],
        Clearance::Each(values) => [values.first(), values.last()].map(|end| end.copied().unwrap_or(0.0)),
    };
    let ends = if first == last { digits(first) } else { format!("{}–{}", digits(first), digits(last)) };
    let lobes = casing.shape.lobes.as_ref().map(|lobes| {
        let word = if lobes.count == 1 { "lobe" } else { "lobes" };
        format!(", {} {word} of {} {length}", lobes.count, digits(lobes.amplitude))
    });
    format!("clearance {ends} {length}{}", lobes.unwrap_or_default())
}

/// Name of the model, cut where it is long.
fn shortened(name: &str) -> String {
    if name.chars().count() <= MODEL {
        return name.to_owned();
    }
    let kept: String = name.chars().take(MODEL - 1).collect();
    format!("{}…", kept.trim_end())
}
