//! Choices on made-up responses: level 1 with errors that fall with modes and steps in known ways.

use std::cell::Cell;

use serde_json::json;

use crate::accuracy::choice::next;
use crate::accuracy::climb::{Next, Resources};
use crate::request::{AutoOr, SchemeChoice};
use crate::resolved::{ResolvedSweep, TrialRequest, from_json};
use crate::result::{Choice, Cost, Trial};
use rubmap_wheel::response::sensitivity::{Growth, Sensitivity};

/// Result of a run at (k, S) and a speed: its level, or none if it diverges, and whether it repeats.
type Response<'a> = &'a dyn Fn(f64, f64, f64) -> (Option<f64>, bool);

fn request(asked: serde_json::Value) -> ResolvedSweep {
    let mut body = json!({
        "model": "", "speeds": {"from": 100, "to": 400, "count": 31, "unit": "rad_s"}, "scene": {},
        "sensors": [{"contact_node": 0, "component": "radial"}], "max_engine_order": 4, "control_speeds": 0,
        "integration": {"revolutions": 10, "window_revolutions": 5},
    });
    body.as_object_mut().unwrap().extend(asked.as_object().unwrap().clone());
    from_json::sweep(body)
}

fn resources() -> Resources {
    Resources { workers: 1, spent_s: 0.0, reductions: vec![(20, 1.0)], most_modes: None }
}

/// Computing time of a step per mode, s.
const STEP_S: f64 = 1e-7;

/// Boundary without mass: share of [`STEP_S`] that a step takes, and error of the level.
const MASSLESS: (f64, f64) = (0.5, 0.004);

fn trial(request: &TrialRequest, response: Response, growth: Growth) -> Trial {
    let speed = request.speed_rad_s();
    let AutoOr::Fixed(steps) = request.sweep.integration.steps_per_revolution else {
        panic!("no fixed step")
    };
    let modes = f64::from(request.sweep.modes_per_speed());
    let (mut level, repeats) = response(modes, f64::from(steps), speed);
    let massless = request.sweep.integration.scheme == SchemeChoice::MasslessBoundary;
    let step_s = if massless { MASSLESS.0 * STEP_S } else { STEP_S };
    if massless {
        level = level.map(|level| level + MASSLESS.1);
    }
    let settling = json!({"verdict": if repeats { "periodic" } else { "aperiodic" }});
    let responses = json!([{"sensor": {"contact_node": 0, "component": "radial"}, "mean": 0.0, "rms": level,
        "half_peak_to_peak": 1.0, "dominant_engine_order": 2.0, "dominant_nodal_diameter": 2}]);
    let point = json!({
        "index": 0, "speed_rad_s": speed, "status": if level.is_some() { "completed" } else { "diverged" },
        "message": level.is_none().then_some("the response grew without bound"),
        "settling": settling, "steps_per_revolution": steps, "smallest_stable_steps_per_revolution": 1, "steps": 1,
        "march": (request.sweep.integration.revolutions == AutoOr::Auto)
            .then(|| json!({"revolutions": 4, "period_revolutions": 1, "remaining_change": 1e-4})),
        "contact_share": 0.0, "responses": if level.is_some() { responses } else { json!([]) },
        "wall_time_s": 0.0, "version": "0",
    });
    let lines = level.map(|level| vec![vec![level, 0.0]]).unwrap_or_default();
    Trial {
        point: serde_json::from_value(point).unwrap(),
        unknowns: request.sweep.modes_per_speed(),
        lines,
        levels: vec![vec![1.0, 1.1, 0.9, 1.05, 0.95]],
        history: Vec::new(),
        samples_per_revolution: 0,
        sensitivity: request.twin.then_some(Sensitivity {
            growth,
            rate_per_revolution: Some(0.125),
            rate_error: Some(0.002),
            rate_from_revolution: Some(17),
            separated_after_revolutions: None,
            last_distance: 1e-3,
        }),
        cost: Cost {
            set_up_s: 0.0,
            per_revolution_s: step_s * modes * f64::from(steps),
            repetitions: 1,
            spread: None,
        },
    }
}

