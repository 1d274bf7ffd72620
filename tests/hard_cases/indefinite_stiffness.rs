//! K(Ω) through three definite matrices that is indefinite between them, as stiffness on the deformed geometry can be.
//!
//! Codes that take square roots of eigenvalues as they come give NaN or a frequency of zero there and integrate an
//! exponentially growing wheel. Guaranteed: the model carries the verdict, that speed fails by name, the others run,
//! and map and critical speeds are made of those.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::PointStatus;
use rubmap::analysis::run::{critical_speeds, interaction_map, map_row, run_speed};
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, assert_survives_json, reduced, scale, sweep};

#[test]
fn a_speed_at_which_the_stiffness_is_indefinite_fails_alone() {
    let mut sector = wheel(WheelRecipe::default());
    // A parabola in Ω² that dips at Ω1/2: K_half is a hundredth of K0, so the interpolant is negative beyond it.
    let factors = [1.0, 0.01, 1.0];
    let rest = sector.stiffness[0].clone();
    for (matrix, factor) in sector.stiffness.iter_mut().zip(factors) {
        *matrix = rest.clone();
        scale(matrix, factor);
    }
    let reduced = reduced(&sector, 6);
    assert_eq!(
        serde_json::to_value(reduced.report.stiffening.verdict).unwrap(),
        json!("unsound"),
        "{}",
        reduced.report.stiffening.message
    );
    for scheme in SCHEMES {
        let request = sweep(&sector, scheme, &[0.1 * TOP_SPEED, 0.7 * TOP_SPEED, TOP_SPEED], json!({}));
        let results: Vec<_> =
            (0..3).map(|index| run_speed(&reduced, &request, index, &Unwatched).unwrap()).collect();
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
        assert_survives_json(&map);
        let points: Vec<_> = results.into_iter().map(|result| result.point).collect();
        let critical = critical_speeds(&reduced, &request, &points, &Unwatched).unwrap();
        assert_eq!(critical.len(), request.sensors.len());
        assert_eq!(critical[0].missing, [1]);
        assert_survives_json(&critical);
    }
}
