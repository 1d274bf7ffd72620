//! Indefinite K(Ω) between three definite matrices, as stiffness on the deformed geometry can be.
//!
//! Codes that take square roots of eigenvalues as they come give NaN or a frequency of zero there and integrate an
//! exponentially growing wheel. Guaranteed: the model carries the verdict, that speed fails by name, the others run,
//! and map and critical speeds are made of those.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::{PointStatus, StiffeningVerdict};
use rubmap::analysis::run::{ModelFacts, critical_speeds, interaction_map, map_row, run_speed};
use rubmap::dynamics::sector::SectorModel;
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{ENERGY_TOLERANCE, SCHEMES, assert_sound, assert_survives_json, reduced, scale, sweep};

/// Sector with K(Ω) = f(Ω²) K(0) through the factors 1, `half` and 1 at rest, Ω1/2 and Ω1.
fn dips(half: f64) -> SectorModel {
    let mut sector = wheel(WheelRecipe::default()).into_parts();
    let rest = sector.stiffness[0].clone();
    for (matrix, factor) in sector.stiffness.iter_mut().zip([1.0, half, 1.0]) {
        *matrix = rest.clone();
        scale(matrix, factor);
    }
    SectorModel::new(sector).unwrap()
}

#[test]
fn a_speed_at_which_the_stiffness_is_indefinite_fails_alone() {
    // A parabola in Ω² that dips at Ω1/2: K_half is a hundredth of K0, so the interpolant is negative beyond it.
    let sector = dips(0.01);
    let reduced = reduced(&sector, 6);
    assert_eq!(
        serde_json::to_value(reduced.report.stiffening.verdict).unwrap(),
        json!("unsound"),
        "{}",
        reduced.report.stiffening.message
    );
    // Its matrices alone say as much as they can: K = f K0, f = 1 − c x + c x² with x = (Ω/Ω1)².
    let c = 0.99 * 16.0 / 3.0;
    let preliminary = ModelFacts::of(&sector).stiffening.unwrap();
    assert_eq!(preliminary.verdict, StiffeningVerdict::Suspect);
    let found = &reduced.report.stiffening;
    assert_eq!(
        (preliminary.linear_ratio, preliminary.quadratic_ratio),
        (found.linear_ratio, found.quadratic_ratio)
    );
    assert!((found.linear_ratio - c).abs() < 1e-12 && (found.quadratic_ratio - c).abs() < 1e-12, "{found:?}");
    for scheme in SCHEMES {
        let request = sweep(&sector, scheme, &[0.1 * TOP_SPEED, 0.7 * TOP_SPEED, TOP_SPEED], json!({}));
        let results: Vec<_> =
            (0..3).map(|index| run_speed(&reduced, &request, index, None, &Unwatched).unwrap()).collect();
        let status: Vec<_> = results.iter().map(|r| r.point.status).collect();
        assert_eq!(status, [PointStatus::Completed, PointStatus::Failed, PointStatus::Completed]);
        assert_sound(&results[0], 1.0);
        assert_sound(&results[2], 1.0);
        let message = results[1].point.message.as_deref().unwrap();
        assert!(message.contains("not positive definite") && message.contains("2100 rad/s"), "{message}");
        let rows = results.iter().map(|result| {
            let row = result.spectra.as_ref().and_then(|spectra| map_row(spectra, 0, None));
            (result.point.clone(), row.map(<[f64]>::to_vec))
        });
        let map = interaction_map(&request, &reduced.units, rows.collect(), 0, None);
        assert!(map.amplitude[0].is_some() && map.amplitude[1].is_none() && map.amplitude[2].is_some());
        assert_eq!(map.points.len(), 3);
        assert!(map.points.iter().all(|point| point.stiffening == Some(StiffeningVerdict::Unsound)));
        assert_eq!(map.stiffening, Some(StiffeningVerdict::Unsound));
        assert_survives_json(&map);
        let points: Vec<_> = results.into_iter().map(|result| result.point).collect();
        let critical = critical_speeds(&reduced, &request, &points, None, &Unwatched).unwrap();
        assert_eq!(critical.len(), request.sensors().len());
        assert_eq!(critical[0].missing, [1]);
        assert_survives_json(&critical);
    }
}

/// Speeds ever closer to that at which K(Ω) vanishes, from both sides: the wheel is ever softer, then none. Soft wheels
/// run, or fly off and are stopped; beyond, every speed fails by name.
#[test]
fn at_the_edge_of_definiteness_every_speed_has_a_verdict() {
    let half = 0.01;
    let sector = dips(half);
    let reduced = reduced(&sector, 6);
    // f(x) = 1 − c x + c x² with x = (Ω/Ω1)² and f(1/4) = half.
    let c = (1.0 - half) * 16.0 / 3.0;
    let speed_of = |f: f64| TOP_SPEED * (0.5 - (0.25 - (1.0 - f) / c).sqrt()).sqrt();
    let factors = [1e-1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15, 0.0, -1e-15, -1e-12, -1e-9, -1e-6, -1e-2];
    let speeds = factors.map(speed_of);
    for scheme in SCHEMES {
        let request = sweep(&sector, scheme, &speeds, json!({}));
        for (index, factor) in factors.iter().enumerate() {
            let result = run_speed(&reduced, &request, index, None, &Unwatched).unwrap();
            assert_survives_json(&result);
            let message = result.point.message.as_deref().unwrap_or_default();
            match result.point.status {
                PointStatus::Completed => {
                    assert!(*factor > 0.0, "{factor:e}: {:?}", result.point);
                    assert_sound(&result, 1.0);
                }
                PointStatus::Diverged => {
                    assert!((0.0..1e-2).contains(factor), "{factor:e}: {:?}", result.point);
                    assert!(message.contains("after") && result.spectra.is_none(), "{message}");
                    assert!(result.point.energy_residual.unwrap() < ENERGY_TOLERANCE, "{:?}", result.point);
                }
                PointStatus::Failed => {
                    // Round-off of f is some 1e-15.
                    assert!(*factor < 1e-14, "{factor:e}: {:?}", result.point);
                    let speed = format!("at {} rad/s", result.point.speed_rad_s);
                    assert!(message.contains(&speed), "{message}");
                }
            }
        }
    }
}
