//! Sweep through the door: the stability limit, results with their credentials.

use rubmap::analysis::effects::symmetry::request::Symmetry;
use rubmap::analysis::error::AnalysisError;
use rubmap::analysis::monitor::{Monitor, Unwatched};
use rubmap::analysis::request::SweepRequest;
use rubmap::analysis::request::auto_or::AutoOr;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::result::{PointStatus, Verdict};
use rubmap::analysis::run::{
    ModelFacts, ReducedSector, check, critical_speeds, prepare, resolve_sweep, run_speed,
};
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::sector::SectorModel;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};

fn request(sector: &SectorModel, speeds: &[f64]) -> SweepRequest {
    let request = serde_json::json!({
        "model": "test wheel", "modes_per_speed": 6,
        "speeds": {"values": speeds, "unit": "rad_s"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.02},
            "casing": {"clearance": {"leading": 0.3, "trailing": 0.22},
                       "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}},
            "contact": {}
        },
        "integration": {"scheme": "central_differences", "revolutions": 10, "window_revolutions": 4},
        "max_engine_order": 12
    });
    resolve_sweep(serde_json::from_value(request).unwrap(), &ModelFacts::of(sector)).unwrap().into()
}

/// Sweep of `request` as if it had been resolved.
fn unchecked(request: &SweepRequest) -> ResolvedSweep {
    ResolvedSweep::stored(request.clone(), 0).unwrap()
}

fn reduced(sector: &SectorModel) -> ReducedSector {
    prepare(sector, 6, None, &NoCheckpoints, &Unwatched).unwrap()
}

/// Fixed steps against the stability limit: one step fewer than the smallest stable number is refused before anything
/// runs, with that number in the message; that number itself is integrated with its energy accounted for, and so is
/// every speed of the range.
#[test]
fn fixed_steps_are_held_against_the_stability_limit_of_the_slowest_speed() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector);
    let mut request = request(&sector, &[0.9 * TOP_SPEED, 0.3 * TOP_SPEED]);
    let auto = run_speed(&reduced, &unchecked(&request), 1, None, &Unwatched).unwrap().point;
    let smallest = auto.smallest_stable_steps_per_revolution;
    assert!(auto.steps_per_revolution > smallest);
    request.integration.steps_per_revolution = AutoOr::Fixed(smallest - 1);
    let Err(AnalysisError::Refused(violations)) = check(&reduced, &unchecked(&request), &Unwatched) else {
        panic!("{} steps must be refused", smallest - 1);
    };
    assert_eq!(violations[0].pointer, "/integration/steps_per_revolution");
    assert!(violations[0].message.contains(&format!("at least {smallest}")), "{violations:?}");
    request.integration.steps_per_revolution = AutoOr::Fixed(smallest);
    check(&reduced, &unchecked(&request), &Unwatched).unwrap();
    for index in 0..2 {
        let point = run_speed(&reduced, &unchecked(&request), index, None, &Unwatched).unwrap().point;
        assert_eq!(point.status, PointStatus::Completed, "{point:?}");
        assert_eq!(point.steps_per_revolution, smallest);
        assert!(point.energy_residual.unwrap() < 1e-9, "{point:?}");
    }
}

