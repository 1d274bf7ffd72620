//! Observed orders in smooth free motion, and convergence with the modes on the demo's impeller. The orders with contact are held
//! against theory on the bouncing bar (`dynamics::bouncing_bar`).

use rubmap::analysis::request::{SchemeChoice, StudyRequest};
use rubmap::analysis::run::{Trial, TrialRequest, WorkPrecision, resolve_study, work_precision};
use rubmap::impeller::{ImpellerParameters, PaperCasing};
use serde_json::{Value, json};

use crate::wheel::Wheel;

fn study(wheel: &mut Wheel, body: Value) -> WorkPrecision {
    let request: StudyRequest = serde_json::from_value(body).unwrap();
    let request = resolve_study(request, &wheel.facts).unwrap();
    let facts = wheel.facts.clone();
    let trials: Vec<(TrialRequest, Trial)> =
        request.all_trials(facts.sectors).into_iter().map(|run| (run.clone(), wheel.run(&run))).collect();
    let find = |wanted: &TrialRequest| trials.iter().find(|(run, _)| run == wanted).map(|(_, trial)| trial);
    work_precision(&request, (facts.sectors, &facts.units), &[], &find).unwrap().0
}

/// Request for one travelling mode, lightly damped, that touches nothing.
fn free_motion() -> Value {
    json!({
        "model": "",
        "speeds": {"values": [2000.0], "unit": "rad_s"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.002},
            "initial": {"nodal_diameter": 1, "family": 2, "amplitude": 0.1, "wave": "forward"},
        },
        "integration": {"revolutions": 4, "ramp_revolutions": 0, "window_revolutions": 2},
        "history_revolutions": 3,
    })
}

#[test]
fn central_differences_are_of_second_order_in_free_motion() {
    let mut body = free_motion();
    // These steps are above the limit of the stiffest mode.
    body["grid"] = json!({"modes_per_speed": [2], "schemes": ["central_differences"],
        "steps_per_revolution": [40_000, 80_000, 160_000]});
    let found = study(&mut Wheel::coarse(5), body);
    let order = &found.speeds[0].orders[0];
    assert_eq!(order.scheme, SchemeChoice::CentralDifferences);
    let observed = order.orders[0].expect("differences fall");
    assert!((observed - 2.0).abs() < 0.02, "{order:?}");
}

#[test]
fn the_exact_propagator_is_exact_in_free_motion() {
    let mut body = free_motion();
    body["grid"] = json!({"modes_per_speed": [2], "schemes": ["exact_modal"], "steps_per_revolution": [500, 2000, 8000]});
    let found = study(&mut Wheel::coarse(5), body);
    let order = &found.speeds[0].orders[0];
    assert!(order.differences.iter().all(|difference| difference.is_some_and(|d| d < 1e-9)), "{order:?}");
    assert_eq!(order.orders, [None], "round-off has no order");
}

/// Numbers of modes of the paper on the demo's impeller: every larger one is closer to the reference, in the displacement over the first revolutions.
#[test]
fn more_modes_are_closer() {
    let casing = PaperCasing::of(&ImpellerParameters::default());
    let found = study(
        &mut Wheel::of(&ImpellerParameters::default()),
        json!({
            "model": "",
            "speeds": {"values": [24_000], "unit": "rpm"},
            "scene": {
                "centrifugal_stiffening": true,
                "damping": {"modal_ratio": 0.005},
                "casing": {
                    "clearance": {"leading": casing.leading_clearance, "trailing": casing.trailing_clearance},
                    "lobes": {"count": 2, "amplitude": casing.restriction, "width_rad": 0.35},
                },
                "contact": {},
            },
            "grid": {"schemes": ["exact_modal"], "steps_per_revolution": [3600]},
            "integration": {"revolutions": 5, "ramp_revolutions": 1, "window_revolutions": 2},
        }),
    );
    let runs = &found.speeds[0].runs;
    assert_eq!(runs.iter().map(|run| run.unknowns).collect::<Vec<_>>()[0], 330);
    let errors: Vec<f64> = runs.iter().map(|run| run.errors.unwrap().history.unwrap()).collect();
    println!("{errors:?}");
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
    assert!(errors[4] < 0.05 && errors[0] > 5.0 * errors[4], "{errors:?}");
}
