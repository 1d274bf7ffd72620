//! Cost of a step over the number of sectors, with the same contact nodes on each and the same two lobes.

use rubmap::dynamics::integrate::{Outcome, Simulation};
use rubmap::impeller::ImpellerParameters;

use crate::scene::{Scene, Stepping, TOUCHING, radial};
use crate::timing::{Contender, medians, timed};

const SECTORS: [usize; 6] = [5, 10, 16, 23, 32, 64];
const MODES: usize = 60;
const ROUNDS: usize = 5;
const REVOLUTIONS: usize = 4;

pub(crate) fn measure() {
    let scenes = SECTORS.map(|sectors| {
        let scene = Scene::of(&ImpellerParameters { sectors, ..ImpellerParameters::default() }, MODES, 1);
        let [_, exact, _] = scene.schemes();
        (scene, exact)
    });
    let mut touching = [0.0; SECTORS.len()];
    let mut contenders: Vec<Contender<'_>> = Vec::new();
    for ((scene, stepping), touching) in scenes.iter().zip(&mut touching) {
        contenders.push(Box::new(move || {
            let (time, nodes) = run(scene, *stepping);
            *touching = nodes;
            time
        }));
    }
    let times = medians(ROUNDS, &mut contenders);
    drop(contenders);
    println!(
        "\nSteps of `exact_modal` over the number of sectors: ten contact nodes on each, two lobes of the same width, {REVOLUTIONS} \
         revolutions with their set-up. Touching is the mean number of contact nodes with a force.\n"
    );
    println!("| sectors | unknowns | steps/rev | touching | µs/step | ns/step and sector |");
    println!("|---|---|---|---|---|---|");
    for (((scene, stepping), touching), time) in scenes.iter().zip(touching).zip(times) {
        let sectors = scene.modal.sectors;
        println!(
            "| {sectors} | {} | {} | {touching:.1} | {:.2} | {:.0} |",
            scene.modal.unknowns(),
            stepping.steps,
            1e6 * time,
            1e9 * time / sectors as f64
        );
    }
}

/// Runs a scene; returns seconds per step, and how many contact nodes have a force, in the mean over the last revolution.
fn run(scene: &Scene, stepping: Stepping) -> (f64, f64) {
    let casing = scene.casing(TOUCHING);
    let sensors = [radial(0, 0)];
    let simulation = Simulation { revolutions: REVOLUTIONS, ..scene.simulation(stepping, &casing, &sensors) };
    let (run, time) = timed(|| simulation.run(&|_| true));
    assert!(matches!(run.outcome, Outcome::Completed(_)), "{:?}", run.outcome);
    let contact = run.contact.expect("it touches");
    let touched: u64 = contact.pairs.iter().map(|pair| pair.steps).sum();
    (time / run.statistics.steps as f64, touched as f64 / stepping.steps as f64)
}
