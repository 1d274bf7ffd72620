//! Critical speeds of the wheel as a whole.

use super::Export;
use super::array::Array;
use crate::analysis::result::{WheelCriticalSpeed, WheelCriticalSpeeds};

impl Export for WheelCriticalSpeeds {
    /// A line per critical speed, the most severe first.
    fn table(&self) -> Vec<Array> {
        let (length, force) = (&self.units.length, &self.units.force);
        let all = || self.critical_speeds.iter();
        let reals = |name: String, of: fn(&WheelCriticalSpeed) -> f64| Array::reals(name, all().map(of));
        let some_reals =
            |name: String, of: fn(&WheelCriticalSpeed) -> Option<f64>| Array::some_reals(name, all().map(of));
        vec![
            Array::whole("index", all().map(|speed| speed.index)),
            reals("speed_rad_s".to_owned(), |speed| speed.speed_rad_s),
            reals("speed_error_rad_s".to_owned(), |speed| speed.speed_error_rad_s),
            Array::flags("at_edge", all().map(|speed| speed.at_edge)),
            Array::flags("resolved", all().map(|speed| speed.resolved)),
            Array::flags("on_branch", all().map(|speed| speed.on_branch)),
            reals("severity".to_owned(), |speed| speed.severity),
            reals(format!("rms_{length}"), |speed| speed.tip.rms),
            reals(format!("half_peak_to_peak_{length}"), |speed| speed.tip.half_peak_to_peak),
            Array::whole("contact_node", all().map(|speed| speed.tip.contact_node)),
            Array::whole("sector", all().map(|speed| speed.tip.sector)),
            Array::words("component", all().map(|speed| speed.tip.component)),
            some_reals("over_clearance".to_owned(), |speed| speed.tip.over_clearance),
            some_reals("over_chord".to_owned(), |speed| speed.tip.over_chord),
            some_reals(format!("mean_force_{force}"), |speed| speed.mean_force),
            some_reals(format!("peak_force_{force}"), |speed| speed.peak_force),
            some_reals("clearance_consumption".to_owned(), |speed| speed.clearance_consumption),
            reals(format!("prominence_{length}"), |speed| speed.prominence),
            some_reals("amplitude_error".to_owned(), |speed| speed.amplitude_error),
            Array::words("settling", all().map(|speed| speed.settling)),
            some_reals("utilisation".to_owned(), |speed| speed.utilisation),
            Array::words("validity", all().map(|speed| speed.validity)),
            Array::word_lists("validity_lacking", all().map(|speed| &speed.validity_lacking)),
        ]
    }

    /// Columns of the table, and the settings that they rest on.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        arrays.extend([
            Array::whole("missing", self.missing.iter().copied()),
            Array::json("settings", &self.settings),
            Array::json("units", &self.units),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
