//! Limits that are passed between the speeds of a sweep.

use serde_json::{Value, json};

use super::scene::Scene;
use crate::result::{OpenKind, VerdictWord};
use VerdictWord::{Clear, Undecided, Watch};
use rubmap_wheel::response::campbell::DrivenCrossing;

/// Scene with contact, modes of one damping ratio, and further effects.
fn damped(scene: Scene, ratio: f64, more: &Value) -> Scene {
    let mut effects = json!({"contact": {}, "damping": {"modal_ratio": ratio}});
    effects.as_object_mut().unwrap().extend(more.as_object().cloned().unwrap());
    scene.asking("scene", effects)
}

/// Level of 0.1 with a low maximum of 0.17 at 110 rad/s, and a peak of `height` at 101 rad/s, outside the range.
fn beside_a_peak(height: f64) -> Scene {
    Scene::of(|speed| match speed {
        110.0 => 0.17,
        101.0 => height,
        _ => 0.1,
    })
}

#[test]
fn a_peak_elsewhere_hides_no_maximum() {
    for height in [0.1, 5.0] {
        let scene = beside_a_peak(height);
        assert_eq!((scene.word(), scene.open()), (Undecided, vec![OpenKind::PeakUnresolved]), "{height}");
    }
}

#[test]
fn a_low_maximum_between_steps_of_a_bandwidth_hides_nothing() {
    // Steps are 1 rad/s of 110, 0.91 %: a bandwidth 2ζ of 1 %, or of 0.8 %.
    let none = json!({});
    for (ratio, limit, word) in
        [(0.005, 1.0, Watch), (0.004, 1.0, Undecided), (0.005, 0.35, Watch), (0.005, 0.33, Undecided)]
    {
        let scene = damped(beside_a_peak(5.0), ratio, &none).limited(json!({"tip_motion": limit}));
        assert_eq!(scene.word(), word, "{ratio} {limit}");
    }
}

#[test]
fn steps_beside_a_linear_critical_speed_are_narrow() {
    let crossing = |speed_rad_s: f64| DrivenCrossing {
        nodal_diameter: 2,
        family: 1,
        engine_order: 8,
        speed_rad_s,
        frequency_hz: 1.0,
        wave: None,
    };
    let beside = |speed: f64, ratio: f64| Scene {
        driven: Some(vec![crossing(speed)]),
        ..damped(Scene::flat(0.1), ratio, &json!({}))
    };
    // Steps are at most 1/106 = 0.94 % of the higher speed.
    assert_eq!(beside(110.0, 0.005).word(), Clear);
    assert_eq!(beside(110.0, 0.004).open(), [OpenKind::RangeNotCovered]);
    let found = beside(110.0, 0.001).verdict();
    assert_eq!(found.verdict, Undecided);
    let open = &found.would_decide[0];
    assert_eq!(
        open.finding,
        "a step of 0.9 % between speeds beside the linear critical speed at 1,050 rpm (engine order 8, nodal diameter 2)"
    );
    assert_eq!(open.remedy, "`refine` of true, or `speeds` in steps of at most 0.5 % there");
    // Outside the range it is none of its business.
    assert_eq!(beside(104.0, 0.001).word(), Clear);
}

#[test]
fn nothing_is_clear_before_the_end() {
    let running = Scene { driven: None, ..Scene::flat(0.1) };
    assert_eq!((running.word(), running.open()), (Undecided, vec![OpenKind::SpeedsMissing]));
}

#[test]
fn a_wheel_that_nothing_touches_tells_nothing() {
    let still = Scene::flat(0.0).with(0..21, "/contact/peak_force", &json!(0.0));
    let found = still.verdict();
    assert_eq!((found.verdict, found.would_decide[0].what), (Undecided, OpenKind::NothingTouches));
    let force = json!({"engine_order_excitation": [{"order": 8, "amplitude": 1.0, "contact_nodes": [0], "component": "axial"}]});
    assert_eq!(damped(still, 0.005, &force).word(), Clear);
}

#[test]
fn a_peak_elsewhere_hides_no_critical_speed() {
    // Peaks of 0.5 at 110 inside the range and of 20 at 119 outside, both resolved.
    for height in [0.1, 20.0] {
        let peak = |speed: f64, at: f64, height: f64| height * (1.0 - 0.09 * (speed - at).abs());
        let scene = Scene::of(|speed| {
            peak(speed, 110.0, 0.5).max(if speed > 117.0 { peak(speed, 119.0, height) } else { 0.1 }).max(0.1)
        });
        let found = scene.verdict();
        assert_eq!((found.verdict, found.ranges[0].critical_inside), (Watch, 1), "{}", found.sentence);
    }
}
