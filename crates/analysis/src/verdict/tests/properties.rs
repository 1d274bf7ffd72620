//! Properties over random sweeps, drawn from a fixed seed.

use serde_json::json;

use super::scene::{Scene, point, range};
use crate::result::{PointStatus, SweepVerdict, VerdictWord};

/// Random numbers in [0, 1) by a linear congruential generator (Knuth, The Art of Computer Programming 2, 3.3.4: MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn chance(&mut self, of: f64) -> bool {
        self.next() < of
    }
}

/// Sweep with random levels, errors, ranges and limits; some of its speeds are missing, failed, diverged or unsettled.
fn sweep(random: &mut Random) -> Scene {
    // Half of them smooth, with a resolved peak or none: otherwise something would always be open.
    let mut scene = if random.chance(0.5) {
        let levels: Vec<f64> = (0..21).map(|_| 0.2 + 1.2 * random.next().powi(3)).collect();
        Scene::of(|speed| levels[speed as usize - 100])
    } else {
        let (top, height) = ((100.0 + 20.0 * random.next()).round(), 0.2 + 0.8 * random.next());
        let slope = if random.chance(0.5) { 0.04 } else { 0.0 };
        Scene::of(|speed| height * (1.0 - slope * (speed - top).abs()))
    };
    let from = 99.0 + 15.0 * random.next();
    let to = from + 1.0 + 8.0 * random.next();
    scene.ranges = json!([range("run", from, to, 6.0 * random.next())]);
    scene.limits = json!({"tip_motion": 0.3 + 2.0 * random.next(), "node_force": 5.0 + 30.0 * random.next()});
    scene.errors = random.chance(0.7).then(|| (0.3 * random.next(), None));
    for index in 0..21 {
        if random.chance(0.02) {
            scene = scene.with([index], "/status", &json!("diverged"));
        } else if random.chance(0.03) {
            scene = scene.with([index], "/settling/verdict", &json!("not_settled"));
        } else if random.chance(0.03) {
            scene = scene.with([index], "", &serde_json::Value::Null);
        }
    }
    scene
}

/// Whether a speed of the range passes a limit by more than its error, or by more than a fifth where none is known, told from the scene alone.
fn is_passed(scene: &Scene) -> bool {
    let of = &scene.ranges[0];
    let separation = of["separation_percent"].as_f64().unwrap() / 100.0;
    let from = of["from"].as_f64().unwrap() * (1.0 - separation);
    let to = of["to"].as_f64().unwrap() * (1.0 + separation);
    scene.points.iter().filter(|point| point["status"] == json!(PointStatus::Completed)).any(|point| {
        let speed = point["speed_rad_s"].as_f64().unwrap();
        let motion = point["tip"]["half_peak_to_peak"].as_f64().unwrap();
        let error = scene.errors.map_or(0.2, |(error, _)| error);
        let limit = |name: &str| scene.limits[name].as_f64().unwrap();
        let beyond =
            motion > (1.0 + error) * limit("tip_motion") || 10.0 * motion > 1.2 * limit("node_force");
        from <= speed && speed <= to && beyond
    })
}

fn verdicts() -> impl Iterator<Item = (Scene, SweepVerdict, Random)> {
    (0..600).map(|case| {
        let mut random = Random(case);
        random.next();
        let scene = sweep(&mut random);
        let verdict = scene.verdict();
        (scene, verdict, random)
    })
}

#[test]
fn a_sweep_with_a_limit_passed_is_reason_to_act() {
    let mut seen = [0; 4];
    for (scene, found, _) in verdicts() {
        seen[found.verdict as usize] += 1;
        if is_passed(&scene) {
            assert_eq!(found.verdict, VerdictWord::Act, "{}", found.sentence);
        }
        assert!(
            found.verdict == VerdictWord::Act
                || found.would_decide.is_empty() == (found.verdict < VerdictWord::Undecided)
        );
        assert!(!found.sentence.is_empty() && found.worst.len() <= 3);
    }
    assert!(seen.iter().all(|&count| count > 5), "every verdict is drawn: {seen:?}");
}

#[test]
fn speeds_outside_the_range_never_soften_a_verdict() {
    let mut seen = [0; 4];
    for (scene, found, _) in verdicts() {
        let of = &scene.ranges[0];
        let end = |name: &str| of[name].as_f64().unwrap();
        if end("to") * (1.0 + end("separation_percent") / 100.0) > 118.0 {
            continue;
        }
        seen[found.verdict as usize] += 1;
        let mut wider = scene.clone();
        for (speed, level) in [(121.0, 1.0), (122.0, 15.0), (123.0, 30.0), (124.0, 28.0), (125.0, 1.0)] {
            wider.points.push(point(wider.speeds.len(), speed, level));
            wider.speeds.push(speed);
        }
        assert!(wider.word() >= found.verdict, "{} {}", found.sentence, wider.verdict().sentence);
    }
    assert!(seen.iter().all(|&count| count > 5), "every verdict is drawn: {seen:?}");
}

#[test]
fn a_stricter_limit_or_a_wider_range_never_softens_act() {
    let mut acts = 0;
    for (scene, found, mut random) in verdicts() {
        if found.verdict != VerdictWord::Act {
            continue;
        }
        acts += 1;
        let mut stricter = scene.clone();
        for limit in ["tip_motion", "node_force"] {
            stricter.limits[limit] = json!(scene.limits[limit].as_f64().unwrap() * random.next().max(1e-3));
        }
        stricter.limits["clearance_consumption"] = json!(random.next() + 1e-3);
        assert_eq!(stricter.word(), VerdictWord::Act);
        let mut wider = scene.clone();
        let of = &scene.ranges[0];
        let end = |name: &str| of[name].as_f64().unwrap();
        wider.ranges = json!([range(
            "run",
            end("from") - 50.0 * random.next(),
            end("to") + 50.0 * random.next(),
            end("separation_percent") + 5.0 * random.next()
        )]);
        assert_eq!(wider.word(), VerdictWord::Act);
    }
    assert!(acts > 50, "{acts}");
}