/// A damped wheel settles: the verdict, the spectra and the summary agree with each other.
#[test]
fn results_are_consistent() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector);
    let mut request = request(&sector, &[0.5 * TOP_SPEED]);
    request.integration.revolutions = AutoOr::Fixed(30);
    let result = run_speed(&reduced, &unchecked(&request), 0, None, &Unwatched).unwrap();
    let settling = result.point.settling.as_ref().unwrap();
    assert_eq!((settling.verdict, settling.ratio), (Verdict::Periodic, Some(1)), "{settling:?}");
    let spectra = result.spectra.unwrap();
    assert_eq!(spectra.engine_orders.len(), 4 * 12 + 1);
    for (response, spectrum) in result.point.responses.iter().zip(&spectra.sensors) {
        // Parseval over the orders kept: what lies above order 12 is missing from the sum, so it is smaller, but for what picking
        // samples of all steps does to the level.
        let kept: f64 = spectrum.amplitude[1..].iter().map(|a| 0.5 * a * a).sum();
        assert!(kept.sqrt() <= response.rms * (1.0 + 1e-3) && kept.sqrt() > 0.9 * response.rms);
        assert!((spectrum.amplitude[0] - response.mean.abs()).abs() < 1e-3 * response.rms);
        assert!(response.half_peak_to_peak >= response.rms);
        // A periodic response has lines at whole engine orders only.
        let between = spectrum.amplitude.iter().enumerate().filter(|(bin, _)| bin % 4 != 0);
        assert!(between.map(|(_, a)| *a).fold(0.0, f64::max) < 0.05 * response.rms);
        let bin = (response.dominant_engine_order.unwrap() * 4.0) as usize;
        assert!(spectrum.amplitude[1..].iter().all(|&a| a <= spectrum.amplitude[bin]));
    }
}

/// Sweep where no line stands out: what never moves, or moves by round-off only, has no dominant line; nor has what moves at higher
/// orders than were asked for. A table of critical speeds says so.
#[test]
fn where_no_line_stands_out_none_is_named() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector);
    let speeds = [0.4 * TOP_SPEED, 0.5 * TOP_SPEED, 0.6 * TOP_SPEED];
    let mut still = request(&sector, &speeds);
    still.scene.casing.as_mut().unwrap().clearance.leading = Some(5.0);
    still.scene.casing.as_mut().unwrap().clearance.trailing = Some(5.0);
    // Two lobes drive even orders only; an exactly symmetric run has no round-off that grows.
    let mut low = request(&sector, &speeds);
    (low.max_engine_order, low.peak_prominence) = (1, 0.0);
    low.scene.damping.as_mut().unwrap().modal_ratio = 0.4;
    low.scene.symmetry = Symmetry::Exact;
    (low.integration.revolutions, low.integration.window_revolutions) = (AutoOr::Fixed(30), 2);
    low.integration.steps_per_revolution = AutoOr::Fixed(4000);
    for (request, moves) in [(&still, false), (&low, true)] {
        let run = |index| run_speed(&reduced, &unchecked(request), index, None, &Unwatched).unwrap().point;
        let points: Vec<_> = (0..3).map(run).collect();
        for response in points.iter().flat_map(|point| &point.responses) {
            assert_eq!(response.rms > 1e-6, moves, "{response:?}");
            let dominant = (response.dominant_engine_order, response.dominant_nodal_diameter);
            assert_eq!(dominant, (None, None), "{response:?}");
        }
        let tables = critical_speeds(&reduced, &unchecked(request), &points, None, &Unwatched).unwrap();
        for table in &tables {
            assert_eq!(table.critical_speeds.is_empty(), !moves);
            assert!(table.critical_speeds.iter().all(|speed| speed.dominant_engine_order.is_none()));
        }
    }
}

struct Impatient;

impl Monitor for Impatient {
    fn progress(&self, _fraction: f64, _phase: &str) {}

    fn is_cancelled(&self) -> bool {
        true
    }
}

#[test]
fn cancellation_is_seen_inside_every_verb() {
    let sector = wheel(WheelRecipe { nodes: 90, ..Default::default() });
    assert!(matches!(prepare(&sector, 6, None, &NoCheckpoints, &Impatient), Err(AnalysisError::Cancelled)));
    let reduced = reduced(&sector);
    let mut request = request(&sector, &[1000.0]);
    assert!(matches!(
        run_speed(&reduced, &unchecked(&request), 0, None, &Impatient),
        Err(AnalysisError::Cancelled)
    ));
    request.integration.steps_per_revolution = AutoOr::Fixed(100_000);
    assert!(matches!(check(&reduced, &unchecked(&request), &Impatient), Err(AnalysisError::Cancelled)));
}

