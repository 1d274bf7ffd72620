//! Level of the wheel over speed.

use super::Export;
use super::array::Array;
use super::verdict::with_unit;
use crate::analysis::result::{LevelSpeed, LimitKind, SweepLevel};

impl Export for SweepLevel {
    /// A line per finished speed, slowest first; a quantity that is known at no speed has no columns.
    fn table(&self) -> Vec<Array> {
        let all = || self.speeds.iter();
        let is_critical = |speed: &LevelSpeed| {
            self.verdict.critical_speeds.iter().any(|critical| critical.index == speed.index)
        };
        let mut columns = vec![
            Array::whole("index", all().map(|speed| speed.index)),
            Array::reals("speed_rad_s", all().map(|speed| speed.speed_rad_s)),
            Array::words("status", all().map(|speed| Some(speed.status))),
            Array::flags("critical", all().map(is_critical)),
        ];
        for kind in LimitKind::ALL {
            let of = move |speed: &LevelSpeed| speed.value(kind).copied();
            if all().all(|speed| of(speed).is_none()) {
                continue;
            }
            let name = kind.as_str();
            let with_unit = |what| with_unit(kind, what, &self.verdict.units);
            columns.extend([
                Array::some_reals(with_unit("value"), all().map(|speed| Some(of(speed)?.value))),
                Array::some_reals(with_unit("error"), all().map(|speed| of(speed)?.error)),
            ]);
            if self.limit(kind).is_some() {
                columns
                    .push(Array::words(format!("{name}_standing"), all().map(|speed| of(speed)?.standing)));
            }
        }
        columns
    }

    /// Columns of the table, and the arrays of the verdict under its own names.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        arrays.push(Array::json("verdict", &self.verdict));
        arrays
    }
}
