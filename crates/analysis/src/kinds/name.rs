//! Name of a job that was posted without one: model, kind, range of speeds, clearance and lobes, effects.

use super::kind::ResolvedJob;
use super::sweep::kind::SWEEP;
use crate::digits::digits;
use crate::effects::casing::resolved::{Casing, Clearance};
use crate::effects::table::named;
use crate::model::ModelFacts;
use crate::resolved::Scene;
use crate::verdict::sentence::rpm_number;

/// Characters of the model's name that a name has at most.
const MODEL: usize = 60;

/// Characters of a name up to which effects are listed.
const LENGTH: usize = 180;

/// Effects that a name leaves out: nearly every scene has them, the name says more of them, or they change no physics.
const LEFT_OUT: [&str; 6] = ["casing", "contact", "damping", "centrifugal_stiffening", "symmetry", "probe"];

/// Names a job of a model, such as `Impeller: 12,730 to 38,200 rpm, clearance 0.3–0.22 mm, 2 lobes of 0.425 mm, friction`.
pub fn name(job: &dyn ResolvedJob, model: &ModelFacts) -> String {
    let kind = (job.kind() != &SWEEP).then(|| job.kind().name.replace('_', " "));
    let speeds = job.span_rad_s().map(|ends| {
        let [low, high] = ends.map(rpm_number);
        if low == high { format!("{low} rpm") } else { format!("{low} to {high} rpm") }
    });
    let scene = job.scene().map(|scene| &scene.scene);
    let casing = scene.and_then(|scene| scene.casing.as_ref());
    let casing = casing.map(|casing| gap(casing, &model.units.length));
    let parts: Vec<String> = kind.into_iter().chain(speeds).chain(casing).collect();
    let mut name = format!("{}: {}", shortened(&model.name), parts.join(", "));
    for effect in scene.into_iter().flat_map(effects) {
        if name.chars().count() + effect.len() > LENGTH {
            return name + ", …";
        }
        name = format!("{name}, {effect}");
    }
    name
}

/// Effects of a scene that a name lists, in words.
fn effects(scene: &Scene) -> impl Iterator<Item = String> {
    named(scene).filter(|effect| !LEFT_OUT.contains(&effect.name)).map(|effect| match effect.name {
        "abradable" => "abradable coating".to_owned(),
        "coriolis" => "Coriolis forces".to_owned(),
        "geometric_nonlinearity" => "blades that bend far".to_owned(),
        "initial" => "initial motion".to_owned(),
        name => name.replace('_', " "),
    })
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
