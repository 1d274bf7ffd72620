//! Steps at 0.99, 1.00 and 1.01 of the longest stable one.
//!
//! At the limit itself displacements still look right while energy grows; beyond it everything overflows, but only once
//! something has touched. Guaranteed: a given step at or beyond the limit is refused at its field, with the smallest number that
//! is not, also where the limit is met to the last digit; below it the run is sound. What is refused really breaks.

use std::f64::consts::PI;

use faer::c64;
use rubmap::analysis::error::AnalysisError;
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::request::auto_or::AutoOr;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::run::{ReducedSector, check};
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::Outcome;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::schemes::Scheme;
use serde_json::json;

use crate::fixtures::{WheelRecipe, wheel};
use crate::scenes::{Scene, history, largest};
use crate::support::{assert_sound, changed, reduced, run, sweep};

const RECIPE: WheelRecipe = WheelRecipe {
    sectors: 10,
    nodes: 7,
    contact_nodes: 3,
    face_nodes: 2,
    // ω does not move with Ω, so that a speed puts it anywhere against the step.
    stiffening: false,
    seed: 1,
    ground: 1.0,
};

/// Whether a fixed number of steps is accepted; if not, asserts that it is refused at its field with `smallest`.
fn accepted(reduced: &ReducedSector, request: &ResolvedSweep, steps: u64, smallest: u64) -> bool {
    let request =
        changed(request, |asked| asked.integration.steps_per_revolution = AutoOr::Fixed(steps as u32));
    match check(reduced, &request, &Unwatched) {
        Ok(()) => true,
        Err(AnalysisError::Refused(violations)) => {
            assert_eq!(violations.len(), 1, "{violations:?}");
            assert_eq!(violations[0].pointer, "/integration/steps_per_revolution");
            assert!(violations[0].message.contains(&format!("at least {smallest}")), "{violations:?}");
            false
        }
        Err(other) => panic!("{other:?}"),
    }
}

/// Limit itself, refused to the last digit: at speeds at which exactly S steps are the limit, S is refused at every one
/// of them, whichever way it rounds.
#[test]
fn the_limit_itself_is_refused_to_the_last_digit() {
    let sector = wheel(RECIPE);
    let reduced = reduced(&sector, 6);
    let largest =
        ModalWheel::at(&reduced.wheel, 1.0, RotationEffects::stiffening(false)).unwrap().largest_frequency();
    let mut admitted = 0;
    for steps in 500..600u64 {
        let speed = PI * largest / steps as f64;
        let request = sweep(&sector, "central_differences", &[speed], json!({}));
        admitted += u32::from(accepted(&reduced, &request, steps, steps + 1));
        assert!(accepted(&reduced, &request, steps + 1, steps + 1), "{steps}");
    }
    assert_eq!(admitted, 0);
}

#[test]
fn only_the_shorter_step_runs() {
    let sector = wheel(RECIPE);
    let reduced = reduced(&sector, 6);
    // The speed is low enough for one per cent of the step to be many steps.
    let speed =
        ModalWheel::at(&reduced.wheel, 1.0, RotationEffects::stiffening(false)).unwrap().largest_frequency()
            * PI
            / 2000.0;
    let modal = ModalWheel::at(&reduced.wheel, speed, RotationEffects::stiffening(false)).unwrap();
    for (name, scheme) in [
        ("central_differences", Scheme::CentralDifferences),
        ("massless_boundary", Scheme::MasslessBoundary { kept_modes: 7 }),
    ] {
        let mut request = sweep(
            &sector,
            name,
            &[speed],
            json!({"integration": {"revolutions": 3, "window_revolutions": 1}}),
        );
        if let Scheme::MasslessBoundary { kept_modes } = scheme {
            request = changed(&request, |asked| {
                asked.integration.kept_modes = AutoOr::Fixed(kept_modes as u32);
            });
        }
        let smallest = scheme.smallest_stable_steps(&modal, &reduced.wheel.contact);
        let limit = smallest - 1;
        assert!(!accepted(&reduced, &request, (limit as f64 / 1.01) as u64, smallest), "{name}");
        assert!(!accepted(&reduced, &request, limit, smallest), "{name}");
        let shorter = (limit as f64 / 0.99).ceil() as u64;
        assert!(accepted(&reduced, &request, shorter, smallest), "{name}");
        let request =
            changed(&request, |asked| asked.integration.steps_per_revolution = AutoOr::Fixed(shorter as u32));
        let results = run(&reduced, &request);
        assert_sound(&results[0], 1.0);
        assert!(results[0].point.contact_share > 0.0);
    }
}

