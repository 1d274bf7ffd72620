//! A sweep through the door: the stability limit, speeds that fail by name, results with their credentials.

use rubmap::analysis::auto_or::AutoOr;
use rubmap::analysis::error::AnalysisError;
use rubmap::analysis::monitor::{Monitor, Unwatched};
use rubmap::analysis::request::SweepRequest;
use rubmap::analysis::result::{PointStatus, Verdict};
use rubmap::analysis::run::{
    ModelFacts, ReducedSector, check, critical_speeds, interaction_map, map_row, prepare, resolve_sweep,
    run_speed,
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
    resolve_sweep(serde_json::from_value(request).unwrap(), &ModelFacts::of(sector)).unwrap()
}

fn reduced(sector: &SectorModel) -> ReducedSector {
    prepare(sector, 6, None, &NoCheckpoints, &Unwatched).unwrap()
}

/// One step fewer than the smallest stable number is refused before anything runs, with that number in the message;
/// that number itself is integrated with its energy accounted for, and so is every speed of the range.
#[test]
fn fixed_steps_are_held_against_the_stability_limit_of_the_slowest_speed() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector);
    let mut request = request(&sector, &[0.9 * TOP_SPEED, 0.3 * TOP_SPEED]);
    let auto = run_speed(&reduced, &request, 1, &Unwatched).unwrap().point;
    let smallest = auto.smallest_stable_steps_per_revolution;
    assert!(auto.steps_per_revolution > smallest);
    request.integration.steps_per_revolution = AutoOr::Fixed(smallest - 1);
    let Err(AnalysisError::Refused(violations)) = check(&reduced, &request, &Unwatched) else {
        panic!("{} steps must be refused", smallest - 1);
    };
    assert_eq!(violations[0].pointer, "/integration/steps_per_revolution");
    assert!(violations[0].message.contains(&format!("at least {smallest}")), "{violations:?}");
    request.integration.steps_per_revolution = AutoOr::Fixed(smallest);
    check(&reduced, &request, &Unwatched).unwrap();
    for index in 0..2 {
        let point = run_speed(&reduced, &request, index, &Unwatched).unwrap().point;
        assert_eq!(point.status, PointStatus::Completed, "{point:?}");
        assert_eq!(point.steps_per_revolution, smallest);
        assert!(point.energy_residual.unwrap() < 1e-9, "{point:?}");
    }
}

/// K(Ω) through three matrices that are definite, indefinite in between: those speeds fail by name, the others run,
/// and the model carries the verdict.
#[test]
fn a_speed_at_which_the_stiffness_is_indefinite_fails_alone() {
    let mut sector = wheel(WheelRecipe::default());
    // A parabola in Ω² that dips at Ω1/2: K_half is a hundredth of K0, so the interpolant is negative beyond it.
    let factors = [1.0, 0.01, 1.0];
    let rest = sector.stiffness[0].clone();
    for (matrix, factor) in sector.stiffness.iter_mut().zip(factors) {
        *matrix = rest.clone();
        for values in [matrix.own.val_mut(), matrix.next.val_mut()] {
            values.iter_mut().for_each(|v| *v *= factor);
        }
    }
    let reduced = reduced(&sector);
    assert_eq!(
        serde_json::to_value(reduced.report.stiffening.verdict).unwrap(),
        serde_json::json!("unsound"),
        "{}",
        reduced.report.stiffening.message
    );
    let request = request(&sector, &[0.1 * TOP_SPEED, 0.7 * TOP_SPEED, TOP_SPEED]);
    let results: Vec<_> =
        (0..3).map(|index| run_speed(&reduced, &request, index, &Unwatched).unwrap()).collect();
    let status: Vec<_> = results.iter().map(|r| r.point.status).collect();
    assert_eq!(status, [PointStatus::Completed, PointStatus::Failed, PointStatus::Completed]);
    let message = results[1].point.message.as_deref().unwrap();
    assert!(message.contains("not positive definite") && message.contains("2100 rad/s"), "{message}");
    let rows = results.iter().map(|result| {
        let row = result.spectra.as_ref().and_then(|spectra| map_row(spectra, 0, None));
        (result.point.clone(), row.map(<[f64]>::to_vec))
    });
    let map = interaction_map(&request, &reduced.units, rows.collect(), 0, None);
    assert!(map.amplitude[0].is_some() && map.amplitude[1].is_none() && map.amplitude[2].is_some());
    assert_eq!(map.points.len(), 3);
    let points: Vec<_> = results.into_iter().map(|result| result.point).collect();
    let critical = critical_speeds(&reduced, &request, &points, &Unwatched).unwrap();
    assert_eq!(critical.len(), request.sensors.len());
    assert_eq!(critical[0].missing, [1]);
}

