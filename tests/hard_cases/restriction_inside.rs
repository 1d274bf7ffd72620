//! Restriction that reaches into the blade before anything moves.
//!
//! The first step would find the blade inside the casing and throw it out at once: forces grow as 1/h and energies as 1/h²,
//! a finer step makes it worse, and the result is a number of the step and not of the machine. Guaranteed: refused at its field,
//! with the heights, unless the restriction grows over at least a twentieth of a revolution; then every scheme runs.

use rubmap::analysis::request::SweepRequest;
use rubmap::analysis::run::{ModelFacts, resolve_sweep};
use rubmap::dynamics::schemes::Scheme;
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::scenes::Scene;
use crate::support::{SCHEMES, assert_sound, reduced, run, sweep};

#[test]
fn refused_without_a_ramp_and_sound_with_one() {
    let sector = wheel(WheelRecipe::default());
    let facts = ModelFacts::of(&sector);
    let reduced = reduced(&sector, 6);
    for scheme in SCHEMES {
        let grown = sweep(&sector, scheme, &[0.6 * TOP_SPEED], json!({}));
        let over = |revolutions: f64, amplitude: f64| -> SweepRequest {
            let mut request = SweepRequest::from(grown.clone());
            request.integration.ramp_revolutions = revolutions;
            request.scene.casing.as_mut().unwrap().lobes.as_mut().unwrap().amplitude = amplitude;
            request
        };
        for ramp in [0.0, 0.049] {
            let violations = resolve_sweep(over(ramp, 0.425), &facts).unwrap_err();
            assert_eq!(violations.len(), 1, "{violations:?}");
            assert_eq!(violations[0].pointer, "/integration/ramp_revolutions");
            for said in ["0.425", "0.22", "at least 0.05"] {
                assert!(violations[0].message.contains(said), "{violations:?}");
            }
        }
        // Lobes that end at the smallest clearance need no ramp.
        for request in [over(0.05, 0.425), over(1.0, 0.425), over(0.0, 0.22)] {
            let touches = request.integration.ramp_revolutions > 0.0;
            let request = resolve_sweep(request, &facts).unwrap();
            let results = run(&reduced, &request);
            assert_sound(&results[0], 1.0);
            assert_eq!(results[0].point.contact_share > 0.0, touches, "{scheme}: {:?}", results[0].point);
        }
    }
}

/// Energy without a ramp is a matter of the step, which is why such a restriction is refused.
#[test]
fn without_a_ramp_the_energy_grows_with_the_number_of_steps() {
    let energies = |ramp: f64| {
        let mut scene = Scene::new(WheelRecipe::default());
        scene.revolutions = 1;
        scene.casing.as_mut().unwrap().ramp_revolutions = ramp;
        let steps = scene.steps(Scheme::CentralDifferences, 1.3);
        [1, 4].map(|finer| {
            let run = scene.run(Scheme::CentralDifferences, finer * steps);
            run.energy.largest_energy()
        })
    };
    let [coarse, fine] = energies(0.0);
    assert!(fine > 8.0 * coarse, "{coarse} {fine}");
    let [coarse, fine] = energies(0.5);
    assert!((fine / coarse - 1.0).abs() < 0.2, "{coarse} {fine}");
}
