//! Checks of the symmetry against all other effects.

use super::repeats::repeats;
use super::request::Symmetry;
use crate::effects::effect::Repeats;
use crate::effects::probe;
use crate::effects::table::named;
use crate::error::Violation;
use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;

/// Checks what exact symmetry and the probe of it ask of the rest of the request.
pub(crate) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let scene = &request.scene;
    probe::check::check(found, scene);
    if scene.symmetry == Symmetry::Full {
        return;
    }
    for effect in named(scene) {
        if let Repeats::Once(what) = effect.repeats {
            let name = effect.name;
            let message = format!(
                "the scene repeats nothing around the wheel: {what} (/scene/{name}) break the symmetry"
            );
            found.0.push(Violation::new("/scene/symmetry", message));
        }
    }
    let repeats = repeats(scene, facts.sectors);
    found.require(
        repeats > 1,
        "/scene/symmetry",
        "the scene repeats nothing around the wheel: the numbers of sectors and lobes, the engine orders and the \
         initial nodal diameter have no common divisor",
    );
    if scene.symmetry == Symmetry::Exact {
        found.require(
            scene.abradable.is_none(),
            "/scene/symmetry",
            "rods of an abradable coating are worn by all blades: take `full` or `probe`",
        );
    }
    found.require(
        scene.symmetry != Symmetry::Probe || scene.initial.is_none(),
        "/scene/initial",
        "the probe starts from its own asymmetry",
    );
}
