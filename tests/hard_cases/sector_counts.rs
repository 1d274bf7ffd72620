//! Wheels of one, two, three and sixty-four sectors.
//!
//! One sector closes on itself, two are each other's neighbour on both sides and have no pair of modes, three have no
//! nodal diameter N/2, and 64 have more nodal diameters than most wheels have blades: transforms, weights and casing
//! tables written for ten sectors trip over each. Guaranteed: whole sweeps of the small ones equal the literal dense
//! scheme; 64 sectors obey Parseval and the symmetry of their casing, and do what one sector does where all do the same.

use std::f64::consts::TAU;

use rubmap::analysis::request::SweepRequest;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::result::SpeedResult;
use rubmap::analysis::run::ReducedSector;
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::SectorModel;
use serde_json::{Value, json};

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::oracle::schemes::Literal;
use crate::oracle::{free_gaps, gauss_seidel};
use crate::support::{
    KEPT_MODES, LIBRARY_SCHEMES, SCHEMES, assert_sound, reduced, run, spectral_difference, sweep,
};

/// Request for a sweep of three revolutions, the last of them recorded, at 1.3 times the smallest stable number of
/// steps; a multiple of 512 steps has 512 samples.
fn request(sector: &SectorModel, reduced: &ReducedSector, name: &str, scheme: Scheme) -> ResolvedSweep {
    let speeds = [0.4, 0.7, 1.0].map(|share| share * TOP_SPEED);
    let smallest = speeds.iter().map(|&speed| {
        let modal = ModalWheel::at(&reduced.wheel, speed, RotationEffects::stiffening(true)).unwrap();
        scheme.smallest_stable_steps(&modal, &reduced.wheel.contact)
    });
    let steps = (1.3 * smallest.max().unwrap() as f64) as u64;
    let last = sector.sectors - 1;
    let changes = json!({
        "integration": {"revolutions": 3, "window_revolutions": 1, "kept_modes": KEPT_MODES,
                        "steps_per_revolution": steps.next_multiple_of(512)},
        "sensors": [
            {"contact_node": 0, "component": "radial"},
            {"contact_node": 1, "sector": last, "component": "axial"},
            {"contact_node": 1, "sector": last / 2, "component": "tangential"}
        ]
    });
    sweep(sector, name, &speeds, changes)
}

/// Samples of the last revolution at the sensors of [`request`], by the literal dense scheme, and the number of steps with contact.
fn dense(
    scheme: Scheme,
    reduced: &ReducedSector,
    request: &SweepRequest,
    result: &SpeedResult,
) -> (Vec<Vec<f64>>, u64) {
    let speed = result.point.speed_rad_s;
    let steps = result.point.steps_per_revolution as usize;
    let lobes = request.scene.casing.as_ref().unwrap().lobes.as_ref().unwrap();
    let casing = Casing {
        // Two contact nodes: leading and trailing edge.
        clearance: vec![0.3, 0.22],
        restriction: Some(
            Lobes {
                count: lobes.count,
                amplitude: lobes.amplitude,
                width_rad: lobes.width_rad,
                phase_rad: 0.0,
            }
            .into(),
        ),
        ramp_revolutions: 1.0,
    };
    let h = TAU / (speed * steps as f64);
    let mut literal = Literal::new(scheme, &reduced.wheel, speed, 0.05, h);
    let mut samples = vec![Vec::new(); request.sensors.len()];
    for q in 1..=3 * steps {
        literal.step(&free_gaps(&casing, &reduced.wheel, q as f64 / steps as f64), gauss_seidel);
        if q > 2 * steps && q % (steps / 512) == 0 {
            for (line, (sensor, d)) in samples.iter_mut().zip(request.sensors.iter().zip([0, 2, 1])) {
                line.push(literal.displacement(
                    sensor.sector as usize,
                    sensor.contact_node.unwrap() as usize,
                    d,
                ));
            }
        }
    }
    (samples, literal.contact_steps())
}

/// Single-sided amplitude of engine order `order` in one revolution of samples, by its definition.
fn amplitude(samples: &[f64], order: usize) -> f64 {
    let n = samples.len() as f64;
    let sum = |f: fn(f64) -> f64| -> f64 {
        let terms = samples.iter().enumerate();
        terms.map(|(i, x)| x * f(TAU * (order * i) as f64 / n)).sum()
    };
    sum(f64::sin).hypot(sum(f64::cos)) * if order == 0 { 1.0 } else { 2.0 } / n
}

