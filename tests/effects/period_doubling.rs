//! Response that doubles its period within the symmetry of its scene (docs/method.md, Symmetry; the paper's area E): odd engine orders under
//! two lobes, carried by even nodal diameters only, on the default impeller.
//!
//! Ten sectors see two lobes as five pairs of opposite blades. Where every second passage of a lobe is the stronger one, a
//! blade's neighbour has its stronger passages when the blade has its weaker ones: what moves at an odd engine order k has the sign
//! (−1)^s in sector s over that of the forced wave, which takes it from nodal diameter k to k + 5, modulo 10 and sign. That is even.

use std::f64::consts::PI;

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::SpeedResult;
use rubmap::analysis::run::{ModelFacts, resolve_sweep, run_speed};
use rubmap::impeller::ImpellerParameters;
use rubmap::response::settling::Verdict;
use serde_json::json;

use crate::support::{assert_sound, reduced};

const SECTORS: usize = 10;
const WINDOW: usize = 20;

/// Amplitudes as `[nodal diameter][engine order]`, whole orders up to 12.
fn amplitudes(result: &SpeedResult) -> Vec<Vec<f64>> {
    let sensor = &result.spectra.as_ref().unwrap().sensors[0];
    let whole = |line: &Vec<f64>| line.iter().step_by(WINDOW).copied().collect();
    sensor.nodal_diameters.iter().map(whole).collect()
}

/// Nodal diameter of a spatial order.
fn aliased(order: usize) -> usize {
    (order % SECTORS).min(SECTORS - order % SECTORS)
}

#[test]
fn odd_engine_orders_on_even_nodal_diameters() {
    let package = rubmap::impeller::generate(&ImpellerParameters::default()).unwrap();
    let sector = rubmap::package::to_sector(package).unwrap();
    let reduced = reduced(&sector, 20);
    let run = |rpm: f64, symmetry: &str| {
        let request = json!({
            "model": "demo impeller", "modes_per_speed": 20, "max_engine_order": 12,
            "speeds": {"values": [rpm * PI / 30.0], "unit": "rad_s"},
            "scene": {
                "centrifugal_stiffening": true,
                "damping": {"modal_ratio": 0.005},
                "casing": {"clearance": {"leading": 0.30, "trailing": 0.22},
                           "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}},
                "contact": {},
                "symmetry": symmetry
            },
            "integration": {"revolutions": 60, "window_revolutions": WINDOW},
            "sensors": [{"contact_node": 9, "sector": 0, "component": "radial"}]
        });
        let request = serde_json::from_value(request).unwrap();
        let request = resolve_sweep(request, &ModelFacts::of(&sector)).unwrap();
        let result = run_speed(&reduced, &request, 0, None, &Unwatched).unwrap();
        assert_sound(&result, 0.3);
        let settling = result.point.settling.clone().unwrap();
        assert_eq!(settling.verdict, Verdict::Periodic, "{rpm} rpm: {settling:?}");
        (settling.lobe_passages, amplitudes(&result))
    };
    // At the slower speed the response repeats with every lobe.
    let (passages, forced) = run(22_700.0, "exact");
    let largest = forced.iter().flatten().copied().fold(0.0, f64::max);
    assert_eq!(passages, Some(1));
    for (order, amplitude) in forced.iter().flat_map(|line| line.iter().enumerate()) {
        assert!(order % 2 == 0 || *amplitude < 1e-4 * largest, "engine order {order}: {amplitude:e}");
    }
    // Half a per cent faster it takes two. The whole wheel does the same.
    for symmetry in ["exact", "full"] {
        let (passages, found) = run(22_850.0, symmetry);
        let largest = found.iter().flatten().copied().fold(0.0, f64::max);
        assert_eq!(passages, Some(2), "{symmetry}");
        for order in 1..=12 {
            let carrier = aliased(if order % 2 == 0 { order } else { order + SECTORS / 2 });
            for (nodal_diameter, line) in found.iter().enumerate() {
                let share = line[order] / largest;
                let place =
                    format!("{symmetry}: engine order {order}, nodal diameter {nodal_diameter}: {share:e}");
                if nodal_diameter == carrier {
                    assert!(order > 6 || share > 0.05, "{place}");
                } else if nodal_diameter % 2 == 1 {
                    assert!(share < 1e-12, "{place}");
                } else {
                    assert!(share < 1e-3, "{place}");
                }
            }
        }
    }
}
