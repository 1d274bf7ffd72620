//! Time per step and per revolution of every scheme at its own automatic step, and of the literal dense step.

use std::ops::Range;

use faer::c64;
use rubmap::dynamics::casing::Casing;
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::{Outcome, Simulation};

use crate::literal::Literal;
use crate::scene::{FREE, Scene, Stepping, TOUCHING, name, radial};
use crate::timing::{Contender, medians, timed};

const ROUNDS: usize = 7;
/// Revolutions of a run. The first is the ramp, in which hardly anything touches; in all others something always does: nine steps of ten.
const REVOLUTIONS: usize = 8;
/// Time that a round spends on the literal step, s.
const ROUND_S: f64 = 0.2;

pub(crate) fn measure(sizes: &[(usize, usize)]) {
    println!(
        "\nEvery scheme at its automatic step, from rest or with one mode of every nodal diameter in motion (free flight), \
         {REVOLUTIONS} revolutions with their set-up; the literal dense step at that of `central_differences`, without: the \
         first revolution, and the second for all that follow. Contact is the share of the steps with a force.\n"
    );
    println!(
        "| unknowns | motion | scheme | steps/rev | contact | ns/step | µs/rev | dense/scheme, per step | per rev |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for &(unknowns, modes) in sizes {
        let scene = Scene::new(modes, 1);
        assert_eq!(scene.modal.unknowns(), unknowns);
        let schemes = scene.schemes();
        let mut literal = Literal::new(&scene, schemes[0].steps);
        let free_flight =
            Motion { name: "free flight", clearance: FREE, initial: moving(&scene), touching: 0.0..1e-9 };
        let contact =
            Motion { name: "contact", clearance: TOUCHING, initial: Vec::new(), touching: 0.85..0.97 };
        for motion in [free_flight, contact] {
            compare(&scene, &schemes, &mut literal, &motion);
        }
    }
}

/// Motion of the wheel while steps are timed.
struct Motion {
    name: &'static str,
    clearance: f64,
    initial: Vec<InitialMode>,
    /// Share of the steps with contact that the motion must have.
    touching: Range<f64>,
}

/// Prints the rows of a table for one size and motion: the literal step, then every scheme.
fn compare(scene: &Scene, schemes: &[Stepping; 3], literal: &mut Literal, motion: &Motion) {
    let casing = scene.casing(motion.clearance);
    literal.face(scene, &casing);
    let dense_steps = schemes[0].steps;
    // The revolution in which the restriction grows runs once; then rounds of a later one, which all others are like.
    let (growing_share, growing) = timed(|| literal.advance(dense_steps));
    let chunk = (ROUND_S / growing * dense_steps as f64).ceil() as usize;
    let mut dense_share = 0.0;
    let mut shares = [0.0; 3];
    let mut contenders: Vec<Contender<'_>> = vec![Box::new(|| {
        let (share, time) = timed(|| literal.advance(chunk));
        dense_share = share;
        time / chunk as f64
    })];
    for (&stepping, share) in schemes.iter().zip(&mut shares) {
        let casing = &casing;
        contenders.push(Box::new(move || {
            let produced = production(scene, stepping, casing, &motion.initial, REVOLUTIONS);
            *share = produced.contact_share;
            produced.time
        }));
    }
    let mut times = medians(ROUNDS, &mut contenders);
    drop(contenders);
    // The literal step counts over the same revolutions as the others.
    let over_run = |first: f64, later: f64| (first + (REVOLUTIONS - 1) as f64 * later) / REVOLUTIONS as f64;
    times[0] = over_run(growing / dense_steps as f64, times[0]);
    let dense_share = over_run(growing_share, dense_share);
    let unknowns = scene.modal.unknowns();
    let row = |scheme: &str, steps: usize, share: f64, time: f64| {
        assert!(
            motion.touching.contains(&share),
            "{scheme}: contact in {share:.3} of the steps is not the motion measured"
        );
        let revolution = time * steps as f64;
        println!(
            "| {unknowns} | {} | {scheme} | {steps} | {share:.2} | {:.0} | {:.0} | {:.0} | {:.0} |",
            motion.name,
            1e9 * time,
            1e6 * revolution,
            times[0] / time,
            times[0] * dense_steps as f64 / revolution
        );
    };
    row("literal dense", dense_steps, dense_share, times[0]);
    for ((stepping, share), time) in schemes.iter().zip(shares).zip(&times[1..]) {
        row(&name(stepping.scheme), stepping.steps, share, *time);
    }
}

/// Outcome of a whole run.
pub(crate) struct Produced {
    /// Seconds per step, set-up included.
    pub(crate) time: f64,
    contact_share: f64,
}

pub(crate) fn production(
    scene: &Scene,
    stepping: Stepping,
    casing: &Casing,
    initial: &[InitialMode],
    revolutions: usize,
) -> Produced {
    let sensors = [radial(0, 0), radial(scene.reduced.wheel.contact.len() - 1, 0)];
    let simulation = Simulation { initial, revolutions, ..scene.simulation(stepping, casing, &sensors) };
    let (run, time) = timed(|| simulation.run(&|_| true));
    assert!(matches!(run.outcome, Outcome::Completed(_)), "{:?}", run.outcome);
    Produced { time: time / run.statistics.steps as f64, contact_share: run.statistics.contact_share() }
}

/// Initial motion of the lowest mode of every nodal diameter: free flight at rest would be a product of zeros.
pub(crate) fn moving(scene: &Scene) -> Vec<InitialMode> {
    let mode = |harmonic: usize| {
        let lowest = &scene.modal.harmonics[harmonic];
        let largest = (0..lowest.contact.nrows()).fold(0.0, |m, dof| lowest.contact[(dof, 0)].norm().max(m));
        InitialMode {
            harmonic,
            family: 0,
            displacement: c64::new(0.1 / largest, 0.0),
            velocity: c64::new(0.0, 0.0),
        }
    };
    (0..scene.modal.harmonics.len()).map(mode).collect()
}
