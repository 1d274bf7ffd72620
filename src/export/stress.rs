//! Stress over the speeds of a sweep, cycle by cycle.

use super::Export;
use super::array::Array;
use crate::analysis::result::{SpeedStress, StressCycle, SweepStress, Validity, stress_unit};

/// Cycle and its speed: a line of the table.
type Line<'a> = (&'a SpeedStress, &'a StressCycle);

impl Export for SweepStress {
    /// A line per cycle of every speed: the most utilised places.
    fn table(&self) -> Vec<Array> {
        let unit = stress_unit(&self.units);
        let length = &self.units.length;
        let lines: Vec<Line> = self.cycles().collect();
        let reals = |name: String, of: &dyn Fn(&Line) -> f64| Array::reals(name, lines.iter().map(of));
        let some_reals = |name: &str, of: fn(&StressCycle) -> Option<f64>| {
            Array::some_reals(name, lines.iter().map(|(_, cycle)| of(cycle)))
        };
        let mut columns = vec![
            Array::whole("index", lines.iter().map(|(speed, _)| speed.index)),
            reals("speed_rad_s".to_owned(), &|(speed, _)| speed.speed_rad_s),
            Array::texts("node", lines.iter().map(|(_, cycle)| cycle.node.to_string())),
        ];
        columns.extend(
            ["x", "y", "z"]
                .iter()
                .enumerate()
                .map(|(axis, name)| reals(format!("{name}_{length}"), &|(_, cycle)| cycle.position[axis])),
        );
        columns.extend([
            Array::whole("sector", lines.iter().map(|(_, cycle)| cycle.sector)),
            Array::texts("set", lines.iter().map(|(_, cycle)| cycle.set.clone())),
            reals(format!("mean_{unit}"), &|(_, cycle)| cycle.mean),
            reals(format!("alternating_{unit}"), &|(_, cycle)| cycle.alternating),
            reals(format!("principal_mean_{unit}"), &|(_, cycle)| cycle.principal_mean),
            reals(format!("principal_alternating_{unit}"), &|(_, cycle)| cycle.principal_alternating),
            some_reals("utilisation", |cycle| cycle.utilisation),
            some_reals("over_yield", |cycle| cycle.over_yield),
        ]);
        columns
    }

    /// Columns of the table, the largest stress of each speed, and the settings that they rest on.
    fn arrays(&self) -> Vec<Array> {
        let speeds = || self.speeds.iter();
        let peaks = || speeds().map(|speed| &speed.stress.largest);
        let positions: Vec<&[f64]> = peaks().map(|peak| &peak.position[..]).collect();
        let lacking =
            speeds().map(|speed| speed.validity.as_ref().map(Validity::measures_lacking).unwrap_or_default());
        let mut arrays = self.table();
        arrays.extend([
            Array::reals("speeds_rad_s", speeds().map(|speed| speed.speed_rad_s)),
            Array::whole("speed_indices", speeds().map(|speed| speed.index)),
            Array::reals("largest_von_mises", peaks().map(|peak| peak.von_mises)),
            Array::texts("largest_node", peaks().map(|peak| peak.node.to_string())),
            Array::rows("largest_position", positions),
            Array::whole("largest_sector", peaks().map(|peak| peak.sector)),
            Array::reals("largest_revolution", peaks().map(|peak| peak.revolution)),
            Array::reals("largest_static", speeds().map(|speed| speed.stress.largest_static)),
            Array::some_reals("largest_utilisation", speeds().map(|speed| speed.stress.utilisation())),
            Array::words(
                "validity",
                speeds().map(|speed| speed.validity.as_ref().map(|found| found.verdict)),
            ),
            Array::word_lists("validity_lacking", lacking),
            Array::json("strengths", &self.strengths),
            Array::json("settings", &self.settings),
            Array::json("units", &self.units),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::analysis::request::SpeedUnit;
    use crate::export::{Values, write_csv};

    /// Example of one speed with two cycles, the second without strengths.
    fn found() -> SweepStress {
        let cycle = |node: u64, utilisation: Option<f64>| {
            let mut cycle = json!({"node": node, "position": [1.0, 2.0, 3.5], "sector": 4, "set": "A,B", "mean": 100.0,
                "alternating": 40.0, "principal_mean": 101.0, "principal_alternating": 41.0});
            if let Some(utilisation) = utilisation {
                cycle["utilisation"] = json!(utilisation);
            }
            cycle
        };
        serde_json::from_value(json!({
            "speeds": [{"index": 7, "speed_rad_s": 10.0, "validity": {"verdict": "doubtful", "checks": []}, "stress": {
                "largest": {"von_mises": 141.0, "node": 12, "position": [1.0, 2.0, 3.5], "sector": 4, "revolution": 9.5},
                "largest_static": 90.0, "cycles": [cycle(9_007_199_254_740_993, Some(0.5)), cycle(13, None)],
                "excluded_radius": 1.0, "excluded_nodes": 3, "followed_nodes": 9,
            }}],
            "strengths": [], "units": {"length": "mm", "force": "N", "time": "s", "mass": "t"},
            "settings": {"model": "m", "speeds": {"values": [1.0], "unit": "rpm"}, "scene": {}}, "version": "0",
        }))
        .unwrap()
    }

    #[test]
    fn a_line_is_a_cycle() {
        let mut text = Vec::new();
        write_csv(&found(), Some(SpeedUnit::RadS), &mut text).unwrap();
        let expected = "index,speed_rad_s,node,x_mm,y_mm,z_mm,sector,set,mean_MPa,alternating_MPa,principal_mean_MPa,\
            principal_alternating_MPa,utilisation,over_yield\r\n\
            7,10.0,9007199254740993,1.0,2.0,3.5,4,\"A,B\",100.0,40.0,101.0,41.0,0.5,\r\n\
            7,10.0,13,1.0,2.0,3.5,4,\"A,B\",100.0,40.0,101.0,41.0,,\r\n";
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }

    #[test]
    fn arrays_have_what_is_largest_at_every_speed() {
        let arrays = found().arrays();
        let of = |name: &str| arrays.iter().find(|array| array.name == name).unwrap();
        assert_eq!(of("largest_von_mises").values, Values::Real(vec![141.0]));
        assert_eq!(of("largest_utilisation").values, Values::Real(vec![0.5]));
        assert_eq!(of("largest_position").shape, [1, 3]);
        assert_eq!(of("validity").values, Values::Text(vec!["doubtful".to_owned()]));
        assert_eq!(of("speed_indices").values, Values::Whole(vec![Some(7)]));
        assert_eq!(of("sector").shape, [2]);
    }
}