#[test]
fn one_two_and_three_sectors_against_the_dense_scheme() {
    for (name, scheme) in SCHEMES.into_iter().zip(LIBRARY_SCHEMES) {
        for sectors in [1, 2, 3] {
            let sector = wheel(WheelRecipe { sectors, nodes: 5, contact_nodes: 2, ..Default::default() });
            let reduced = reduced(&sector, 4);
            let request = request(&sector, &reduced, name, scheme);
            for result in run(&reduced, &request) {
                assert_sound(&result, 1.0);
                let (samples, contact_steps) = dense(scheme, &reduced, &request.clone().into(), &result);
                assert!(contact_steps > 10);
                assert_eq!(result.point.contact_share, contact_steps as f64 / result.point.steps as f64);
                same_numbers(&result, &samples, &format!("{name}, {sectors} sectors"));
            }
        }
    }
}

/// Asserts that spectra and responses of `result` are those of `samples`, sensor by sensor.
fn same_numbers(result: &SpeedResult, samples: &[Vec<f64>], of: &str) {
    let spectra = &result.spectra.as_ref().unwrap().sensors;
    for ((samples, spectrum), response) in samples.iter().zip(spectra).zip(&result.point.responses) {
        let largest = samples.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let close = |a: f64, b: f64, what: &str| {
            assert!((a - b).abs() < 1e-9 * largest, "{of}, {what}: {a} {b}");
        };
        for (order, &found) in spectrum.amplitude.iter().enumerate() {
            close(found, amplitude(samples, order), "amplitude");
        }
        let (low, high) = samples.iter().fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
        close(response.half_peak_to_peak, 0.5 * (high - low), "half peak to peak");
        let mean = samples.iter().sum::<f64>() / 512.0;
        close(response.mean, mean, "mean");
        let variance = samples.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 512.0;
        close(response.rms, variance.sqrt(), "rms");
    }
}

/// Sensors at one node of every sector see what the nodal diameters carry, and two lobes leave the odd ones alone.
#[test]
fn sixty_four_sectors_obey_parseval_and_symmetry() {
    let sector = wheel(WheelRecipe { sectors: 64, nodes: 5, contact_nodes: 2, ..Default::default() });
    let reduced = reduced(&sector, 4);
    assert_eq!(reduced.report.unknowns.len(), 33);
    for scheme in SCHEMES {
        let everywhere: Vec<Value> =
            (0..64).map(|s| json!({"contact_node": 0, "sector": s, "component": "normal"})).collect();
        let changes =
            json!({"sensors": everywhere, "integration": {"revolutions": 4, "window_revolutions": 2}});
        let results = run(&reduced, &sweep(&sector, scheme, &[0.7 * TOP_SPEED], changes));
        assert_sound(&results[0], 1.0);
        assert!(results[0].point.contact_share > 0.1);
        let spectra = &results[0].spectra.as_ref().unwrap().sensors;
        let diameters = &spectra[0].nodal_diameters;
        let largest = spectra[0].amplitude.iter().fold(0.0f64, |m, &a| m.max(a));
        for bin in 0..spectra[0].amplitude.len() {
            let of_sectors: f64 = spectra.iter().map(|s| s.amplitude[bin].powi(2)).sum();
            let of_diameters: f64 = diameters.iter().map(|line| line[bin].powi(2)).sum();
            assert!((of_sectors - of_diameters).abs() < 1e-12 * of_sectors.max(largest * largest), "{bin}");
            for s in 0..32 {
                let (here, opposite) = (spectra[s].amplitude[bin], spectra[s + 32].amplitude[bin]);
                assert!((here - opposite).abs() < 1e-9 * largest, "{s} {bin}: {here} {opposite}");
            }
            for line in diameters.iter().skip(1).step_by(2) {
                assert!(line[bin] < 1e-9 * largest, "{bin}: {:e}", line[bin]);
            }
        }
    }
}

/// Casing of 64 lobes: every sector of 1, 2 or 64 does the same at the same time, and the wheel closes on itself.
#[test]
fn the_same_in_every_sector_whatever_their_number() {
    let of = |sectors| wheel(WheelRecipe { sectors, nodes: 5, contact_nodes: 2, ..Default::default() });
    for scheme in SCHEMES {
        let results = [1, 2, 64].map(|sectors| {
            let sector = of(sectors);
            let reduced = reduced(&sector, 4);
            let changes = json!({
                "scene": {"damping": {"modal_ratio": 0.2}, "casing": {"lobes": {"count": 64, "width_rad": 0.03}}},
                "integration": {"revolutions": 4, "window_revolutions": 2, "steps_per_revolution": 6144, "kept_modes": KEPT_MODES},
                "max_engine_order": 128
            });
            let mut results = run(&reduced, &sweep(&sector, scheme, &[0.7 * TOP_SPEED], changes));
            assert_sound(&results[0], 1.0);
            results.swap_remove(0)
        });
        let [one, others @ ..] = &results;
        assert!(one.point.contact_share > 0.0);
        for other in others {
            let difference = spectral_difference(one, other);
            assert!(difference < 1e-9, "{scheme}: {difference:e}");
            assert_eq!(one.point.contact_share, other.point.contact_share);
        }
    }
}
