//! Sweeps through the door that the hard cases share, and what each of their results must withstand.

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::request::SweepRequest;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::result::{PointStatus, SpeedResult};
use rubmap::analysis::run::{ModelFacts, ReducedSector, check, prepare, resolve_sweep, run_speed};
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::{CyclicMatrix, SectorModel};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// Values of `integration.scheme` of the sweeps.
pub(crate) const SCHEMES: [&str; 3] = ["central_differences", "exact_modal", "massless_boundary"];

/// Schemes of [`SCHEMES`] for a simulation without the door, in the same order.
pub(crate) const LIBRARY_SCHEMES: [Scheme; 3] = [
    Scheme::CentralDifferences,
    Scheme::ExactModal,
    Scheme::MasslessBoundary { kept_modes: KEPT_MODES as usize },
];

/// Value of `integration.kept_modes` where it has to be the same in two runs.
pub(crate) const KEPT_MODES: u32 = 7;

/// Largest violation of the energy identity, relative to the largest energy, that any scheme may show.
pub(crate) const ENERGY_TOLERANCE: f64 = 1e-9;

/// Resolved sweep over `speeds` in rad/s: two lobes beyond the clearance, well damped, changed by the fields of
/// `changes`; `kept_modes` among them is for the scheme that has it.
pub(crate) fn sweep(sector: &SectorModel, scheme: &str, speeds: &[f64], changes: Value) -> ResolvedSweep {
    let mut request = json!({
        "model": "test wheel", "modes_per_speed": 6,
        "speeds": {"values": speeds, "unit": "rad_s"},
        "scene": {
            "centrifugal_stiffening": sector.stiffness.len() == 3,
            "damping": {"modal_ratio": 0.05},
            "casing": {"clearance": {"leading": 0.3, "trailing": 0.22},
                       "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}},
            "contact": {}
        },
        "integration": {"scheme": scheme, "revolutions": 10, "window_revolutions": 4},
        "max_engine_order": 12
    });
    merge(&mut request, changes);
    if scheme != "massless_boundary"
        && let Some(integration) = request["integration"].as_object_mut()
    {
        integration.remove("kept_modes");
    }
    resolve_sweep(serde_json::from_value(request).unwrap(), &ModelFacts::of(sector)).unwrap()
}

/// Sweep of `request` with other settings, which are not checked.
pub(crate) fn changed(request: &ResolvedSweep, change: impl FnOnce(&mut SweepRequest)) -> ResolvedSweep {
    let mut settings = SweepRequest::from(request.clone());
    change(&mut settings);
    ResolvedSweep::stored(settings, 0).unwrap()
}

/// Puts every field of `changes` over that of `base`.
pub(crate) fn merge(base: &mut Value, changes: Value) {
    match (base, changes) {
        (Value::Object(base), Value::Object(changes)) => {
            for (name, value) in changes {
                merge(base.entry(name).or_insert(Value::Null), value);
            }
        }
        (base, value) => *base = value,
    }
}

pub(crate) fn reduced(sector: &SectorModel, modes_per_speed: u32) -> ReducedSector {
    prepare(sector, modes_per_speed, None, &NoCheckpoints, &Unwatched).unwrap()
}

/// Runs the whole sweep as a job does: checked first, then speed by speed.
pub(crate) fn run(reduced: &ReducedSector, request: &ResolvedSweep) -> Vec<SpeedResult> {
    check(reduced, request, &Unwatched).unwrap();
    let speeds = request.speeds().rad_s().len();
    (0..speeds).map(|index| run_speed(reduced, request, index, None, &Unwatched).unwrap()).collect()
}

/// Asserts that a speed is completed, with finite numbers, complementary contact and balanced energy. Gaps are
/// differences of lengths of about `length`: 1e-12 of it is their round-off through W.
pub(crate) fn assert_sound(result: &SpeedResult, length: f64) {
    let point = &result.point;
    assert_eq!(point.status, PointStatus::Completed, "{point:?}");
    assert!(point.largest_penetration.unwrap() <= 1e-12 * length, "{point:?}");
    assert!(point.smallest_multiplier.unwrap_or(0.0) >= 0.0, "{point:?}");
    assert!(point.energy_residual.unwrap() < ENERGY_TOLERANCE, "{point:?}");
    assert_survives_json(result);
}

/// Asserts that a value is read back equal from its JSON, which has no word for NaN or infinity: a number that is none
/// becomes null, and is refused or differs when it is read.
pub(crate) fn assert_survives_json<T>(value: &T)
where
    T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let text = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<T>(&text).unwrap(), value);
}

/// Largest difference of two runs' spectra of a sensor, relative to the largest amplitude of the sensor.
pub(crate) fn spectral_difference(a: &SpeedResult, b: &SpeedResult) -> f64 {
    let (a, b) = (a.spectra.as_ref().unwrap(), b.spectra.as_ref().unwrap());
    assert_eq!(a.sensors.len(), b.sensors.len());
    let of =
        |(a, b): (&rubmap::analysis::result::SensorSpectrum, &rubmap::analysis::result::SensorSpectrum)| {
            assert_eq!(a.amplitude.len(), b.amplitude.len());
            let largest = a.amplitude.iter().fold(0.0f64, |m, &x| m.max(x));
            assert!(largest > 0.0, "nothing moved");
            a.amplitude.iter().zip(&b.amplitude).fold(0.0f64, |m, (x, y)| m.max((x - y).abs())) / largest
        };
    a.sensors.iter().zip(&b.sensors).map(of).fold(0.0, f64::max)
}

/// Multiplies Y by `factor`.
pub(crate) fn scale(matrix: &mut CyclicMatrix, factor: f64) {
    for values in [matrix.own.val_mut(), matrix.next.val_mut()] {
        values.iter_mut().for_each(|v| *v *= factor);
    }
}
