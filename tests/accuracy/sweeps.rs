//! Sweeps wide enough for settings beside the climb, boundaries without mass among them, held against references with eight times the
//! modes and sixteen times the steps: at pilot speeds and between them.

use rubmap::analysis::request::SchemeChoice;
use serde_json::json;

use crate::honesty::{Draw, chosen, scene, truth};
use crate::wheel::Wheel;

/// Number of sweeps of each wheel.
const SWEEPS: u64 = 3;

/// Number of speeds of each sweep: enough for cheaper settings to be tried.
const SPEEDS: usize = 42;

/// Indices of the speeds that are compared: the second pilot speed, and one half way to the third.
const LOOKED_AT: [usize; 2] = [14, 20];

#[test]
fn settings_beside_the_climb_keep_their_targets() {
    let threads: Vec<_> = [3_usize, 5]
        .into_iter()
        .map(|sectors| {
            std::thread::spawn(move || {
                let (mut wheel, mut draw) = (Wheel::coarse(sectors), Draw(100 + sectors as u64));
                let mut found = Vec::new();
                for _ in 0..SWEEPS {
                    let (mut body, target) = scene(&mut draw);
                    let slowest = draw.within(10_000.0, 30_000.0);
                    body["speeds"] =
                        json!({"from": slowest, "to": 1.2 * slowest, "count": SPEEDS, "unit": "rpm"});
                    body["accuracy"] = json!({"target": target});
                    let request = wheel.resolved(body);
                    let Ok(choice) = chosen(&mut wheel, &request) else { continue };
                    let explicit = choice.explicit(&request);
                    let errors = LOOKED_AT.map(|index| truth(&mut wheel, &explicit, index));
                    println!(
                        "{target} {:?} estimated {:.4}, true at a pilot speed and between two {errors:.4?}",
                        choice.setting, choice.estimated_error
                    );
                    found.push((target, choice, errors));
                }
                found
            })
        })
        .collect();
    let found: Vec<_> = threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect();
    let beside: Vec<_> = found.iter().filter(|(_, choice, _)| choice.difference > 0.0).collect();
    let massless = beside
        .iter()
        .filter(|(_, choice, _)| choice.setting.scheme == SchemeChoice::MasslessBoundary)
        .count();
    println!("{} chosen, {} of them beside the climb, {massless} without mass", found.len(), beside.len());
    // With fewer this says nothing.
    assert!(massless >= 2);
    let met = |place: usize| beside.iter().filter(|(target, _, errors)| errors[place] <= *target).count();
    println!("targets met in {} at a pilot speed, in {} between two", met(0), met(1));
    assert!(10 * met(0) >= 9 * beside.len());
    assert!(10 * met(1) >= 9 * beside.len());
}
