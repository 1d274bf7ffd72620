//! Random scenes on small wheels, held against references with sixteen times the steps and eight times the modes.
//!
//! A scene is drawn as users have them: lobes higher than the clearance, light to fair damping, speeds over the whole range. True
//! errors and estimates are printed; what is asserted is the share of scenes for which they agree within the stated bounds.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::result::{Point, PointError, Quantity};
use rubmap::analysis::run::{
    Choice, FinerRun, Next, Resources, Setting, TrialRequest, control_requests, error_estimate, next,
    run_speed,
};
use rubmap::impeller::ImpellerParameters;
use serde_json::json;

use crate::wheel::Wheel;

/// Number of scenes on each wheel.
const SCENES: u64 = 12;

/// True error over estimate that nine in ten scenes stay within: an estimate is rarely exceeded, and not absurdly large.
const BOUNDS: std::ops::RangeInclusive<f64> = 0.1..=1.2;

/// Generator of reproducible numbers in [0, 1).
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn among<T: Copy>(&mut self, values: &[T]) -> T {
        values[(self.unit() * values.len() as f64) as usize]
    }
}

/// Draws a sweep of one speed and the accuracy that is asked for.
pub(crate) fn scene(draw: &mut Draw) -> (serde_json::Value, f64) {
    let (leading, trailing) = (draw.within(0.2, 0.5), draw.within(0.15, 0.4));
    let amplitude = leading.min(trailing) * draw.within(1.0, 2.0);
    let request = json!({
        "model": "",
        "speeds": {"values": [draw.within(10_000.0, 36_000.0)], "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 10f64.powf(draw.within(-2.5, -1.7))},
            "casing": {
                "clearance": {"leading": leading, "trailing": trailing},
                "lobes": {"count": draw.among(&[1, 2, 2, 3, 4]), "amplitude": amplitude, "width_rad": draw.within(0.15, 0.4)},
            },
            "contact": {},
        },
        "integration": {"revolutions": 30, "ramp_revolutions": 1, "window_revolutions": 12},
        "max_engine_order": 12,
    });
    (request, draw.among(&[0.2, 0.1, 0.05]))
}

/// Outcome of one scene.
#[derive(Debug)]
struct Outcome {
    estimate: f64,
    truth: f64,
    /// (target, true error of the setting chosen for it), or the reason why none was chosen.
    target: Result<(f64, f64), String>,
}

/// True error: the difference of the speed at `index` from the reference, as the service measures it.
pub(crate) fn truth(wheel: &mut Wheel, request: &ResolvedSweep, index: usize) -> f64 {
    let reduced = wheel.reduced(request.modes_per_speed());
    let result = run_speed(&reduced, request, index, None, &Unwatched).unwrap();
    let spectra = result.spectra.unwrap_or_else(|| panic!("{:?}", result.point.message));
    let reference = Setting {
        modes_per_speed: 8 * request.modes_per_speed(),
        scheme: rubmap::analysis::request::SchemeChoice::ExactModal,
        kept_modes: rubmap::analysis::request::auto_or::AutoOr::Auto,
        steps_per_revolution: 16 * result.point.steps_per_revolution,
    };
    let trial = wheel.run(&TrialRequest::new(request, result.point.speed_rad_s, reference));
    let run = FinerRun { index: index as u32, setting: reference, spectra: &spectra, trial: &trial };
    let differences = error_estimate(request, None, &[result.point], &[run]).controls[0].differences.unwrap();
    let amplitude = differences.judged(Quantity::Amplitude).unwrap();
    amplitude.max(differences.engine_orders.unwrap_or(0.0))
}

