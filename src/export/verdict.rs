//! Verdict on a sweep.

use super::Export;
use super::array::Array;
use crate::analysis::result::{JudgedSpeed, JudgedValue, LimitKind, Position, SweepVerdict};
use crate::dynamics::sector::Units;

/// Name of a column of a limited quantity, such as `tip_motion_value_mm`; a share has no unit.
pub(super) fn with_unit(kind: LimitKind, what: &str, units: &Units) -> String {
    match kind.unit(units) {
        "" => format!("{}_{what}", kind.as_str()),
        unit => format!("{}_{what}_{unit}", kind.as_str()),
    }
}

impl Export for SweepVerdict {
    /// A line per critical speed of the wheel, the most severe first; a limit that the request does not give has no columns.
    fn table(&self) -> Vec<Array> {
        let all = || self.critical_speeds.iter();
        let at = |wanted: Position| {
            all().map(move |speed| {
                let there = speed.ranges.iter().filter(|place| place.position == wanted);
                there.map(|place| place.range.as_str()).collect::<Vec<_>>().join("; ")
            })
        };
        let mut columns = vec![
            Array::whole("index", all().map(|speed| speed.index)),
            Array::reals("speed_rad_s", all().map(|speed| speed.speed_rad_s)),
            Array::some_reals("speed_error_rad_s", all().map(|speed| speed.speed_error_rad_s)),
            Array::flags("resolved", all().map(|speed| speed.resolved == Some(true))),
            Array::some_reals("engine_order", all().map(|speed| speed.engine_order)),
            Array::some_reals("nodal_diameter", all().map(|speed| speed.nodal_diameter.map(f64::from))),
            Array::texts("inside", at(Position::Inside)),
            Array::texts("within_separation", at(Position::WithinSeparation)),
        ];
        let limits = self.settings.limits.unwrap_or_default();
        for kind in LimitKind::ALL.into_iter().filter(|kind| kind.limit(&limits).is_some()) {
            let name = kind.as_str();
            let of = |speed: &JudgedSpeed| speed.limits.iter().find(|judged| judged.limit == kind).copied();
            let reals = |name: String, number: fn(JudgedValue) -> Option<f64>| {
                Array::some_reals(name, all().map(|speed| number(of(speed)?)))
            };
            columns.extend([
                reals(with_unit(kind, "value", &self.units), |judged| Some(judged.value)),
                reals(with_unit(kind, "error", &self.units), |judged| judged.error),
                reals(format!("{name}_above_percent"), |judged| Some(judged.above_percent)),
                Array::words(
                    format!("{name}_standing"),
                    all().map(|speed| of(speed).map(|judged| judged.standing)),
                ),
            ]);
        }
        columns
    }

    /// Columns of the table, the verdict, and the settings that it rests on.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        arrays.extend([
            Array::text("verdict", self.verdict.as_str()),
            Array::text("sentence", &self.sentence),
            Array::json("ranges", &self.ranges),
            Array::json("worst", &self.worst),
            Array::json("would_decide", &self.would_decide),
            Array::json("settings", &self.settings),
            Array::json("units", &self.units),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
