//! Critical speeds beside the linear prediction.

use super::Export;
use super::array::Array;
use crate::analysis::result::{CriticalSpeed, CriticalSpeeds, Crossing};

impl Export for CriticalSpeeds {
    /// A line per critical speed, with the nearest prediction.
    fn table(&self) -> Vec<Array> {
        let length = self.sensor.unit(&self.units);
        let reals = |name: String, of: fn(&CriticalSpeed) -> f64| {
            Array::reals(name, self.critical_speeds.iter().map(of))
        };
        let some_reals = |name: &str, of: fn(&CriticalSpeed) -> Option<f64>| {
            Array::some_reals(name, self.critical_speeds.iter().map(of))
        };
        let nearest = || self.critical_speeds.iter().map(|speed| speed.nearest_crossing.as_ref());
        let crossings = |name: &str, of: fn(&Crossing) -> u32| {
            Array::some_whole(name, nearest().map(|crossing| crossing.map(of)))
        };
        let all = || self.critical_speeds.iter();
        vec![
            Array::whole("index", all().map(|speed| speed.index)),
            reals("speed_rad_s".to_owned(), |speed| speed.speed_rad_s),
            reals("speed_error_rad_s".to_owned(), |speed| speed.speed_error_rad_s),
            Array::flags("at_edge", all().map(|speed| speed.at_edge)),
            Array::flags("resolved", all().map(|speed| speed.resolved)),
            Array::flags("on_branch", all().map(|speed| speed.on_branch)),
            reals(format!("rms_{length}"), |speed| speed.rms),
            reals(format!("half_peak_to_peak_{length}"), |speed| speed.half_peak_to_peak),
            reals(format!("prominence_{length}"), |speed| speed.prominence),
            reals("frequency_error_rad_s".to_owned(), |speed| speed.frequency_error_rad_s),
            some_reals("amplitude_error", |speed| speed.amplitude_error),
            some_reals("dominant_engine_order", |speed| speed.dominant_engine_order),
            Array::some_whole("dominant_nodal_diameter", all().map(|speed| speed.dominant_nodal_diameter)),
            Array::words("settling", all().map(|speed| speed.settling)),
            some_reals("distance_rad_s", |speed| speed.distance_rad_s),
            Array::some_reals(
                "nearest_crossing_speed_rad_s",
                nearest().map(|crossing| Some(crossing?.speed_rad_s)),
            ),
            crossings("nearest_crossing_nodal_diameter", |crossing| crossing.nodal_diameter),
            crossings("nearest_crossing_family", |crossing| crossing.family),
            crossings("nearest_crossing_superharmonic", |crossing| crossing.superharmonic),
            some_reals("utilisation", |speed| speed.utilisation),
            Array::words("validity", all().map(|speed| speed.validity)),
            Array::word_lists("validity_lacking", all().map(|speed| &speed.validity_lacking)),
        ]
    }

    /// Columns of the table, and the settings that they rest on.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        arrays.extend([
            Array::sensors([&self.sensor]),
            Array::whole("missing", self.missing.iter().copied()),
            Array::json("settings", &self.settings),
            Array::json("units", &self.units),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