/// Free motion of the highest mode alone, set off at the speed v, in the loop without the door: bounded below the limit,
/// growing by hv a step at it, and exponentially beyond.
#[test]
fn free_motion_grows_from_the_limit_on() {
    let mut scene = Scene::new(RECIPE);
    (scene.casing, scene.damping_ratio) = (None, 0.0);
    (scene.samples, scene.revolutions) = (1000, 1);
    let wheel = &mut scene.wheel;
    let omega = wheel.largest_frequency();
    let stiffest = wheel.harmonics.iter().position(|h| h.omega.last() == Some(&omega)).unwrap();
    let family = wheel.harmonics[stiffest].omega.len() - 1;
    let speed = 1e-3 * omega;
    scene.initial = vec![InitialMode {
        harmonic: stiffest,
        family,
        displacement: c64::ZERO,
        velocity: c64::new(speed, 0.0),
    }];
    let mut reach = |share: f64| {
        // ωh = 2·share at 1000 steps a revolution.
        scene.wheel.speed_rad_s = PI * omega / (1000.0 * share);
        let run = scene.run(Scheme::CentralDifferences, 1000);
        let unit = {
            // The unit is what the sensor sees of a modal displacement of v/ω.
            let shape: c64 = (0..3)
                .map(|d| scene.wheel.harmonics[stiffest].contact[(d, family)] * scene.contact[0].normal[d])
                .sum();
            let waves: f64 = if scene.wheel.harmonics[stiffest].single { 1.0 } else { 2.0 };
            (waves / 10.0).sqrt() * shape.re.abs() * speed / omega
        };
        largest(&history(&run).displacement[0]) / unit
    };
    // Below the limit the reach is 1/√(1 − share²).
    assert!((reach(0.99) / 7.09 - 1.0).abs() < 0.01);
    // At the limit it is a thousand steps of hv = 2v/ω.
    assert!((reach(1.0) / 2000.0 - 1.0).abs() < 1e-3);
    assert!(reach(1.01) > 1e100);
}

/// Number of steps per revolution at which a wheel whose contact does not change is about to become unstable.
fn linear_limit(scene: &Scene, scheme: Scheme) -> f64 {
    let unstable = scheme.smallest_stable_steps(&scene.wheel, &scene.contact) - 1;
    match scheme {
        // This scheme requires twice as many steps as that limit.
        Scheme::MasslessBoundary { .. } => (unstable / 2) as f64,
        _ => unstable as f64,
    }
}

/// Steps beyond the limit, with contact, end as diverged.
#[test]
fn contact_beyond_the_limit_diverges() {
    for scheme in [Scheme::CentralDifferences, Scheme::MasslessBoundary { kept_modes: 7 }] {
        let mut scene = Scene::new(RECIPE);
        scene.damping_ratio = 0.0;
        scene.samples = 1;
        scene.wheel.speed_rad_s *= scheme.smallest_stable_steps(&scene.wheel, &scene.contact) as f64 / 1000.0;
        let limit = linear_limit(&scene, scheme);
        let run = scene.run(scheme, (limit / 1.01) as usize);
        assert!(matches!(run.outcome, Outcome::Diverged(_)), "{scheme:?}: {:?}", run.outcome);
    }
}

/// Rattling close to the limit gains energy, which is why `massless_boundary` accepts half of what keeps every fixed set of
/// closed nodes stable: where nodes open and close, a long step passes energy from one set to the next. On a ring, which
/// does no work once it has grown, an undamped wheel keeps its energy up to half of it and gains it without bound close to
/// it.
#[test]
fn close_to_the_limit_rattling_gains_energy() {
    for kept_modes in [1, 3, 7, 12] {
        let scheme = Scheme::MasslessBoundary { kept_modes };
        let mut scene = Scene::new(RECIPE);
        scene.damping_ratio = 0.0;
        scene.samples = 1;
        scene.wheel.speed_rad_s *= 0.5;
        (scene.lobes().count, scene.lobes().width_rad) = (1, 1e6);
        scene.revolutions = 10;
        let limit = linear_limit(&scene, scheme);
        let energy = |share: f64| scene.run(scheme, (limit / share) as usize).energy.largest_energy();
        let true_energy = energy(0.05);
        for share in [0.2, 0.3, 0.4, 0.5] {
            let ratio = energy(share) / true_energy;
            assert!((0.8..1.4).contains(&ratio), "{kept_modes} kept, {share} of the limit: {ratio}");
        }
        assert!(energy(0.9) > 10.0 * true_energy, "{kept_modes} kept");
    }
}
