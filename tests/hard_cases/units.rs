//! Units: one wheel in millimetres and tonnes and in metres and kilograms.
//!
//! A tolerance, a guard or a shift that is a number and not a share of the model's own scale ("1e-6 is small") passes
//! in one set of units and fails in the other. Guaranteed: the same steps, contacts and verdicts; lengths scale by 1e-3,
//! energies from millijoules to joules, impulses not at all. Between units that differ by powers of two, not a bit changes.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::{Point, SpeedResult};
use rubmap::analysis::run::critical_speeds;
use rubmap::dynamics::sector::{SectorModel, Units};
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, reduced, run, scale, sweep};

/// Sector in SI units, from one in mm, t, N and s: t → kg and N/mm → N/m are factors of 1e3.
fn in_si(sector: SectorModel) -> SectorModel {
    let mut sector = sector.into_parts();
    scale(&mut sector.mass, 1e3);
    sector.stiffness.iter_mut().for_each(|k| scale(k, 1e3));
    for node in &mut sector.contact {
        node.position[0] *= 1e-3;
        node.position[2] *= 1e-3;
    }
    sector.units = Units { length: "m".into(), force: "N".into(), time: "s".into(), mass: "kg".into() };
    SectorModel::new(sector).unwrap()
}

fn close(a: f64, b: f64, what: &str) {
    assert!((a - b).abs() <= 1e-7 * a.abs(), "{what}: {a} {b}");
}

#[test]
fn millimetres_and_metres_give_the_same_sweep() {
    let mm = wheel(WheelRecipe::default());
    let si = in_si(mm.clone());
    let (reduced_mm, reduced_si) = (reduced(&mm, 6), reduced(&si, 6));
    assert_eq!(reduced_mm.report.unknowns, reduced_si.report.unknowns);
    assert_eq!(reduced_mm.report.stiffening.verdict, reduced_si.report.stiffening.verdict);
    assert_eq!(reduced_mm.report.counted_modes, reduced_si.report.counted_modes);
    let speeds = [0.35, 0.45, 0.55, 0.7].map(|share| share * TOP_SPEED);
    let mut peaks = 0;
    for scheme in SCHEMES {
        let request_mm = sweep(&mm, scheme, &speeds, json!({}));
        let lengths = json!({"scene": {"casing": {
            "clearance": {"leading": 0.3e-3, "trailing": 0.22e-3}, "lobes": {"amplitude": 0.425e-3}}}});
        let request_si = sweep(&si, scheme, &speeds, lengths);
        let (in_mm, in_si) = (run(&reduced_mm, &request_mm), run(&reduced_si, &request_si));
        for (a, b) in in_mm.iter().zip(&in_si) {
            assert_sound(a, 1.0);
            assert_sound(b, 1e-3);
            same_point(&a.point, &b.point);
            let (a, b) = (a.spectra.as_ref().unwrap(), b.spectra.as_ref().unwrap());
            for (a, b) in a.sensors.iter().zip(&b.sensors) {
                let lines = std::iter::once((&a.amplitude, &b.amplitude))
                    .chain(a.nodal_diameters.iter().zip(&b.nodal_diameters));
                let scale = a.amplitude.iter().fold(0.0f64, |m, &x| m.max(x));
                assert!(scale > 1e-3);
                for (a, b) in lines.flat_map(|(a, b)| a.iter().zip(b)) {
                    assert!((a - 1e3 * b).abs() < 1e-7 * scale, "{scheme}: {a} mm, {b} m");
                }
            }
        }
        let points = |results: Vec<SpeedResult>| -> Vec<Point> {
            results.into_iter().map(|result| result.point).collect()
        };
        let tables = [
            critical_speeds(&reduced_mm, &request_mm, &points(in_mm), None, &Unwatched).unwrap(),
            critical_speeds(&reduced_si, &request_si, &points(in_si), None, &Unwatched).unwrap(),
        ];
        let [mm, si] = tables.map(|mut tables| tables.swap_remove(0));
        peaks += mm.critical_speeds.len();
        assert_eq!(mm.critical_speeds.len(), si.critical_speeds.len());
        for (a, b) in mm.critical_speeds.iter().zip(&si.critical_speeds) {
            assert_eq!((a.index, a.at_edge), (b.index, b.at_edge));
            close(a.prominence, 1e3 * b.prominence, "prominence");
        }
        assert_eq!(mm.linear_crossings.len(), si.linear_crossings.len());
        for (a, b) in mm.linear_crossings.iter().zip(&si.linear_crossings) {
            close(a.speed_rad_s, b.speed_rad_s, "crossing");
        }
    }
    assert!(peaks > 0, "no critical speed was compared");
}

