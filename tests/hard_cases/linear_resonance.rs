//! Resonance: a speed chosen so that an engine order of the lobes meets a natural frequency of the nodal diameter it drives, to the last digits.
//!
//! A frequency-domain answer divides by zero here, and a time-domain one grows until contact or damping stops it; step
//! and period of the vibration are commensurate, so that errors of the step add up instead of averaging out.
//! Guaranteed: with damping a finite, settled response that names the resonance; without, a run whose energy is
//! accounted for, or a verdict that it grew beyond bounds; never a number from a run that broke.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::{PointStatus, Verdict};
use rubmap::analysis::run::{ReducedSector, run_speed};
use rubmap::dynamics::modal_wheel::natural_frequencies;
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{ENERGY_TOLERANCE, SCHEMES, assert_sound, assert_survives_json, reduced, run, sweep};

/// Casing of two lobes of height `amplitude` around a clearance of 0.3.
fn casing(amplitude: f64) -> serde_json::Value {
    json!({"clearance": {"leading": 0.3, "trailing": 0.3}, "lobes": {"amplitude": amplitude}})
}

/// Engine order that meets the mode: second harmonic of two lobes, which drives nodal diameter 4 on ten sectors.
const ORDER: f64 = 4.0;
const NODAL_DIAMETER: usize = 4;

/// Natural frequency ω of the first family of the driven nodal diameter, rad/s.
fn natural(reduced: &ReducedSector, speed: f64) -> f64 {
    natural_frequencies(&reduced.wheel.harmonics[NODAL_DIAMETER], speed, true).unwrap()[0]
}

/// Resonant speed Ω with kΩ = ω(Ω): the fixed point of Ω = ω(Ω)/k, which contracts as long as stiffening is weak.
fn resonance(reduced: &ReducedSector) -> f64 {
    let speed = (0..200).fold(0.5 * TOP_SPEED, |speed, _| natural(reduced, speed) / ORDER);
    let mismatch = (ORDER * speed / natural(reduced, speed) - 1.0).abs();
    assert!(mismatch < 1e-14, "{mismatch:e}");
    assert!((0.1 * TOP_SPEED..TOP_SPEED).contains(&speed), "{speed}");
    speed
}

#[test]
fn with_damping_the_response_settles_and_names_the_resonance() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    let speed = resonance(&reduced);
    for scheme in SCHEMES {
        for ratio in [0.02, 0.05] {
            let changes = json!({
                "scene": {"damping": {"modal_ratio": ratio}, "casing": casing(0.425)},
                "integration": {"revolutions": 40, "window_revolutions": 8}
            });
            let results = run(&reduced, &sweep(&sector, scheme, &[speed, 0.93 * speed], changes));
            results.iter().for_each(|result| assert_sound(result, 1.0));
            let [at, below] = [0, 1].map(|i| &results[i].point);
            let settling = at.settling.as_ref().unwrap();
            assert_eq!((settling.verdict, settling.ratio), (Verdict::Periodic, Some(1)), "{at:?}");
            let response = &at.responses[0];
            assert_eq!(response.dominant_engine_order, Some(ORDER));
            assert_eq!(response.dominant_nodal_diameter, Some(NODAL_DIAMETER as u32));
            assert!(response.rms > 1.05 * below.responses[0].rms, "{at:?} {below:?}");
        }
    }
}

#[test]
fn without_damping_numbers_are_finite_or_withheld() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    let speed = resonance(&reduced);
    for scheme in SCHEMES {
        // The lobes touch, push, and never let go.
        for amplitude in [0.302, 0.425, 1.2] {
            let changes = json!({
                "scene": {"damping": null, "casing": casing(amplitude)},
                "integration": {"revolutions": 60, "window_revolutions": 8}
            });
            let request = sweep(&sector, scheme, &[speed], changes);
            let result = run_speed(&reduced, &request, 0, None, &Unwatched).unwrap();
            assert_survives_json(&result);
            match result.point.status {
                PointStatus::Completed => assert_sound(&result, 1.0),
                PointStatus::Diverged => {
                    assert!(result.point.message.as_ref().unwrap().contains("revolutions"));
                    assert!(result.spectra.is_none() && result.point.responses.is_empty());
                    // Grown, not broken: what was integrated until then is accounted for.
                    assert!(result.point.energy_residual.unwrap() < ENERGY_TOLERANCE);
                }
                PointStatus::Failed => panic!("{:?}", result.point),
            }
        }
    }
}