/// Runs the pilots until there is a choice or a refusal; returns it with the number of runs.
fn choose(
    request: &ResolvedSweep,
    resources: &Resources,
    response: Response,
) -> (Result<Choice, String>, usize) {
    choose_of(Growth::Chaotic, request, resources, response)
}

/// Runs the pilots to a choice or a refusal, where a tiny perturbation of any run behaves like `growth`.
fn choose_of(
    growth: Growth,
    request: &ResolvedSweep,
    resources: &Resources,
    response: Response,
) -> (Result<Choice, String>, usize) {
    let known: std::cell::RefCell<Vec<(TrialRequest, &'static Trial)>> = Default::default();
    let rounds = Cell::new(0);
    loop {
        let find =
            |wanted: &TrialRequest| known.borrow().iter().find(|(run, _)| run == wanted).map(|(_, t)| *t);
        match next(request, 10, resources, &find) {
            Next::Take(choice) => return (Ok(*choice), known.borrow().len()),
            Next::Refuse(violation) => return (Err(violation.message), known.borrow().len()),
            Next::Run(runs) => {
                rounds.set(rounds.get() + 1);
                assert!(!runs.is_empty() && rounds.get() < 100);
                for run in runs {
                    let found: &'static Trial = Box::leak(Box::new(trial(&run, response, growth)));
                    known.borrow_mut().push((run, found));
                }
            }
        }
    }
}

/// Request of sixty speeds of a wheel that may touch: enough for cheaper settings to be tried.
fn many(asked: serde_json::Value) -> ResolvedSweep {
    let mut body = json!({"scene": {"contact": {}}});
    body["speeds"] = json!({"from": 100, "to": 400, "count": 60, "unit": "rad_s"});
    body.as_object_mut().unwrap().extend(asked.as_object().unwrap().clone());
    request(body)
}

/// Response of level 1 + 40/k² + 30/S.
fn converging(modes: f64, steps: f64, _: f64) -> (Option<f64>, bool) {
    (Some(1.0 + 40.0 / modes.powi(2) + 30.0 / steps), true)
}

#[test]
fn the_target_is_met_with_the_fewest_modes_and_steps() {
    let request = request(json!({"accuracy": {"target": 0.05}}));
    let (choice, runs) = choose(&request, &resources(), &converging);
    let choice = choice.unwrap();
    let truth = 40.0 / f64::from(choice.setting.modes_per_speed).powi(2)
        + 30.0 / f64::from(choice.setting.steps_per_revolution);
    assert!(truth <= choice.estimated_error && choice.estimated_error <= 0.05, "{choice:?}");
    assert!(
        choice.setting.modes_per_speed <= 80 && choice.setting.steps_per_revolution <= 4000,
        "{choice:?}"
    );
    assert_eq!((choice.estimated_at, choice.pilot_speeds_rad_s.len()), (4, 4));
    assert!(runs <= 4 * 8, "{runs}");
}

#[test]
fn mass_is_let_go_where_its_error_is_known_to_be_within_the_target() {
    let choice = |target: f64| {
        choose(&many(json!({"accuracy": {"target": target}})), &resources(), &converging).0.unwrap()
    };
    let truth = |choice: &Choice| {
        let setting = choice.setting;
        let massless = if setting.scheme == SchemeChoice::MasslessBoundary { MASSLESS.1 } else { 0.0 };
        40.0 / f64::from(setting.modes_per_speed).powi(2)
            + 30.0 / f64::from(setting.steps_per_revolution)
            + massless
    };
    let loose = choice(0.25);
    assert_eq!(loose.setting.scheme, SchemeChoice::MasslessBoundary, "{loose:?}");
    assert!(loose.difference > 0.0 && loose.reason.contains("may go without mass"), "{loose:?}");
    assert!(truth(&loose) <= loose.estimated_error && loose.estimated_error <= 0.25, "{loose:?}");
    // A target below what the mass makes.
    let strict = choice(0.004);
    assert_eq!(strict.setting.scheme, SchemeChoice::ExactModal, "{strict:?}");
    assert!(truth(&strict) <= strict.estimated_error, "{strict:?}");
    let without_contact = json!({"scene": {}, "accuracy": {"target": 0.2}});
    let choice = choose(&many(without_contact), &resources(), &converging).0.unwrap();
    assert_eq!(choice.setting.scheme, SchemeChoice::ExactModal, "nothing has a boundary");
}

#[test]
fn a_response_of_another_kind_is_never_taken() {
    // Few steps make it rattle.
    let rattling = |k: f64, s: f64, speed: f64| (converging(k, s, speed).0, s > 1700.0);
    let request = many(json!({"accuracy": {"target": 0.2}}));
    let choice = choose_of(Growth::Stable, &request, &resources(), &rattling).0.unwrap();
    assert!(choice.setting.steps_per_revolution > 1700, "{choice:?}");
}

#[test]
fn a_target_is_the_same_choice_for_any_number_of_workers_and_any_time() {
    let request = many(json!({"accuracy": {"target": 0.05}}));
    let settings = [(1, 0.0, 1.0), (8, 0.0, 1.0), (2, 500.0, 77.0)].map(|(workers, spent_s, reduction_s)| {
        let resources = Resources { workers, spent_s, reductions: vec![(20, reduction_s)], most_modes: None };
        choose(&request, &resources, &converging).0.unwrap().setting
    });
    assert_eq!([settings[0]; 3], settings);
}

#[test]
fn a_budget_is_used() {
    for seconds in [20.0, 50.0, 100.0, 200.0, 400.0, 1000.0, 4000.0] {
        let request = many(json!({"budget": {"seconds": seconds}}));
        let choice = choose(&request, &resources(), &converging).0.unwrap();
        let used = choice.expected_wall_time_s / seconds;
        assert!(used <= 0.9, "{seconds}: {choice:?}");
        assert!(used >= 0.8 || choice.reason.contains("nothing finer"), "{seconds}: {used} {choice:?}");
    }
}

#[test]
fn a_speed_that_always_diverges_is_left_out_and_one_that_sometimes_does_is_not() {
    let request = request(json!({"accuracy": {"target": 0.05}}));
    let always =
        |k: f64, s: f64, speed: f64| if speed > 350.0 { (None, false) } else { converging(k, s, speed) };
    let choice = choose(&request, &resources(), &always).0.unwrap();
    assert!(
        choice.estimated_at == 3 && choice.reason.contains("no run was completed at the others"),
        "{choice:?}"
    );
    let coarse = |k: f64, s: f64, speed: f64| if k < 150.0 { (None, false) } else { converging(k, s, speed) };
    let sometimes = |k: f64, s: f64, speed: f64| {
        if speed > 350.0 { coarse(k, s, speed) } else { converging(k, s, speed) }
    };
    let choice = choose(&request, &resources(), &sometimes).0;
    // With few modes nothing speaks against them but the three other speeds; a pair of which one is completed does.
    assert!(
        choice.as_ref().is_ok_and(|choice| choice.estimated_at == 3 || choice.setting.modes_per_speed >= 160)
    );
    let message = choose(&request, &resources(), &|_, _, _| (None, false)).0.unwrap_err();
    assert!(message.contains("grew without bound"), "{message}");
}

#[test]
fn little_memory_is_no_accuracy() {
    let request = request(json!({"accuracy": {"target": 0.05}}));
    for most in [20, 21] {
        let scarce = Resources { most_modes: Some(most), ..resources() };
        let message = choose(&request, &scarce, &converging).0.unwrap_err();
        assert!(message.contains("more memory"), "{message}");
    }
    let scarce = Resources { most_modes: Some(40), ..resources() };
    let message = choose(&request, &scarce, &converging).0.unwrap_err();
    assert!(message.contains("from the modes"), "{message}");
}

#[test]
fn a_chaotic_response_is_refused_at_its_spread_and_no_later() {
    let level = |modes: f64, steps: f64, _: f64| (Some(1.0 + 0.02 * (modes * steps).sin()), false);
    let target = |target: f64| request(json!({"accuracy": {"target": target}}));
    // Standard error of the difference of two levels: √2 · 0.0791/√5 = 0.05.
    let (refused, runs) = choose(&target(0.03), &resources(), &level);
    let message = refused.unwrap_err();
    let said =
        "is chaotic (a tiny perturbation grows by e^(0.125 ± 0.002) a revolution from revolution 17 on)";
    assert!(message.contains(said) && message.contains("e-2 only"), "{message}");
    assert!(runs <= 3 * 4 + 1, "{runs}");
    let (choice, runs) = choose(&target(0.06), &resources(), &level);
    assert!((choice.unwrap().spread - 0.05).abs() < 1e-3);
    assert_eq!(runs, 3 * 4, "chance is not refined");
}

#[test]
fn what_beats_is_not_refused() {
    let level = |modes: f64, steps: f64, _: f64| (Some(1.0 + 0.02 * (modes * steps).sin()), false);
    let request = request(json!({"accuracy": {"target": 0.03}}));
    for (growth, word) in [
        (Growth::QuasiPeriodic, "is quasi-periodic"),
        (Growth::Undecided, "too short to say whether it is chaotic"),
        (Growth::Stable, "forgets a tiny perturbation"),
    ] {
        let choice = choose_of(growth, &request, &resources(), &level).0.unwrap();
        // Said, and in the estimate.
        assert!(choice.reason.contains(word) && choice.reason.contains("e-2 only"), "{}", choice.reason);
        assert!(choice.spread > 0.03 && choice.estimated_error >= choice.spread, "{choice:?}");
    }
}

/// Budget of runs that take four of ten revolutions here, and may take all at other speeds.
#[test]
fn a_budget_allows_for_marches_that_do_not_repeat() {
    let choice = |asked: serde_json::Value, length: &str| {
        let mut asked = asked;
        asked["integration"] = json!({"window_revolutions": 5});
        asked["integration"][length] = json!(10);
        choose(&request(asked), &resources(), &converging).0.unwrap()
    };
    let budget = json!({"budget": {"seconds": 300}});
    let [whole, early] = ["revolutions", "most_revolutions"].map(|length| choice(budget.clone(), length));
    assert_eq!(early.setting, whole.setting);
    assert!(
        (early.expected_wall_time_s / whole.expected_wall_time_s - 1.0).abs() < 1e-12,
        "{early:?} {whole:?}"
    );
    let target = json!({"accuracy": {"target": 0.05}});
    let [whole, early] = ["revolutions", "most_revolutions"].map(|length| choice(target.clone(), length));
    assert_eq!(early.setting, whole.setting);
    assert!(
        (early.expected_wall_time_s / whole.expected_wall_time_s - 0.4).abs() < 1e-12,
        "{early:?} {whole:?}"
    );
}

#[test]
fn a_budget_is_spent_on_what_matters_and_not_exceeded() {
    let of = |seconds: f64| request(json!({"budget": {"seconds": seconds}}));
    let mut last = f64::INFINITY;
    for seconds in [30.0, 300.0, 3000.0] {
        let choice = choose(&of(seconds), &resources(), &converging).0.unwrap();
        assert!(choice.expected_wall_time_s <= 0.9 * seconds, "{choice:?}");
        assert!(choice.estimated_error <= last, "{choice:?}");
        last = choice.estimated_error;
    }
    let reduced = Resources { reductions: vec![(20, 0.1), (40, 0.1)], ..resources() };
    let message = choose(&of(0.5), &reduced, &converging).0.unwrap_err();
    assert!(message.contains("give at least"), "{message}");
    let slow = Resources { reductions: vec![(20, 100.0)], ..resources() };
    let message = choose(&of(30.0), &slow, &converging).0.unwrap_err();
    assert!(message.contains("the reduction with 40 modes"), "{message}");
}
