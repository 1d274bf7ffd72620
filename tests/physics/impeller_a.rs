//! Impeller A, the real one of shared/models, against CalculiX's own cyclic symmetry analysis. Skipped, with a printed
//! reason, where that folder is not beside the project.

use std::f64::consts::TAU;
use std::path::PathBuf;

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::{PointStatus, SpeedResult, StiffeningVerdict};
use rubmap::analysis::run::{ModelFacts, ReducedSector, prepare, resolve_sweep, run_speed};
use rubmap::dynamics::modal_wheel::natural_frequencies;
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::package;

/// First six frequencies in Hz per nodal diameter at rest, CalculiX 2.20 (shared/models/README.md).
const AT_REST: [[f64; 6]; 6] = [
    [2250.532, 3882.676, 4357.521, 5331.555, 7097.620, 7399.572],
    [2249.651, 3723.802, 5225.965, 7024.713, 7173.055, 8649.346],
    [2249.385, 3762.181, 5224.063, 6876.748, 7263.497, 8056.316],
    [2263.519, 4026.406, 5196.940, 6496.768, 7307.770, 7813.667],
    [2277.568, 4368.738, 5056.804, 6085.106, 7298.426, 7808.075],
    [2283.033, 4698.776, 4792.489, 5931.419, 7293.537, 7817.600],
];

/// First six frequencies in Hz per nodal diameter at 3750 rad/s, between the given speeds: scipy on the package's matrices (same source).
const AT_3750: [[f64; 6]; 6] = [
    [2377.784, 3967.540, 4371.175, 5379.838, 7240.414, 7499.295],
    [2378.126, 3816.289, 5278.659, 7110.114, 7340.602, 8810.242],
    [2380.714, 3879.960, 5283.116, 7025.803, 7407.135, 8249.953],
    [2398.008, 4174.145, 5274.395, 6686.062, 7482.016, 7909.712],
    [2413.539, 4539.200, 5178.326, 6248.107, 7494.609, 7853.531],
    [2419.365, 4876.834, 4949.678, 6061.889, 7493.245, 7853.211],
];

fn model(name: &str) -> Option<PathBuf> {
    let shared = std::env::var_os("RUBMAP_SHARED")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared"), PathBuf::from);
    let path = shared.join("models").join(name);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: {} is not there; set RUBMAP_SHARED to the folder that holds models/", path.display());
    None
}

fn reduced(path: &std::path::Path, modes_per_speed: u32) -> (ReducedSector, ModelFacts) {
    let imported = package::read(path, &package::Limits::default()).unwrap();
    (
        prepare(&imported.sector, modes_per_speed, None, &NoCheckpoints, &Unwatched).unwrap(),
        ModelFacts::of(&imported.sector),
    )
}

fn compare(reduced: &ReducedSector, speed: f64, table: &[[f64; 6]; 6], tolerance: f64) {
    for (harmonic, row) in reduced.wheel.harmonics.iter().zip(table) {
        let found = natural_frequencies(harmonic, speed, true).unwrap();
        for (omega, expected) in found.iter().zip(row) {
            let deviation = omega / TAU / expected - 1.0;
            // Rayleigh–Ritz bounds from above, to the table's seven digits.
            assert!(
                (-2e-6..tolerance).contains(&deviation),
                "nodal diameter {} at {speed} rad/s: {} for {expected}",
                harmonic.harmonic,
                omega / TAU
            );
        }
    }
}

#[test]
fn frequencies_equal_calculix_in_both_frames() {
    for name in ["impeller-a.zip", "impeller-a-cartesian.zip"] {
        let Some(path) = model(name) else { return };
        let (reduced, _) = reduced(&path, 20);
        // The paper claims 1 % at k = 20; this sector reaches 0.04 %.
        compare(&reduced, 0.0, &AT_REST, 5e-4);
        compare(&reduced, 3750.0, &AT_3750, 5e-4);
        assert_eq!(reduced.report.stiffening.verdict, StiffeningVerdict::Sound);
        assert!(reduced.report.stiffening.linear_ratio < 1.1e-3);
        assert!(reduced.report.stiffening.quadratic_ratio < 1e-13);
        assert!(reduced.report.largest_mode_residual < 1e-9);
    }
}

/// Deformed geometry: stiffness exported on it is noticed, explained, with an honest error (0.55 % by CalculiX).
#[test]
fn deformed_geometry_is_detected() {
    let Some(path) = model("impeller-a-nlgeom.zip") else { return };
    let (reduced, _) = reduced(&path, 8);
    let stiffening = &reduced.report.stiffening;
    assert_eq!(stiffening.verdict, StiffeningVerdict::Suspect);
    assert!((4e-3..8e-3).contains(&stiffening.linear_ratio), "{stiffening:?}");
    assert!((5e-4..2e-3).contains(&stiffening.quadratic_ratio), "{stiffening:?}");
    assert!((3e-3..8e-3).contains(&stiffening.frequency_error), "{stiffening:?}");
    assert!(stiffening.message.contains("deformed geometry"));
}

fn simulate(path: &std::path::Path) -> SpeedResult {
    let (reduced, facts) = reduced(path, 8);
    let request = serde_json::json!({
        "model": "impeller-a", "modes_per_speed": 8,
        "speeds": {"values": [3000.0], "unit": "rad_s"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.02},
            "casing": {"clearance": {"leading": 0.27, "trailing": 0.198},
                       "lobes": {"count": 2, "amplitude": 0.3825, "width_rad": 0.35}},
            "contact": {}
        },
        "integration": {"revolutions": 12, "window_revolutions": 4}
    });
    let request = resolve_sweep(serde_json::from_value(request).unwrap(), &facts).unwrap();
    run_speed(&reduced, &request, 0, None, &Unwatched).unwrap()
}

/// Cartesian twin: it gives the same spectra, as the frame is the exporter's affair.
#[test]
fn both_frames_give_the_same_spectra() {
    let (Some(cylindrical), Some(cartesian)) = (model("impeller-a.zip"), model("impeller-a-cartesian.zip"))
    else {
        return;
    };
    let (a, b) = (simulate(&cylindrical), simulate(&cartesian));
    assert_eq!(a.point.status, PointStatus::Completed);
    assert!(a.point.contact_share > 0.05 && a.point.energy_residual.unwrap() < 1e-9, "{:?}", a.point);
    assert_eq!(a.point.steps_per_revolution, b.point.steps_per_revolution);
    let (a, b) = (a.spectra.unwrap(), b.spectra.unwrap());
    for (a, b) in a.sensors.iter().zip(&b.sensors) {
        let scale = a.amplitude.iter().fold(0.0f64, |m, &x| m.max(x));
        for (x, y) in a.amplitude.iter().zip(&b.amplitude) {
            // Round-off of the rotation, carried through twelve damped revolutions of contact.
            assert!((x - y).abs() < 1e-6 * scale, "{x} {y}");
        }
        // Two lobes on ten sectors: the even engine orders respond.
        let order = |k: usize| a.amplitude[4 * k];
        assert!(order(2) > 1e3 * order(1) && order(4) > 1e3 * order(3));
    }
}
