//! Fixtures of branches: a resonance that stiffens where the tips touch, with bifurcations along it.

use serde_json::{Value, json};

use super::{map, point, rad_s, sensor, units};
use rubmap_analysis::result::{Branches, Point};

/// Speed in rpm at which the response has this amplitude, on the way up or on the way down.
pub(super) fn way(up: bool, amplitude: f64) -> f64 {
    let beside = 1200.0 * (1.0 / amplitude.powi(2) - 1.0).max(0.0).sqrt();
    22_000.0 * (1.0 + 0.2 * amplitude.powi(2)) + if up { -beside } else { beside }
}

fn multiplier(modulus: f64, angle: f64) -> Value {
    json!({"real": modulus * angle.cos(), "imaginary": modulus * angle.sin(), "modulus": modulus, "residual": 1e-9,
        "order_offset": angle / std::f64::consts::TAU, "nodal_diameter": 3, "share": 0.98})
}

fn response(rpm: f64, amplitude: f64, stability: &str) -> Value {
    let modulus = if stability == "stable" { 0.93 } else { 1.04 };
    json!({"value": rad_s(rpm), "speed_rad_s": rad_s(rpm), "half_peak_to_peak": [amplitude, 0.5 * amplitude],
        "stability": stability, "multipliers": [multiplier(modulus, 1.2)], "lobe_passages": 1, "residual": 1e-10,
        "newton_steps": 3, "revolutions": 2.5})
}

fn bifurcation(kind: &str, rpm: f64, amplitude: f64) -> Value {
    let mut found = json!({"kind": kind, "value": rad_s(rpm), "speed_rad_s": rad_s(rpm), "error": rad_s(0.024),
        "half_peak_to_peak": [amplitude, 0.5 * amplitude]});
    if kind != "fold" {
        found["multiplier"] = multiplier(1.000_001, 1.2);
        found["stable_modulus"] = json!(if kind == "neimark_sacker" { 0.62 } else { 0.999 });
    }
    found
}

/// Speed in rpm and amplitude at which the branch turns back, between two amplitudes.
fn turn(low: f64, high: f64, sign: f64) -> (f64, f64) {
    let all = (0..=20_000).map(|k| low + (high - low) * f64::from(k) / 20_000.0);
    let best = all.max_by(|a, b| (sign * way(false, *a)).total_cmp(&(sign * way(false, *b)))).unwrap();
    (way(false, best), best)
}