fn outcome(wheel: &mut Wheel, draw: &mut Draw) -> Outcome {
    let (body, target) = scene(draw);
    let mut fixed = body.clone();
    fixed["modes_per_speed"] = json!(20);
    fixed["integration"]["scheme"] = json!("exact_modal");
    fixed["integration"]["steps_per_revolution"] = json!(1920);
    fixed["control_speeds"] = json!(1);
    let request = wheel.resolved(fixed);
    let reduced = wheel.reduced(20);
    let result = run_speed(&reduced, &request, 0, None, &Unwatched).unwrap();
    let sectors = wheel.facts.sectors;
    let (index, setting, finer) =
        control_requests(&request, sectors, std::slice::from_ref(&result.point), None).remove(0);
    let trial = wheel.run(&finer);
    let spectra = result.spectra.as_ref().unwrap();
    let run = FinerRun { index, setting, spectra, trial: &trial };
    let estimate =
        error_estimate(&request, None, std::slice::from_ref(&result.point), &[run]).largest.unwrap();
    let truth_of_fixed = truth(wheel, &request, 0);

    let mut asked = body;
    asked["accuracy"] = json!({"target": target});
    let asked = wheel.resolved(asked);
    let reached = chosen(wheel, &asked).map(|choice| {
        assert!(choice.estimated_error <= target);
        (target, truth(wheel, &choice.explicit(&asked), 0))
    });
    Outcome { estimate, truth: truth_of_fixed, target: reached }
}

/// Choice that the pilot runs make, as the service goes about it.
pub(crate) fn chosen(wheel: &mut Wheel, request: &ResolvedSweep) -> Result<Choice, String> {
    let resources = Resources { workers: 2, spent_s: 0.0, reductions: Vec::new(), most_modes: None };
    let mut known: Vec<(TrialRequest, rubmap::analysis::run::Trial)> = Vec::new();
    loop {
        let find =
            |wanted: &TrialRequest| known.iter().find(|(run, _)| run == wanted).map(|(_, trial)| trial);
        match next(request, wheel.facts.sectors, &resources, &find) {
            Next::Run(runs) => {
                for run in runs {
                    let trial = wheel.run(&run);
                    known.push((run, trial));
                }
            }
            Next::Take(choice) => return Ok(*choice),
            Next::Refuse(violation) => return Err(violation.message),
        }
    }
}

/// Number of random wheels whose stress errors are covered, and of speeds of each.
const STRESSED: (u64, usize) = (10, 4);

/// Draws a wheel of coarse mesh, and a sweep on it with stress.
fn stressed(draw: &mut Draw) -> (Wheel, serde_json::Value) {
    let thickness = draw.within(0.7, 1.4);
    let coarse = Wheel::coarse_parameters(draw.among(&[3, 4, 5, 7]));
    let wheel = Wheel::with_stress(&ImpellerParameters {
        backsweep_deg: draw.within(0.0, 40.0),
        root_thickness: thickness * coarse.root_thickness,
        tip_thickness: thickness * coarse.tip_thickness,
        ..coarse
    });
    let (mut body, _) = scene(draw);
    let mut speeds: Vec<f64> = (0..STRESSED.1).map(|_| draw.within(10_000.0, 36_000.0)).collect();
    speeds.sort_by(f64::total_cmp);
    body["speeds"] = json!({"values": speeds, "unit": "rpm"});
    body["modes_per_speed"] = json!(20);
    body["integration"]["scheme"] = json!("exact_modal");
    body["integration"]["steps_per_revolution"] = json!(1920);
    body["control_speeds"] = json!(STRESSED.1);
    body["record"] = json!({"stress": {}});
    (wheel, body)
}

/// Errors (true, estimated) of the largest stress at each speed.
fn stress_errors(draw: &mut Draw) -> Vec<(f64, f64)> {
    let (mut wheel, body) = stressed(draw);
    let request = wheel.resolved(body.clone());
    let reduced = wheel.reduced(20);
    let results: Vec<_> =
        (0..STRESSED.1).map(|k| run_speed(&reduced, &request, k, None, &Unwatched).unwrap()).collect();
    let points: Vec<Point> = results.iter().map(|result| result.point.clone()).collect();
    let asked = control_requests(&request, wheel.facts.sectors, &points, None);
    let trials: Vec<_> =
        asked.iter().map(|(index, setting, finer)| (*index, *setting, wheel.run(finer))).collect();
    let runs: Vec<FinerRun<'_>> = (trials.iter())
        .map(|(index, setting, trial)| {
            let spectra = results[*index as usize].spectra.as_ref().unwrap();
            FinerRun { index: *index, setting: *setting, spectra, trial }
        })
        .collect();
    let estimate = error_estimate(&request, None, &points, &runs);
    let mut finest = body;
    finest["modes_per_speed"] = json!(160);
    finest["integration"]["steps_per_revolution"] = json!(8 * 1920);
    let (finest, reduced) = (wheel.resolved(finest), wheel.reduced(160));
    let truth = |error: &PointError| {
        let exact = run_speed(&reduced, &finest, error.index as usize, None, &Unwatched).unwrap().point;
        // A speed that diverges has no stress.
        let largest = |point: &Point| Some(point.stress.as_ref()?.largest.von_mises);
        let truth = (largest(&points[error.index as usize])? / largest(&exact)? - 1.0).abs();
        Some((truth, error.estimated_stress_error?))
    };
    estimate.points.iter().filter_map(truth).collect()
}