/// A damped wheel settles: the verdict, the spectra and the summary agree with each other.
#[test]
fn results_are_consistent() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector);
    let mut request = request(&sector, &[0.5 * TOP_SPEED]);
    request.integration.revolutions = 30;
    let result = run_speed(&reduced, &request, 0, &Unwatched).unwrap();
    let settling = result.point.settling.as_ref().unwrap();
    assert_eq!((settling.verdict, settling.ratio), (Verdict::Periodic, Some(1)), "{settling:?}");
    let spectra = result.spectra.unwrap();
    assert_eq!(spectra.engine_orders.len(), 4 * 12 + 1);
    for (response, spectrum) in result.point.responses.iter().zip(&spectra.sensors) {
        // Parseval over the orders kept: what lies above order 12 is missing from the sum, so it is smaller.
        let kept: f64 = spectrum.amplitude[1..].iter().map(|a| 0.5 * a * a).sum();
        assert!(kept.sqrt() <= response.rms * (1.0 + 1e-12) && kept.sqrt() > 0.9 * response.rms);
        assert!((spectrum.amplitude[0] - response.mean.abs()).abs() < 1e-12);
        assert!(response.half_peak_to_peak >= response.rms);
        // A periodic response has lines at whole engine orders only.
        let between = spectrum.amplitude.iter().enumerate().filter(|(bin, _)| bin % 4 != 0);
        assert!(between.map(|(_, a)| *a).fold(0.0, f64::max) < 0.05 * response.rms);
        let bin = (response.dominant_engine_order * 4.0) as usize;
        assert!(spectrum.amplitude[1..].iter().all(|&a| a <= spectrum.amplitude[bin]));
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
    assert!(matches!(run_speed(&reduced, &request, 0, &Impatient), Err(AnalysisError::Cancelled)));
    request.integration.steps_per_revolution = AutoOr::Fixed(100_000);
    assert!(matches!(check(&reduced, &request, &Impatient), Err(AnalysisError::Cancelled)));
}

/// A step that is wider than a lobe would pass it by, with numbers that look fine: refused when given, avoided when
/// chosen.
#[test]
fn narrow_lobes_are_not_stepped_over() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector);
    let mut request = request(&sector, &[0.5 * TOP_SPEED]);
    let lobes = request.scene.casing.as_mut().unwrap().lobes.as_mut().unwrap();
    lobes.width_rad = 2e-3;
    request.integration.steps_per_revolution = AutoOr::Fixed(1000);
    let Err(AnalysisError::Refused(violations)) = check(&reduced, &request, &Unwatched) else {
        panic!("1000 steps pass lobes of 0.002 rad by");
    };
    assert!(violations[0].message.contains("at least 6284"), "{violations:?}");
    request.integration.steps_per_revolution = AutoOr::Auto;
    request.integration.revolutions = 6;
    let point = run_speed(&reduced, &request, 0, &Unwatched).unwrap().point;
    assert!(point.steps_per_revolution >= 31416 && point.contact_share > 0.0, "{point:?}");
}
