//! Results of a convergence study.

use super::Export;
use super::array::Array;
use crate::analysis::request::AutoOr;
use crate::analysis::result::{Histories, StudyRun, WorkPrecision};

impl Export for WorkPrecision {
    /// A line per run, those of the references last at each speed; `pareto` has words separated by spaces.
    fn table(&self) -> Vec<Array> {
        let runs: Vec<(f64, bool, &StudyRun)> = self
            .speeds
            .iter()
            .flat_map(|speed| {
                let runs = speed.runs.iter().map(|run| (speed.speed_rad_s, false, run));
                runs.chain([(speed.speed_rad_s, true, &speed.reference)])
            })
            .collect();
        let of = || runs.iter().map(|(.., run)| *run);
        let errors = || of().map(|run| run.errors.as_ref());
        let kept = |run: &StudyRun| match run.setting.kept_modes {
            AutoOr::Auto => "auto".to_owned(),
            AutoOr::Fixed(kept) => kept.to_string(),
        };
        let pareto = |run: &StudyRun| {
            run.pareto.iter().map(|quantity| quantity.as_str()).collect::<Vec<_>>().join(" ")
        };
        vec![
            Array::reals("speed_rad_s", runs.iter().map(|(speed, ..)| *speed)),
            Array::whole("modes_per_speed", of().map(|run| run.setting.modes_per_speed)),
            Array::texts("scheme", of().map(|run| run.setting.scheme.as_str())),
            Array::texts("kept_modes", of().map(kept)),
            Array::whole("steps_per_revolution", of().map(|run| run.setting.steps_per_revolution)),
            Array::whole("unknowns", of().map(|run| run.unknowns)),
            Array::words("status", of().map(|run| run.status)),
            Array::words(
                "stability",
                of().map(|run| run.steady.as_ref().filter(|steady| steady.taken)?.stability),
            ),
            Array::some_reals("history_error", errors().map(|errors| errors?.history)),
            Array::some_reals("amplitude_error", errors().map(|errors| Some(errors?.amplitude))),
            Array::some_reals("amplitude_spread", errors().map(|errors| errors?.amplitude_spread)),
            Array::some_reals("engine_orders_error", errors().map(|errors| errors?.engine_orders)),
            Array::some_reals("impulse_error", errors().map(|errors| errors?.impulse)),
            Array::some_reals("stress_error", errors().map(|errors| errors?.stress)),
            Array::reals("set_up_s", of().map(|run| run.cost.set_up_s)),
            Array::reals("per_revolution_s", of().map(|run| run.cost.per_revolution_s)),
            Array::reals("time_s", of().map(|run| run.time_s)),
            Array::whole("repetitions", of().map(|run| run.cost.repetitions)),
            Array::some_reals("spread", of().map(|run| run.cost.spread)),
            Array::texts("pareto", of().map(pareto)),
            Array::flags("reference", runs.iter().map(|(_, reference, _)| *reference)),
        ]
    }

    /// Columns of the table, and the settings that they rest on.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        arrays.extend([Array::json("settings", &self.settings), Array::text("version", &self.version)]);
        arrays
    }
}

impl Export for Histories {
    /// A line per sample; a column per size and sensor.
    fn table(&self) -> Vec<Array> {
        let per_revolution = f64::from(self.samples_per_revolution);
        let longest = self.lines.iter().flat_map(|line| &line.displacement).map(Vec::len).max().unwrap_or(0);
        let mut columns =
            vec![Array::reals("revolution", (1..=longest).map(|sample| sample as f64 / per_revolution))];
        for line in &self.lines {
            let size = if line.reference {
                "reference".to_owned()
            } else {
                format!("{}", line.setting.modes_per_speed)
            };
            columns.extend(line.displacement.iter().enumerate().map(|(sensor, samples)| {
                let unit = self.sensors.get(sensor).map_or("", |sensor| sensor.unit(&self.units));
                let name = format!("modes_{size}_sensor_{sensor}_{unit}");
                Array::some_reals(name, (0..longest).map(|sample| samples.get(sample).copied()))
            }));
        }
        columns
    }

    /// Arrays; `displacement` is `[line][sensor][sample]`.
    fn arrays(&self) -> Vec<Array> {
        let lines: Vec<Vec<Vec<f64>>> = self.lines.iter().map(|line| line.displacement.clone()).collect();
        vec![
            Array::real("speed_rad_s", self.speed_rad_s),
            Array::real("samples_per_revolution", f64::from(self.samples_per_revolution)),
            Array::cube("displacement", &lines),
            Array::whole("modes_per_speed", self.lines.iter().map(|line| line.setting.modes_per_speed)),
            Array::texts("scheme", self.lines.iter().map(|line| line.setting.scheme.as_str())),
            Array::whole(
                "steps_per_revolution",
                self.lines.iter().map(|line| line.setting.steps_per_revolution),
            ),
            Array::flags("reference", self.lines.iter().map(|line| line.reference)),
            Array::sensors(&self.sensors),
            Array::json("units", &self.units),
            Array::text("version", &self.version),
        ]
    }
}
