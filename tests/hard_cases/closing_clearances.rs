//! Clearances that close while the wheel turns: by its own growth, by heat, and from before the start.
//!
//! A wall that is moved into the tips between two steps hits them with a force of the step. Guaranteed: clearances close over a twentieth
//! of a revolution at least, or are refused at their place; then every scheme runs, pressed tips come to rest where the casing is, and
//! what is opened again leaves the wheel as it was.

use rubmap::analysis::error::Violation;
use rubmap::analysis::request::SweepRequest;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::run::{MeshFacts, ModelFacts, ReducedSector, resolve_sweep};
use rubmap::analysis::stress::{StaticStress, StaticWheel};
use rubmap::analysis::tip_growth::TipGrowth;
use rubmap::dynamics::reduction::static_response;
use rubmap::dynamics::sector::SectorModel;
use serde_json::{Value, json};

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, merge, reduced, run};

const SPEEDS: [f64; 2] = [0.3 * TOP_SPEED, 0.6 * TOP_SPEED];

fn asked(sector: &SectorModel, scheme: &str, changes: Value) -> SweepRequest {
    let mut request = json!({
        "model": "test wheel", "modes_per_speed": 6,
        "speeds": {"values": SPEEDS, "unit": "rad_s"},
        "scene": {
            "centrifugal_stiffening": sector.stiffness.len() == 3,
            "damping": {"modal_ratio": 0.2},
            "casing": {"clearance": {"values": [0.3, 0.26, 0.22]}},
            "contact": {}
        },
        "integration": {"scheme": scheme, "revolutions": 12, "window_revolutions": 4},
        "sensors": [{"contact_node": 0, "sector": 0, "component": "normal"},
                    {"contact_node": 2, "sector": 1, "component": "normal"}],
        "max_engine_order": 12
    });
    merge(&mut request, changes);
    serde_json::from_value(request).unwrap()
}

/// Resolves a request as for a model with elements.
fn resolved(sector: &SectorModel, scheme: &str, changes: Value) -> Result<ResolvedSweep, Vec<Violation>> {
    let mesh = Some(MeshFacts { elements: 1, sets: Vec::new(), tip_thickness: None });
    resolve_sweep(asked(sector, scheme, changes), &ModelFacts { mesh, ..ModelFacts::of(sector) })
}

/// Reduces the wheel with tips that grow by up to 0.5 mm at the higher speed: their nodes are pulled outwards.
pub(crate) fn growing(sector: &SectorModel) -> (ReducedSector, Vec<Vec<f64>>) {
    let mut load = vec![0.0; sector.own_dofs()];
    for (k, node) in sector.contact.iter().enumerate() {
        load[node.dofs[0]] = 1.0 + 0.3 * k as f64;
    }
    let solved = |load: &[f64]| {
        let response = static_response(sector, load, &|_, _| true).unwrap();
        let speeds = response.solutions.ncols();
        let displacement = (0..sector.own_dofs())
            .flat_map(|dof| (0..speeds).map(|speed| response.solutions[(dof, speed)]).collect::<Vec<_>>())
            .collect();
        let stress = StaticStress { stress: Vec::new(), span: response.span };
        TipGrowth::of(&StaticWheel { stress, displacement }, &sector.contact)
    };
    let most = solved(&load).at(SPEEDS[1], true).into_iter().fold(0.0, f64::max);
    load.iter_mut().for_each(|force| *force *= 0.5 / most);
    let growth = solved(&load);
    let at = SPEEDS.iter().map(|speed| growth.at(*speed, true)).collect();
    (ReducedSector { growth: Some(growth.into()), ..reduced(sector, 6) }, at)
}

/// Running clearances are cold ones less the growth, to the bit.
#[test]
fn cold_clearances_are_running_ones_that_are_larger() {
    let sector = wheel(WheelRecipe { stiffening: true, ..WheelRecipe::default() });
    let (reduced, growth) = growing(&sector);
    assert!(growth[1].iter().zip(&growth[0]).all(|(fast, slow)| *fast > 2.0 * slow && *slow > 0.0));
    for scheme in SCHEMES {
        let lobes = json!({"count": 2, "amplitude": 0.3, "width_rad": 0.35});
        let cold = json!({"scene": {"casing": {"clearance": {"values": [0.5, 0.46, 0.52], "given": "cold"}, "lobes": lobes}}});
        let cold = run(&reduced, &resolved(&sector, scheme, cold).unwrap());
        for (index, result) in cold.iter().enumerate() {
            assert_sound(result, 1.0);
            let running: Vec<f64> =
                [0.5, 0.46, 0.52].iter().zip(&growth[index]).map(|(cold, growth)| cold - growth).collect();
            assert_eq!(result.point.running_clearance, running);
            let same = json!({"scene": {"casing": {"clearance": {"values": running}, "lobes": lobes}}});
            let same = run(&reduced, &resolved(&sector, scheme, same).unwrap()).remove(index);
            assert_eq!(result.spectra, same.spectra, "{scheme}");
            assert_eq!((&result.point.contact, &result.point.tip), (&same.point.contact, &same.point.tip));
        }
        assert!(cold[1].point.contact_share > cold[0].point.contact_share, "{scheme}");
    }
}