/// Branches of a resonance: two folds, two flips with the branch between them on which motions repeat at every second lobe only, and on
/// that a second frequency; `whole`: followed to all ends.
pub(super) fn resonance(whole: bool) -> Branches {
    let (top, bottom) = (turn(0.9, 1.0, 1.0), turn(0.4, 0.7, -1.0));
    let (mut points, first) = (Vec::new(), 0.168);
    for k in 0..=60 {
        let amplitude: f64 = first + (1.0 - first) * (1.0 - (1.0 - f64::from(k) / 60.0).powi(2));
        let doubled = (0.5..0.7).contains(&amplitude);
        let word = if doubled { "flip" } else { "stable" };
        points.push(response(way(true, amplitude), amplitude, word));
    }
    for k in 1..=60 {
        let amplitude = 1.0 - 0.69 * f64::from(k) / 60.0;
        let word = match amplitude {
            a if a > top.1 || a < bottom.1 => "stable",
            // Multipliers of some points could not be found.
            a if (a - 0.80).abs() < 0.04 => "undecided",
            _ => "fold",
        };
        points.push(response(way(false, amplitude), amplitude, word));
    }
    let flips = [(way(true, 0.5), 0.5), (way(true, 0.7), 0.7)];
    let maximum = |sensor: u32, height: f64| {
        json!({"sensor": sensor, "value": rad_s(way(true, 1.0)), "speed_rad_s": rad_s(way(true, 1.0)), "error": rad_s(0.3),
            "half_peak_to_peak": height, "stability": "stable"})
    };
    let leaves = json!({"why": "leaves_range"});
    let main = json!({
        "branch": 0, "points": points,
        "bifurcations": [bifurcation("flip", flips[0].0, flips[0].1), bifurcation("flip", flips[1].0, flips[1].1),
            bifurcation("fold", top.0, top.1), bifurcation("fold", bottom.0, bottom.1)],
        "maxima": [maximum(0, 1.0), maximum(1, 0.5)],
        "ends": if whole { vec![leaves.clone(), leaves] } else { vec![leaves] },
    });
    let swell = |amplitude: f64| 0.09 * (1.0 - ((amplitude - 0.6) / 0.1).powi(2)).max(0.0).sqrt();
    let doubled: Vec<Value> = (0..=17)
        .map(|k| {
            let amplitude = 0.5 + 0.2 * f64::from(k) / 20.0;
            let word = if (0.58..0.65).contains(&amplitude) { "neimark_sacker" } else { "stable" };
            response(way(true, amplitude), amplitude + swell(amplitude), word)
        })
        .collect();
    let split = [0.58, 0.65].map(|a| bifurcation("neimark_sacker", way(true, a), a + swell(a)));
    let doubled = json!({
        "branch": 1, "lobe_passages": 2, "doubles": [0, rad_s(flips[0].0)], "points": doubled, "bifurcations": split,
        "maxima": [], "ends": [{"why": "lost", "reason": "the search came no closer than 1.2e-5"}],
    });
    serde_json::from_value(json!({
        "parameter": "speed", "sensors": [sensor(), {"contact_node": 2, "sector": 0, "component": "axial"}],
        "scheme": "exact_modal", "steps_per_revolution": 4096, "units": units(),
        "settings": {"sweep": map().settings, "along": {"parameter": "speed", "from": rad_s(15_500.0), "to": rad_s(26_600.0)},
            "doubled": true, "most_points": 400},
        "version": "0", "vectors": "V4", "complete": whole, "branches": if whole { vec![main, doubled] } else { vec![main] },
    }))
    .unwrap()
}

/// Branch over the clearance, with a point that meets another response.
pub(super) fn over_clearance() -> Branches {
    let mut over = json!(resonance(true));
    over["parameter"] = json!("clearance");
    over["settings"]["along"] = json!({"parameter": "clearance", "from": 0.5, "to": 1.5});
    over["branches"].as_array_mut().unwrap().truncate(1);
    let branch = &mut over["branches"][0];
    let at = |share: f64| 1.4 - 0.8 * share + 0.15 * (9.0 * share).sin();
    let count = branch["points"].as_array().unwrap().len();
    for (k, point) in branch["points"].as_array_mut().unwrap().iter_mut().enumerate() {
        let share = k as f64 / count as f64;
        (point["value"], point["speed_rad_s"]) = (json!(at(share)), json!(rad_s(24_000.0)));
        point["half_peak_to_peak"][0] = json!(0.2 + 0.5 * share);
        point["stability"] = json!(if share < 0.6 { "stable" } else { "fold" });
    }
    let mut meets = bifurcation("branching", 24_000.0, 0.2 + 0.5 * 0.6);
    meets["value"] = json!(at(0.6));
    meets["error"] = json!(3.1e-6);
    branch["bifurcations"] = json!([meets]);
    branch["maxima"] = json!([]);
    branch["ends"] = json!([{"why": "leaves_range"}, {"why": "most_points"}]);
    serde_json::from_value(over).unwrap()
}

/// Speeds of a sweep: some beyond the range, one not settled, one without a result.
pub(super) fn marched() -> Vec<Point> {
    let of = |k: u32| {
        let mut one = point(if k == 7 { 3 } else { 0 }, if k == 3 { "failed" } else { "completed" });
        let rpm = 15_000.0 + 800.0 * f64::from(k);
        one["speed_rad_s"] = json!(rad_s(rpm));
        let all = (0..2000).map(|step| f64::from(step) / 2000.0);
        let amplitude = all
            .filter(|a| *a > 0.05)
            .min_by(|a, b| (way(true, *a) - rpm).abs().total_cmp(&(way(true, *b) - rpm).abs()));
        if k != 3 {
            one["responses"][0]["half_peak_to_peak"] =
                json!(amplitude.unwrap() * if k == 7 { 1.3 } else { 1.01 });
        }
        serde_json::from_value(one).unwrap()
    };
    (0..15).map(of).collect()
}