/// Lengths against the wheel: up to what lets a run end without divergence, no more; of a model whose facts do not say where its tips are, any.
#[test]
fn lengths_are_held_against_the_wheel() {
    let sector = wheel(WheelRecipe::default());
    let facts = ModelFacts::of(&sector);
    let radius = 70.0;
    assert_eq!(facts.contact_radius, Some(radius));
    let set = |request: &mut SweepRequest, field: &str, value: f64| {
        let casing = request.scene.casing.as_mut().unwrap();
        match field {
            "/scene/casing/clearance/leading" => casing.clearance.leading = Some(value),
            "/scene/casing/lobes/amplitude" => casing.lobes.as_mut().unwrap().amplitude = value,
            "/scene/casing/lobes/width_rad" => casing.lobes.as_mut().unwrap().width_rad = value,
            "/scene/orbit/radius" => {
                request.scene.orbit = serde_json::from_value(serde_json::json!({"radius": value})).unwrap();
            }
            _ => {
                let initial = serde_json::json!({"nodal_diameter": 1, "family": 1, "amplitude": value});
                request.scene.initial = serde_json::from_value(initial).unwrap();
            }
        }
    };
    let most = [
        ("/scene/casing/clearance/leading", radius, true),
        ("/scene/casing/lobes/amplitude", 0.1 * radius, true),
        (
            "/scene/casing/lobes/width_rad",
            std::f64::consts::SQRT_2 * std::f64::consts::PI / 2.0 * (1.0 - 1e-15),
            false,
        ),
        ("/scene/orbit/radius", 0.1 * radius, true),
        ("/scene/initial/amplitude", 0.1 * radius, true),
    ];
    for (field, most, of_the_wheel) in most {
        let mut request = request(&sector, &[0.5 * TOP_SPEED]);
        set(&mut request, field, most);
        resolve_sweep(request.clone(), &facts).unwrap();
        set(&mut request, field, 1.001 * most);
        let violations = resolve_sweep(request.clone(), &facts).unwrap_err();
        let pointers: Vec<_> = violations.iter().map(|violation| violation.pointer.as_str()).collect();
        assert_eq!(pointers, [field], "{violations:?}");
        // An older version stored facts that knew neither.
        let mut older = serde_json::to_value(&facts).unwrap();
        older
            .as_object_mut()
            .unwrap()
            .retain(|name, _| !["contact_radius", "stiffening"].contains(&name.as_str()));
        let older: ModelFacts = serde_json::from_value(older).unwrap();
        assert_eq!((older.contact_radius, &older.stiffening), (None, &None));
        assert_eq!(resolve_sweep(request, &older).is_ok(), of_the_wheel, "{field}");
    }
    // Without contact the response is linear and may be of any size.
    let mut free = request(&sector, &[0.5 * TOP_SPEED]);
    set(&mut free, "/scene/initial/amplitude", radius);
    free.scene.contact = None;
    resolve_sweep(free, &facts).unwrap();
}

/// Narrow lobes: a step that is wider than a lobe would pass it by, with numbers that look fine. Such a step is refused
/// when given, avoided when chosen.
#[test]
fn narrow_lobes_are_not_stepped_over() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector);
    let mut request = request(&sector, &[0.5 * TOP_SPEED]);
    let lobes = request.scene.casing.as_mut().unwrap().lobes.as_mut().unwrap();
    lobes.width_rad = 2e-3;
    request.integration.steps_per_revolution = AutoOr::Fixed(1000);
    let violations = resolve_sweep(request.clone(), &ModelFacts::of(&sector)).unwrap_err();
    assert_eq!(violations[0].pointer, "/integration/steps_per_revolution");
    assert!(violations[0].message.contains("at least 6284"), "{violations:?}");
    request.integration.steps_per_revolution = AutoOr::Auto;
    request.integration.revolutions = AutoOr::Fixed(6);
    let point = run_speed(&reduced, &unchecked(&request), 0, None, &Unwatched).unwrap().point;
    assert!(point.steps_per_revolution >= 31416 && point.contact_share > 0.0, "{point:?}");
}
