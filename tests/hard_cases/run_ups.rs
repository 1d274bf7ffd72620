//! Wheels whose speed changes: runs that end within a critical speed, begin with everything closed, or turn round at once.
//!
//! The state is handed on hundreds of times, from basis to basis and from step to step, and what touches is never let go of. Guaranteed: the
//! energy identity holds in every piece, no scheme loses or gains energy where the state is handed on, tips stay out of the casing; a run that
//! ends where it swings most says that it does.

use rubmap::analysis::request::RunUpRequest;
use rubmap::analysis::result::{RunUpEnd, RunUps};
use rubmap::analysis::run::{MeshFacts, ModelFacts, ReducedSector, resolve_run_ups};
use rubmap::dynamics::sector::SectorModel;
use serde_json::{Value, json};

use crate::closing_clearances::growing;
use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{ENERGY_TOLERANCE, SCHEMES, merge, reduced};
use crate::to_the_end::to_the_end;

fn told(sector: &SectorModel, reduced: &ReducedSector, scheme: &str, changes: Value) -> RunUps {
    let mut request = json!({
        "model": "test wheel", "modes_per_speed": 6,
        "speed": {"unit": "rad_s", "from": 0.3 * TOP_SPEED, "to": 0.5 * TOP_SPEED, "rates": [4000.0]},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.02},
            "casing": {"clearance": {"leading": 0.3, "trailing": 0.22},
                       "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}},
            "contact": {}
        },
        "integration": {"scheme": scheme}, "max_engine_order": 12
    });
    merge(&mut request, changes);
    let request: RunUpRequest = serde_json::from_value(request).unwrap();
    // The model has elements, so that its growth is known.
    let mesh = Some(MeshFacts { elements: 1, sets: Vec::new(), tip_thickness: None });
    let facts = ModelFacts { mesh, ..ModelFacts::of(sector) };
    to_the_end(reduced, &resolve_run_ups(request, &facts).unwrap(), &facts)
}

#[track_caller]
fn sound(found: &RunUps) -> &RunUpEnd {
    let end = found.runs[0].end.as_ref().unwrap();
    assert!(end.is_complete(), "{:?}", end.message);
    assert!(end.energy_residual < ENERGY_TOLERANCE, "{end:?}");
    assert!(end.transfer_loss < 1e-3, "{end:?}");
    assert!(end.largest_penetration.unwrap_or(0.0) < 1e-9, "{end:?}");
    assert!(end.largest.iter().all(|largest| largest.displacement.is_finite()), "{end:?}");
    end
}

/// Run-up driven at an engine order through the resonance of its nodal diameter, or only into it.
#[test]
fn a_run_that_ends_within_a_critical_speed_says_so() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    for scheme in SCHEMES {
        let run = |to: f64| {
            let scene = json!({"contact": null, "casing": null, "damping": {"modal_ratio": 0.01},
                "engine_order_excitation": [{"order": 3, "amplitude": 1.0, "contact_nodes": [0], "component": "radial"}]});
            let speed = json!({"from": 850.0, "to": to, "rates": [400.0], "hold_s": 0.05});
            told(&sector, &reduced, scheme, json!({"scene": scene, "speed": speed}))
        };
        let through = run(1180.0);
        let end = sound(&through);
        assert_eq!(end.message, None);
        let critical = end.largest[0].speed_rad_s;
        assert!((1030.0..1150.0).contains(&critical), "{critical}");
        let into = run(critical - 15.0);
        let message = sound(&into).message.as_deref().unwrap_or_default();
        assert!(message.contains("may end within a critical speed"), "{message}");
    }
}

/// Run up and at once down again, in contact all the while, by every scheme, with angles that are coarse and fine: the same envelope.
#[test]
fn contact_is_handed_on_without_loss() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    let points = json!([{"time_s": 0.0, "speed": 900.0}, {"time_s": 0.1, "speed": 1300.0}, {"time_s": 0.2, "speed": 900.0}]);
    for scheme in SCHEMES {
        let run = |tolerance: f64| {
            let speed = json!({"unit": "rad_s", "points": points, "course": "smooth", "from": null, "to": null, "rates": null});
            told(&sector, &reduced, scheme, json!({"speed": speed, "angle_tolerance_rad": tolerance}))
        };
        let (coarse, fine) = (run(4e-3), run(2.5e-4));
        for found in [&coarse, &fine] {
            let end = sound(found);
            assert!(end.contact_share > 0.05, "{end:?}");
        }
        let ends = [&coarse, &fine].map(|found| found.runs[0].end.as_ref().unwrap());
        assert!(ends[1].segments > 2 * ends[0].segments, "{} {}", ends[0].segments, ends[1].segments);
        for (a, b) in ends[0].largest.iter().zip(&ends[1].largest) {
            assert!((a.displacement / b.displacement - 1.0).abs() < 0.1, "{scheme}: {a:?} {b:?}");
        }
    }
}

/// Run-down whose cold clearances are closed at first, and open as the tips shrink: the casing comes with its ramp, whatever the step, and the
/// wheel is let go.
#[test]
fn what_presses_at_first_lets_go() {
    let sector = wheel(WheelRecipe { stiffening: true, ..WheelRecipe::default() });
    let (reduced, growth) = growing(&sector);
    assert!(growth[1].iter().any(|growth| *growth > 0.42) && growth[0].iter().all(|growth| *growth < 0.3));
    for scheme in SCHEMES {
        let run = |steps: u32| {
            let casing = json!({"clearance": {"leading": null, "trailing": null, "values": [0.42, 0.42, 0.42], "given": "cold"}, "lobes": null});
            let speed = json!({"from": 0.6 * TOP_SPEED, "to": 0.3 * TOP_SPEED, "rates": [9000.0]});
            let scene = json!({"casing": casing, "damping": {"modal_ratio": 0.2}});
            let mut integration = json!({"steps_per_revolution": steps});
            if scheme == "massless_boundary" {
                integration["kept_modes"] = json!(5);
            }
            told(
                &sector,
                &reduced,
                scheme,
                json!({"speed": speed, "scene": scene, "integration": integration}),
            )
        };
        let energies = [20_800, 41_600].map(|steps| {
            let found = run(steps);
            let end = sound(&found);
            let frames = &found.runs[0].frames;
            assert!(frames[0].contact_share > 0.5 && frames.last().unwrap().contact_share == 0.0, "{end:?}");
            assert!(frames.last().unwrap().largest[0] < 0.01 * end.largest[0].displacement, "{end:?}");
            end.largest_energy
        });
        assert!((energies[1] / energies[0] - 1.0).abs() < 0.05, "{scheme}: {energies:?}");
    }
}
