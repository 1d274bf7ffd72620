//! Measured casings: points instead of a formula.
//!
//! A curve through points has corners if it is laid carelessly, and every corner is a blow; where the points have a step it swings
//! beyond them. Guaranteed: responses in a table of lobes converge to those of the lobes with the fourth power of the points'
//! distance, a table is as good as a finer one of its own curve, and a step is passed in steps that see it.

use std::f64::consts::TAU;

use rubmap::analysis::result::SpeedResult;
use rubmap::dynamics::casing::{Lobes, PeriodicSpline, Restriction};
use serde_json::{Value, json};

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, reduced, run, spectral_difference, sweep};

fn angles(points: u32) -> Vec<f64> {
    (0..points).map(|i| TAU * f64::from(i) / f64::from(points)).collect()
}

fn measured(points: u32, height: impl Fn(f64) -> f64) -> Value {
    let angles = angles(points);
    let heights: Vec<f64> = angles.iter().map(|&angle| height(angle)).collect();
    json!({"measured": {"angles_rad": angles, "chord": [0.0], "heights": [heights]}, "lobes": null})
}

fn response(scheme: &str, shape: Value, steps: Value) -> SpeedResult {
    let sector = wheel(WheelRecipe::default());
    let integration = json!({"kept_modes": 7, "steps_per_revolution": steps});
    let changes = json!({"scene": {"casing": shape}, "integration": integration});
    let request = sweep(&sector, scheme, &[0.6 * TOP_SPEED], changes);
    let result = run(&reduced(&sector, 6), &request).remove(0);
    assert_sound(&result, 1.0);
    assert!(result.point.contact_share > 0.0, "{scheme}: {:?}", result.point);
    result
}

#[test]
fn tables_converge_to_lobes_in_fourth_order() {
    let restriction =
        Restriction::from(Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.0 });
    let lobes = |angle: f64| restriction.height(angle, 0);
    for scheme in SCHEMES {
        let exact = response(scheme, json!({}), json!("auto"));
        let steps = json!(exact.point.steps_per_revolution);
        let of = |shape: Value| response(scheme, shape, steps.clone());
        let apart = |points: u32| spectral_difference(&of(measured(points, lobes)), &exact);
        let [coarse, fine, finest] = [120, 240, 480].map(apart);
        // Sets of nodes that touch differ by a step here and there: the order is taken over both halvings together.
        let order = (coarse / finest).log2() / 2.0;
        assert!((3.5..4.5).contains(&order), "{scheme}: {order} of {coarse:e} {fine:e} {finest:e}");
        // The curve of a table, in a table twice as fine, is the same curve as far as it is one of lobes.
        let points = angles(240);
        let heights: Vec<f64> = points.iter().map(|&angle| lobes(angle)).collect();
        let curve = PeriodicSpline::new(&points, &heights);
        let [table, refined] = [of(measured(240, lobes)), of(measured(480, |angle| curve.at(angle)))];
        let refinement = spectral_difference(&table, &refined);
        assert!(refinement < fine, "{scheme}: {refinement:e} {fine:e}");
    }
}

/// Table of the gaps themselves, over a clearance of zero: outward of it, the same casing.
#[test]
fn a_table_of_gaps_is_a_casing() {
    let lobes = Restriction::from(Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.0 });
    let angles = angles(720);
    let gaps =
        |clearance: f64| -> Vec<f64> { angles.iter().map(|&a| lobes.height(a, 0) - clearance).collect() };
    for scheme in SCHEMES {
        for friction in [json!(null), json!({"coefficient": 0.05, "law": "disc"})] {
            if friction.is_object() && scheme == "massless_boundary" {
                continue;
            }
            let over = json!({"clearance": {"leading": 0.3, "trailing": 0.3}, "lobes": null,
                              "measured": {"angles_rad": angles, "heights": vec![gaps(0.0); 3]}});
            let itself = json!({"clearance": {"leading": 0.0, "trailing": 0.0}, "lobes": null,
                                "measured": {"angles_rad": angles, "heights": vec![gaps(0.3); 3]}});
            let of = |casing: Value| {
                let sector = wheel(WheelRecipe::default());
                let integration = json!({"kept_modes": 7, "ramp_revolutions": 0.05, "revolutions": 40});
                let scene =
                    json!({"casing": casing, "friction": friction.clone(), "damping": {"modal_ratio": 0.3}});
                let request = sweep(
                    &sector,
                    scheme,
                    &[0.6 * TOP_SPEED],
                    json!({"scene": scene, "integration": integration}),
                );
                run(&reduced(&sector, 6), &request).remove(0)
            };
            let (over, itself) = (of(over), of(itself));
            for result in [&over, &itself] {
                assert_sound(result, 1.0);
                assert!(result.point.contact_share > 0.0, "{scheme}");
            }
            // Only while it grows is the casing another one.
            let apart = spectral_difference(&over, &itself);
            assert!(apart < 1e-6, "{scheme} {friction}: {apart:e}");
        }
    }
}

/// Step in a casing, half of which stands nearer than the blade tips: within one degree they are inside, and outside again.
#[test]
fn a_step_is_passed_in_steps_that_see_it() {
    let step = |angle: f64| if (1.0..1.0 + TAU / 2.0).contains(&angle) { 0.32 } else { 0.1 };
    for scheme in SCHEMES {
        let result = response(scheme, measured(360, step), json!("auto"));
        // Nine steps from one point to the next, across which the curve has its step.
        assert!(result.point.steps_per_revolution >= 9 * 360, "{scheme}: {:?}", result.point);
    }
}