fn same_point(mm: &Point, si: &Point) {
    assert_eq!(
        (mm.steps_per_revolution, mm.smallest_stable_steps_per_revolution, mm.steps),
        (si.steps_per_revolution, si.smallest_stable_steps_per_revolution, si.steps)
    );
    assert!(mm.contact_share > 0.01);
    assert_eq!(mm.contact_share, si.contact_share);
    let (a, b) = (mm.settling.as_ref().unwrap(), si.settling.as_ref().unwrap());
    assert_eq!((a.verdict, a.ratio, a.after_revolutions), (b.verdict, b.ratio, b.after_revolutions));
    close(mm.contact_impulse.unwrap(), si.contact_impulse.unwrap(), "impulse in N·s");
    close(mm.largest_energy.unwrap(), 1e3 * si.largest_energy.unwrap(), "mJ against J");
    for (a, b) in mm.responses.iter().zip(&si.responses) {
        close(a.rms, 1e3 * b.rms, "rms");
        close(a.half_peak_to_peak, 1e3 * b.half_peak_to_peak, "half peak to peak");
        assert_eq!(a.dominant_engine_order, b.dominant_engine_order);
        assert_eq!(a.dominant_nodal_diameter, b.dominant_nodal_diameter);
    }
}

/// Units that differ by powers of two, up to 1e30 (of four for masses, whose roots are taken): not one bit of a mantissa
/// changes, so nothing is compared with a number that is not the model's own.
#[test]
fn powers_of_two_change_no_bit() {
    let sector = wheel(WheelRecipe::default());
    let plain = reduced(&sector, 6);
    for (force_bits, length_bits) in [(8, 0), (0, -10), (-40, 30), (100, -60), (-100, 50)] {
        let [force, length] = [force_bits, length_bits].map(|bits| f64::from(bits).exp2());
        // Mass and stiffness by the same factor: time stays.
        let stiffness = force / length;
        let mut other = sector.clone().into_parts();
        scale(&mut other.mass, stiffness);
        other.stiffness.iter_mut().for_each(|k| scale(k, stiffness));
        for node in &mut other.contact {
            node.position[0] *= length;
            node.position[2] *= length;
        }
        let other = SectorModel::new(other).unwrap();
        let changed = reduced(&other, 6);
        for scheme in SCHEMES {
            let changes = |length: f64| {
                json!({
                    "scene": {"casing": {"clearance": {"leading": 0.3 * length, "trailing": 0.22 * length},
                                         "lobes": {"amplitude": 0.425 * length}}},
                    "integration": {"revolutions": 6, "window_revolutions": 2}
                })
            };
            let speeds = [0.55 * TOP_SPEED];
            let a = &run(&plain, &sweep(&sector, scheme, &speeds, changes(1.0)))[0];
            let b = &run(&changed, &sweep(&other, scheme, &speeds, changes(length)))[0];
            assert_sound(a, 1.0);
            assert_sound(b, length);
            let (p, q) = (&a.point, &b.point);
            assert_eq!((p.steps, p.contact_share), (q.steps, q.contact_share));
            assert_eq!((&p.settling, p.energy_residual), (&q.settling, q.energy_residual));
            let scaled = |value: Option<f64>, by: f64| value.map(|value| value * by);
            assert_eq!(scaled(p.contact_impulse, force), q.contact_impulse);
            assert_eq!(scaled(p.smallest_multiplier, force), q.smallest_multiplier);
            assert_eq!(scaled(p.largest_penetration, length), q.largest_penetration);
            assert_eq!(scaled(p.largest_energy, force * length), q.largest_energy);
            let lines = |result: &SpeedResult| -> Vec<f64> {
                let sensors = result.spectra.iter().flat_map(|spectra| &spectra.sensors);
                sensors
                    .flat_map(|s| s.amplitude.iter().chain(s.nodal_diameters.iter().flatten()))
                    .copied()
                    .collect()
            };
            let expected: Vec<f64> = lines(a).iter().map(|amplitude| amplitude * length).collect();
            assert_eq!(expected, lines(b), "2^{force_bits}, 2^{length_bits}");
        }
    }
}
