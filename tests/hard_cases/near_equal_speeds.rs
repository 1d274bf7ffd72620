//! Speeds 1e-12 apart, and equal ones, in one sweep: across a linear crossing, where the prediction is bracketed by them.
//!
//! Divisions by the distance of two speeds, root finders that must make progress and peaks on a curve that hardly
//! changes break here. Guaranteed: every speed runs, results differ as little as the speeds do, and map and critical
//! speeds are finite numbers.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::resolved::ResolvedModalAnalysis;
use rubmap::analysis::run::{
    ModelFacts, ReducedSector, critical_speeds, interaction_map, map_row, modal_analysis,
    resolve_modal_analysis,
};
use rubmap::dynamics::sector::SectorModel;
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, assert_survives_json, reduced, run, spectral_difference, sweep};

/// Request for a Campbell diagram over `speeds`.
fn campbell(sector: &SectorModel, speeds: &[f64]) -> ResolvedModalAnalysis {
    let request =
        json!({"model": "test wheel", "modes_per_speed": 6, "speeds": {"values": speeds, "unit": "rad_s"}});
    resolve_modal_analysis(serde_json::from_value(request).unwrap(), &ModelFacts::of(sector)).unwrap()
}

/// Speed at which the linear criterion is met, from a coarse diagram.
fn crossing(sector: &SectorModel, reduced: &ReducedSector) -> f64 {
    let speeds: Vec<f64> = (1..=20).map(|i| 0.05 * f64::from(i) * TOP_SPEED).collect();
    let diagram = modal_analysis(reduced, &campbell(sector, &speeds), &Unwatched).unwrap();
    let found = diagram.crossings.iter().find(|c| c.speed_rad_s > 0.4 * TOP_SPEED);
    found.expect("the wheel has crossings in its range").speed_rad_s
}

#[test]
fn a_sweep_over_a_hair() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    let middle = crossing(&sector, &reduced);
    let factors = [-2.0, -1.0, 0.0, 0.0, 1.0, 2.0];
    let speeds = factors.map(|factor| middle * (1.0 + 1e-12 * factor));
    assert!(speeds[1] < speeds[2] && speeds[3] < speeds[4]);
    for scheme in SCHEMES {
        let request = sweep(&sector, scheme, &speeds, json!({"integration": {"revolutions": 30}}));
        let results = run(&reduced, &request);
        for result in &results {
            assert_sound(result, 1.0);
            assert!(result.point.contact_share > 0.01);
            // A settled response moves with the speed; 1e-12 and round-off, amplified by a lightly damped wheel.
            let difference = spectral_difference(result, &results[2]);
            assert!(difference < 1e-8, "{scheme}: {difference:e}");
        }
        assert_eq!(results[2].spectra, results[3].spectra, "equal speeds, equal bits");

        for nodal_diameter in [None, Some(2)] {
            let rows = results.iter().map(|result| {
                let row = map_row(result.spectra.as_ref().unwrap(), 0, nodal_diameter).unwrap();
                (result.point.clone(), Some(row.to_vec()))
            });
            assert_survives_json(&interaction_map(
                &request,
                &reduced.units,
                rows.collect(),
                0,
                nodal_diameter,
            ));
        }

        let points: Vec<_> = results.into_iter().map(|result| result.point).collect();
        let tables = critical_speeds(&reduced, &request, &points, None, &Unwatched).unwrap();
        assert_survives_json(&tables);
        assert!(tables[0].missing.is_empty());
        let nearest =
            tables[0].linear_crossings.iter().find(|c| (c.speed_rad_s / middle - 1.0).abs() < 3e-12);
        assert!(nearest.is_some(), "{scheme}: {:?}", tables[0].linear_crossings);
        // Differences of the curve are round-off, far below a prominence worth a line.
        assert!(tables.iter().all(|table| table.critical_speeds.is_empty()), "{tables:?}");
    }
}

/// The Campbell diagram on the same grid: ascending speeds, a crossing between two of them.
#[test]
fn a_campbell_diagram_over_a_hair() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    let middle = crossing(&sector, &reduced);
    let speeds = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|factor| middle * (1.0 + 1e-12 * factor));
    let diagram = modal_analysis(&reduced, &campbell(&sector, &speeds), &Unwatched).unwrap();
    assert_survives_json(&diagram);
    assert!(diagram.crossings.iter().any(|c| (c.speed_rad_s / middle - 1.0).abs() < 3e-12), "{diagram:?}");
    for row in &diagram.frequencies_hz {
        for (line, first) in row.iter().zip(&diagram.frequencies_hz[0]) {
            for (f, first) in line.iter().zip(first) {
                assert!((f / first - 1.0).abs() < 1e-11, "{f} {first}");
            }
        }
    }
}
