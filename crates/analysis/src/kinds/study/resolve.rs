//! Convergence studies, resolved against the facts of their model.

use crate::discretisation::aligned_samples;
use crate::error::Violation;
use crate::kinds::study::grid::FINER;
use crate::model::ModelFacts;
use crate::request::auto_or::MOST_STEPS;
use crate::request::{AutoOr, Grid, SchemeChoice, StudyRequest};
use crate::resolve::{limits, resolve_sweep};
use crate::resolved::ResolvedStudy;

/// Most speeds of a study, and most entries of each list of its grid.
const MOST_SPEEDS: usize = 8;
const MOST_ENTRIES: usize = 12;

/// Most runs of a study, and most displacements recorded in all of them together (8 bytes each).
const MOST_RUNS: usize = 2000;
const MOST_KEPT: usize = 1 << 24;

/// Parses a study and checks it against its model; without sensors it takes the default ones.
pub fn resolve_study(request: StudyRequest, facts: &ModelFacts) -> Result<ResolvedStudy, Vec<Violation>> {
    let (sweep, mut found) = match resolve_sweep(request.sweep(), facts) {
        Ok(sweep) => (Some(sweep), Vec::new()),
        Err(found) => (None, found),
    };
    let mut require = |holds: bool, pointer: &str, message: String| {
        if !holds {
            found.push(Violation::new(pointer, message));
        }
    };
    if let Ok(parts) = request.speeds.parts() {
        let speeds: usize = parts.iter().map(Vec::len).sum();
        let message = format!("a study has at most {MOST_SPEEDS} speeds, not {speeds}");
        require(speeds <= MOST_SPEEDS, "/speeds", message);
    }
    let revolutions = request.integration.revolutions;
    require(
        (1..=revolutions).contains(&request.history_revolutions),
        "/history_revolutions",
        format!("the run has {revolutions} revolutions: between 1 and {revolutions} are compared"),
    );
    let Grid { modes_per_speed, steps_per_revolution, schemes, kept_modes } = &request.grid;
    for (list, length) in [
        ("modes_per_speed", modes_per_speed.len()),
        ("steps_per_revolution", steps_per_revolution.len()),
        ("schemes", schemes.len()),
        ("kept_modes", kept_modes.len()),
    ] {
        require(
            (1..=MOST_ENTRIES).contains(&length),
            &format!("/grid/{list}"),
            format!("between 1 and {MOST_ENTRIES} entries"),
        );
    }
    for (i, k) in modes_per_speed.iter().enumerate().take(MOST_ENTRIES) {
        require(
            (1..=limits::MODES_PER_SPEED).contains(k) && !modes_per_speed[..i].contains(k),
            &format!("/grid/modes_per_speed/{i}"),
            format!("numbers between 1 and {}, each once", limits::MODES_PER_SPEED),
        );
    }
    let least = 2 * request.max_engine_order.min(MOST_STEPS) + 1;
    for (i, steps) in steps_per_revolution.iter().enumerate().take(MOST_ENTRIES) {
        require(
            (least..=MOST_STEPS / FINER).contains(steps) && !steps_per_revolution[..i].contains(steps),
            &format!("/grid/steps_per_revolution/{i}"),
            format!(
                "numbers between {least} and {}, each once: the reference takes twice the largest",
                MOST_STEPS / FINER
            ),
        );
    }
    for (i, scheme) in schemes.iter().enumerate().take(MOST_ENTRIES) {
        require(
            *scheme != SchemeChoice::Auto && !schemes[..i].contains(scheme),
            &format!("/grid/schemes/{i}"),
            "central_differences, exact_modal or massless_boundary, each once".to_owned(),
        );
    }
    for (i, kept) in kept_modes.iter().enumerate().take(MOST_ENTRIES) {
        require(
            *kept != AutoOr::Fixed(0) && !kept_modes[..i].contains(kept),
            &format!("/grid/kept_modes/{i}"),
            "\"auto\" or numbers from 1 on, each once".to_owned(),
        );
    }
    let (Some(sweep), true) = (sweep, found.is_empty()) else { return Err(found) };
    let StudyRequest { grid, history_revolutions, .. } = request;
    let study = ResolvedStudy { sweep, grid, history_revolutions };
    let found = refused_settings(&study, facts);
    if found.is_empty() { Ok(study) } else { Err(found) }
}

/// Violations of settings of a valid grid that the scene does not allow or that would take too much memory; each field once.
fn refused_settings(request: &ResolvedStudy, facts: &ModelFacts) -> Vec<Violation> {
    let sweep = &request.sweep;
    let mut found: Vec<Violation> = Vec::new();
    let trials = request.all_trials(facts.sectors).len();
    let samples = aligned_samples(sweep, facts.sectors as usize);
    let kept = trials * samples * request.history_revolutions as usize * request.sensors().len();
    if trials > MOST_RUNS || kept > MOST_KEPT {
        let message = format!(
            "{trials} runs with {kept} displacements to be kept: a study has at most {MOST_RUNS} runs and {MOST_KEPT} displacements; \
             take fewer settings, speeds or sensors, or compare fewer revolutions"
        );
        return vec![Violation::new("/grid", message)];
    }
    for setting in request.settings(facts.sectors).into_iter().chain([request.reference(facts.sectors)]) {
        for mut violation in resolve_sweep(sweep.at(setting).into(), facts).err().unwrap_or_default() {
            if violation.pointer == "/integration/steps_per_revolution" {
                violation.pointer = "/grid/steps_per_revolution".to_owned();
                violation.message = format!("{}: {}", setting.steps_per_revolution, violation.message);
            }
            if found.iter().all(|known| known.pointer != violation.pointer) {
                found.push(violation);
            }
        }
    }
    found
}
