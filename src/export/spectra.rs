//! Spectra of one speed.

use super::array::Array;
use crate::analysis::request::Sensor;
use crate::analysis::result::{Point, SensorSpectrum, SpeedSpectra};
use crate::dynamics::sector::Units;

/// A line per sensor and engine order: the amplitude, and those of the nodal diameters. `sensors` are their indices in the request.
pub fn table(spectra: &SpeedSpectra, sensors: &[u32], units: &Units) -> Vec<Array> {
    let length = Sensor::common_unit(spectra.sensors.iter().map(|sensor| &sensor.sensor), units);
    let orders = &spectra.engine_orders;
    let lines = |name: String, of: &dyn Fn(&SensorSpectrum) -> Vec<f64>| {
        Array::reals(name, spectra.sensors.iter().flat_map(of))
    };
    let diameters = spectra.sensors.iter().map(|sensor| sensor.nodal_diameters.len()).max().unwrap_or(0);
    let mut columns = vec![
        Array::whole("sensor", sensors.iter().flat_map(|&sensor| std::iter::repeat_n(sensor, orders.len()))),
        Array::reals("engine_order", sensors.iter().flat_map(|_| orders.iter().copied())),
        lines(format!("amplitude_{length}"), &|sensor| sensor.amplitude.clone()),
    ];
    columns.extend((0..diameters).map(|diameter| {
        lines(format!("nodal_diameter_{diameter}_{length}"), &|sensor| {
            sensor.nodal_diameters[diameter].clone()
        })
    }));
    columns
}

/// Arrays as `[order]`, `[sensor][order]` and `[sensor][nodal diameter][order]`.
pub fn arrays(point: &Point, spectra: &SpeedSpectra, units: &Units) -> Vec<Array> {
    let sensors = &spectra.sensors;
    let diameters: Vec<Vec<Vec<f64>>> = sensors.iter().map(|sensor| sensor.nodal_diameters.clone()).collect();
    vec![
        Array::real("speed_rad_s", point.speed_rad_s),
        Array::reals("engine_orders", spectra.engine_orders.iter().copied()),
        Array::rows("amplitude", sensors.iter().map(|sensor| sensor.amplitude.as_slice())),
        Array::cube("nodal_diameters", &diameters),
        Array::sensors(sensors.iter().map(|sensor| &sensor.sensor)),
        Array::json("point", point),
        Array::json("units", units),
        Array::text("version", &point.version),
    ]
}
