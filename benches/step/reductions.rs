//! Accuracy of reductions: the distance between the histories of a coarse and a fine reduction, beside the cost of each,
//! and the fine one with a boundary without mass.

use rubmap::analysis::request::SchemeChoice;
use rubmap::analysis::request::auto_or::AutoOr;
use rubmap::dynamics::schemes::Scheme;

use crate::history::{REVOLUTIONS, error, history, sampled};
use crate::scene::{Scene, Stepping, name};
use crate::timing::{Contender, medians};

const COARSE: usize = 20;
const FINE: usize = 42;
const KEPT_MODES: [u32; 2] = [30, 60];
/// Steps per revolution at which the step no longer matters.
const FINE_STEPS: usize = 102_400;
const ROUNDS: usize = 5;

pub(crate) fn measure() {
    let [coarse, fine] = [COARSE, FINE].map(|modes| Scene::new(modes, 3));
    let truth = Stepping { scheme: Scheme::CentralDifferences, steps: FINE_STEPS };
    let reference = history(&fine, truth).values;
    println!(
        "\nReductions: three stiffnesses, {REVOLUTIONS} revolutions from rest; errors against k = {FINE} with \
         `central_differences` at {FINE_STEPS} steps per revolution: at that step, and at the automatic one.\n"
    );
    println!("| k | unknowns | scheme | error | steps/rev | error | ms/rev |");
    println!("|---|---|---|---|---|---|---|");
    let with_mass = [SchemeChoice::CentralDifferences, SchemeChoice::ExactModal];
    let mut rows = Vec::new();
    for (modes, scene) in [(COARSE, &coarse), (FINE, &fine)] {
        rows.extend(with_mass.map(|scheme| (modes, scene, scene.automatic(scheme, AutoOr::Auto))));
    }
    let massless = KEPT_MODES.map(AutoOr::Fixed).into_iter().chain([AutoOr::Auto]);
    rows.extend(massless.map(|kept| (FINE, &fine, fine.automatic(SchemeChoice::MasslessBoundary, kept))));
    for (_, _, stepping) in &mut rows {
        stepping.steps = sampled(stepping.steps as f64);
    }
    let mut contenders: Vec<Contender<'_>> = Vec::new();
    for &(_, scene, stepping) in &rows {
        contenders.push(Box::new(move || history(scene, stepping).time / REVOLUTIONS as f64));
    }
    let times = medians(ROUNDS, &mut contenders);
    for ((modes, scene, stepping), time) in rows.into_iter().zip(times) {
        let at = |steps: usize| {
            let run = history(scene, Stepping { scheme: stepping.scheme, steps });
            error(&run.values, &reference)
        };
        println!(
            "| {modes} | {} | {} | {:.1e} | {} | {:.1e} | {:.2} |",
            scene.modal.unknowns(),
            name(stepping.scheme),
            at(FINE_STEPS.max(stepping.steps)),
            stepping.steps,
            at(stepping.steps),
            1e3 * time
        );
    }
}