/// Errors of stress cover the true ones: on random wheels at most one largest stress in twenty is farther off than its estimate,
/// and estimates are not absurdly large.
#[test]
fn errors_of_stress_cover_the_true_ones() {
    let seeds: Vec<u64> = (0..STRESSED.0).collect();
    let halves = [0, 1].map(|half| {
        let seeds: Vec<u64> = seeds.iter().copied().filter(|seed| seed % 2 == half).collect();
        std::thread::spawn(move || {
            seeds.iter().flat_map(|&seed| stress_errors(&mut Draw(1000 + seed))).collect::<Vec<_>>()
        })
    });
    let errors: Vec<(f64, f64)> = halves.into_iter().flat_map(|half| half.join().unwrap()).collect();
    let mut ratios: Vec<f64> = errors.iter().map(|(truth, estimate)| truth / estimate).collect();
    ratios.sort_by(f64::total_cmp);
    for (truth, estimate) in &errors {
        println!("true {truth:.2e}, estimated {estimate:.2e}, ratio {:.2}", truth / estimate);
    }
    println!(
        "true/estimated: median {:.3}, most {:?}",
        ratios[ratios.len() / 2],
        &ratios[ratios.len() - 3..]
    );
    let above = ratios.iter().filter(|ratio| **ratio > 1.0).count();
    assert!(20 * above <= ratios.len(), "{above} of {} above 1", ratios.len());
    assert!(ratios[ratios.len() / 2] > 0.02, "{ratios:?}");
}

#[test]
fn estimates_are_honest_and_targets_are_met() {
    let threads: Vec<_> = [3_usize, 5]
        .into_iter()
        .map(|sectors| {
            std::thread::spawn(move || {
                let (mut wheel, mut draw) = (Wheel::coarse(sectors), Draw(sectors as u64));
                (0..SCENES).map(|_| outcome(&mut wheel, &mut draw)).collect::<Vec<_>>()
            })
        })
        .collect();
    let outcomes: Vec<Outcome> = threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect();
    let mut ratios: Vec<f64> = outcomes.iter().map(|outcome| outcome.truth / outcome.estimate).collect();
    ratios.sort_by(f64::total_cmp);
    for outcome in &outcomes {
        println!("{outcome:?}");
    }
    let quantile = |q: f64| ratios[((ratios.len() - 1) as f64 * q).round() as usize];
    println!(
        "true error / estimate over {} scenes: least {:.3}, 10 % {:.3}, median {:.3}, 90 % {:.3}, most {:.3}",
        ratios.len(),
        quantile(0.0),
        quantile(0.1),
        quantile(0.5),
        quantile(0.9),
        quantile(1.0)
    );
    let honest = ratios.iter().filter(|ratio| BOUNDS.contains(ratio)).count();
    assert!(10 * honest >= 9 * ratios.len(), "{honest} of {} within {BOUNDS:?}", ratios.len());

    let chosen: Vec<&(f64, f64)> =
        outcomes.iter().filter_map(|outcome| outcome.target.as_ref().ok()).collect();
    let met = chosen.iter().filter(|(target, truth)| truth <= target).count();
    println!(
        "targets met in {met} of {} scenes, {} refused beforehand",
        chosen.len(),
        outcomes.len() - chosen.len()
    );
    assert!(10 * met >= 9 * chosen.len() && 4 * chosen.len() >= 3 * outcomes.len());
}