/// Pressed tips, which grow into a circular casing or are pressed into it from the start, lean on it at rest, displaced by as much as they would
/// be in it.
#[test]
fn pressed_tips_come_to_rest_on_the_casing() {
    let sector = wheel(WheelRecipe { stiffening: true, ..WheelRecipe::default() });
    let (reduced, growth) = growing(&sector);
    let tight = [0.1, 0.12, 0.14];
    let pressed: Vec<f64> = tight.iter().zip(&growth[1]).map(|(cold, growth)| cold - growth).collect();
    assert!(pressed.iter().all(|clearance| *clearance < -0.05), "{pressed:?}");
    for scheme in SCHEMES {
        for clearance in [json!({"values": tight, "given": "cold"}), json!({"values": pressed})] {
            let changes =
                json!({"scene": {"casing": {"clearance": clearance}}, "integration": {"revolutions": 40}});
            let result = run(&reduced, &resolved(&sector, scheme, changes).unwrap()).remove(1);
            assert_sound(&result, 1.0);
            assert!(result.point.contact_share > 0.9, "{scheme}: {:?}", result.point);
            for (response, node) in result.point.responses.iter().zip([0, 2]) {
                assert!(response.mean < pressed[node] + 1e-9, "{scheme}: {response:?} {pressed:?}");
                assert!(response.rms < 1e-9, "{scheme}: {response:?}");
            }
            // The node that is pressed most leans on the casing; another may be carried away from it.
            let deepest = &result.point.responses[0];
            assert!((deepest.mean - pressed[0]).abs() < 1e-9, "{scheme}: {deepest:?} {pressed:?}");
        }
    }
}

/// Casing that closes, and opens again.
#[test]
fn what_closes_presses_and_what_opens_lets_go() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    let course = |points: &[(f64, f64)]| {
        let points: Vec<Value> =
            points.iter().map(|(at, change)| json!({"revolutions": at, "change": change})).collect();
        json!({"scene": {"clearance_change": {"course": points}}, "integration": {"revolutions": 60}})
    };
    for scheme in SCHEMES {
        let of = |points: &[(f64, f64)]| {
            let result = run(&reduced, &resolved(&sector, scheme, course(points)).unwrap()).remove(1);
            assert_sound(&result, 1.0);
            result.point
        };
        let closed = of(&[(1.0, -0.2), (1.05, -0.5)]);
        for (response, clearance) in closed.responses.iter().zip([0.3 - 0.5, 0.22 - 0.5]) {
            assert!(
                (response.mean - clearance).abs() < 1e-9 && response.rms < 1e-9,
                "{scheme}: {response:?}"
            );
        }
        let opened = of(&[(1.0, -0.5), (3.0, -0.5), (4.0, 0.1)]);
        assert!(opened.contact_share > 0.0 && opened.contact_share < 0.1, "{scheme}: {opened:?}");
        for response in &opened.responses {
            assert!(response.mean.abs() < 1e-9 && response.rms < 1e-9, "{scheme}: {response:?}");
        }
    }
}

#[test]
fn what_would_close_in_one_step_is_refused_at_its_place() {
    let sector = wheel(WheelRecipe::default());
    let refused = |changes: Value| -> Vec<String> {
        let violations = resolved(&sector, "exact_modal", changes).unwrap_err();
        violations.into_iter().map(|violation| violation.pointer).collect()
    };
    let course = |points: Value| json!({"scene": {"clearance_change": {"course": points}}});
    let at = |revolutions: f64, change: f64| json!({"revolutions": revolutions, "change": change});
    let place = |index: usize, field: &str| vec![format!("/scene/clearance_change/course/{index}/{field}")];
    assert_eq!(refused(course(json!([at(0.0, -0.3)]))), place(0, "revolutions"));
    assert_eq!(refused(course(json!([at(1.0, -0.1), at(1.001, -0.3)]))), place(1, "revolutions"));
    assert_eq!(refused(course(json!([at(1.0, -1e4)]))), place(0, "change"));
    assert_eq!(refused(course(json!([at(9.0, -0.1)]))), ["/scene/clearance_change/course"]);
    assert_eq!(refused(course(json!([]))), ["/scene/clearance_change/course"]);
    let short = |clearance: Value| json!({"scene": {"casing": {"clearance": clearance}}, "integration": {"ramp_revolutions": 0.01}});
    assert_eq!(refused(short(json!({"values": [0.3, -0.1, 0.3]}))), ["/integration/ramp_revolutions"]);
    assert_eq!(refused(short(json!({"given": "cold"}))), ["/integration/ramp_revolutions"]);
    let mut chain = json!({"sweep": "up"});
    merge(&mut chain, json!({"scene": {"casing": {"clearance": {"given": "cold"}}}}));
    assert_eq!(refused(chain), ["/sweep"]);
    // Elements make the load.
    let cold = asked(&sector, "exact_modal", json!({"scene": {"casing": {"clearance": {"given": "cold"}}}}));
    let violations = resolve_sweep(cold, &ModelFacts::of(&sector)).unwrap_err();
    assert_eq!(violations[0].pointer, "/scene/casing/clearance/given");
}
